// Writes pictures to files in a thread of its own.
#pragma once

#include "host/denoise/denoised_picture.hpp"
#include "host/render/aov.hpp"
#include "host/render/film.hpp"

#include <filesystem>
#include <future>
#include <initializer_list>
#include <optional>
#include <string>

namespace glim {

// SCENE-001, or the next number of which no file in the working folder has one of the endings.
std::string freeStem(const std::filesystem::path& scene, std::initializer_list<const char*> endings);

class PictureWriter {
public:
    // Starts to write `film` to SCENE-001.exr or the next free number (freeStem), and its `aov` to a PNG of the same name.
    // With `denoised`, the PNG shows that, and the EXR has it besides.
    // Waits for earlier files, whose report is lost unless it was taken.
    void write(const std::filesystem::path& scene, Film film, Aov aov, const Look& look, std::optional<DenoisedPicture> denoised);
    // A sentence that says whether the files were written; nothing while they are being written, unless it should `wait`.
    std::optional<std::string> takeReport(bool wait);

private:
    std::future<std::string> writing_;
};

}  // namespace glim
