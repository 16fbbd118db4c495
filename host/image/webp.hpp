// WebP files, for people to look at.
#pragma once

#include "host/image/png.hpp"

namespace glim {

// As writePng, without loss. At most 16383 pixels a side.
void writeWebp(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);

}  // namespace glim
