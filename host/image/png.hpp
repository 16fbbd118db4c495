// PNG for looking at: 8 bits a channel, opaque.
#pragma once

#include "host/image/image.hpp"

#include <cstdint>
#include <filesystem>

namespace glim {

// The sRGB transfer function (IEC 61966-2-1) of `linear` clipped to 0..1, as a byte.
std::uint8_t srgbByte(double linear);

// sRGB of clip(2^exposure x) of the channels R, G and B. A pixel with a non-finite value is magenta, which no exposure
// or clipping hides.
void writePng(const std::filesystem::path& path, const Image& image, double exposure);

}  // namespace glim
