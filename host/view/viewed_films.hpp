// The films that are viewed: A, and B if there are two.
#pragma once

#include "host/message.hpp"
#include "host/render/regroup.hpp"
#include "host/view/layers.hpp"

#include <array>
#include <chrono>
#include <filesystem>
#include <optional>

namespace glim {

// The layers of both films that have one name and are shown alike, or one that has no such partner.
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
    // Light groups of A, if it is a film that has some.
    std::vector<std::string> lightGroups() const;
    // Shows A with each group's light times a factor. Returns its RMSE with such lights, estimated, relative to its mean, if that is known.
    std::optional<double> setLights(const std::vector<glm::vec3>& factors);
    // A's layers in their order, then those that only B has.
    const std::vector<ViewedLayer>& layers() const { return layers_; }

    // Reads again the files that have been written since. They are taken once their sizes agree; one that is refused stays as it was.
    struct Reading {
        std::vector<std::string> taken;  // names of files
        std::optional<Message> trouble;
    };
    Reading readChanged();

private:
    struct File {
        std::filesystem::path path;
        std::filesystem::file_time_type time;  // of the last write when it was read
        Image image;
        std::optional<Image> fresh;   // read again, but not taken yet
        std::optional<Film> grouped;  // if it has light groups
    };

    static std::optional<Message> disagreement(const File& a, const Image& imageOfA, const File& b, const Image& imageOfB);
    void listLayers();

    std::vector<File> files_;
    std::vector<ViewedLayer> layers_;
};

}  // namespace glim
