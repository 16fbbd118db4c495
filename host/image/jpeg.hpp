// JPEG files, for people to look at.
#pragma once

#include "host/image/png.hpp"

namespace glim {

// As writePng. Quality 95, colours in full resolution (4:4:4).
void writeJpeg(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);

}  // namespace glim
