// A window that shows finished films, one or two of them.
#pragma once

#include "host/render/film_pictures.hpp"

#include <filesystem>
#include <optional>

namespace glim {

struct ViewOptions {
    std::filesystem::path film;
    std::optional<std::filesystem::path> reference;
    std::optional<glm::uvec2> size;  // of the window; absent: the film's, between 640x480 and the screen
    std::optional<std::string> device;
    LookOptions look;
    std::optional<std::filesystem::path> script;
};

// Runs until the user or the script closes the window. Throws InputError if there is no display, or if a film is refused or has another
// size than the reference; DeviceError if the device fails.
void view(const ViewOptions& options);

}  // namespace glim
