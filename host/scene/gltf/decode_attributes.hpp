// Mode ATTRIBUTES of KHR_meshopt_compression: both versions of its bitstream, and its filter COLOR (its appendices A and B).
// Version 0 is the bitstream of EXT_meshopt_compression.
#pragma once

#include <cstddef>
#include <span>

namespace glim {

// Fills `elements` with whole elements of `stride` bytes, a multiple of 4 up to 256. False if the stream is damaged or of another version.
bool decodeAttributes(std::span<const unsigned char> stream, std::size_t stride, std::span<unsigned char> elements);

// From YCoCg and a scale to RGBA, in place. `stride`: 4 (components of 8 bits) or 8 (of 16 bits).
void decodeColors(std::size_t stride, std::span<unsigned char> elements);

}  // namespace glim
