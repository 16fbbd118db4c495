// Where a film lies in its picture, as OpenEXR's windows say: the data window has its pixels, the display window is the picture.
#pragma once

#include "host/image/image.hpp"
#include "host/render/film.hpp"

#include <filesystem>

namespace glim {

// Sets the size and the windows of a file with the pixels of `film`, and the attribute that says what the film is cropped to.
void setWindows(Image& image, const Film& film);

// Sets the film's size, crop and rows to those of the file. Throws InputError if they contradict each other.
void takeWindows(const std::filesystem::path& path, const Image& image, Film& film);

}  // namespace glim
