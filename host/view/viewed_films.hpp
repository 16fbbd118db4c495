// The films that are viewed: A, and B if there are two.
#pragma once

#include "host/view/layers.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <optional>

namespace glim {

// A layer of either film, by its name.
struct ViewedLayer {
    std::string name;
    std::array<std::optional<Layer>, 2> of;  // A's and B's
};

class ViewedFilms {
public:
    // Throws InputError if a file cannot be read or if the sizes differ.
    ViewedFilms(const std::filesystem::path& a, const std::optional<std::filesystem::path>& b);

    std::size_t count() const { return files_.size(); }
    const Image& image(std::size_t i) const { return files_[i].image; }
    const std::filesystem::path& path(std::size_t i) const { return files_[i].path; }
    glm::uvec2 size() const { return {files_[0].image.width, files_[0].image.height}; }
    std::string title() const;
    // A's layers in their order, then those that only B has.
    const std::vector<ViewedLayer>& layers() const { return layers_; }

    // Reads again the files that have been written since, and takes them once their sizes agree. Returns whether it has; throws InputError
    // if one is refused, and keeps the former one.
    bool readChanged();

private:
    struct File {
        std::filesystem::path path;
        std::filesystem::file_time_type time;  // of the last write when it was read
        Image image;
        std::optional<Image> fresh;  // read again, but not taken yet
    };

    static std::optional<std::string> disagreement(const File& a, const Image& imageOfA, const File& b, const Image& imageOfB);
    void listLayers();

    std::vector<File> files_;
    std::vector<ViewedLayer> layers_;
};

}  // namespace glim
