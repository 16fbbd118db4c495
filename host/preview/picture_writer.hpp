// Writes pictures while the window goes on.
#pragma once

#include "host/render/film.hpp"
#include "host/render/look.hpp"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace glim {

class PictureWriter {
public:
    // Begins to write `film` to SCENE-001.exr in the working folder, or the next number that is free, and as `look` shows it to a PNG
    // of that name. Waits for the one before, whose report is lost.
    void write(const std::filesystem::path& scene, Film film, Look look, double exposure);
    // What became of it, once it is done, or, if `wait`, now.
    std::optional<std::string> takeReport(bool wait);

private:
    std::future<std::string> writing_;
};

}  // namespace glim
