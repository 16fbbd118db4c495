// Images made smaller.
#pragma once

#include "host/image/decode_image.hpp"

namespace glim {

// Halves both sides as often as needed for the longer one to be at most `maxSide`. A new texel is the mean of what it covers, by area. The
// mean of colours (`srgb`) is that of their linear values, the mean of alpha that of the values as they are.
DecodedImage shrinkImage(DecodedImage image, std::uint32_t maxSide, bool srgb);

}  // namespace glim
