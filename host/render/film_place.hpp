// Where a film lies in its picture, and where its camera stands. OpenEXR's data window has the film's pixels, its display window is the
// picture.
#pragma once

#include "host/image/image.hpp"
#include "host/render/film.hpp"

#include <filesystem>

namespace glim {

// Sets the size and the windows of a file with the pixels of `film`, and the attributes that name its crop and its camera.
void describePlace(Image& image, const Film& film);

// Sets the film's size, rows, crop and camera to those of the file. Throws InputError if they contradict each other.
void takePlace(const std::filesystem::path& path, const Image& image, Film& film);

}  // namespace glim
