// PNG for looking at: 8 bits a channel, opaque.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace glim {

// The sRGB transfer function (IEC 61966-2-1) of `linear` clipped to 0..1, as a byte.
std::uint8_t srgbByte(double linear);

using Rgb8 = std::array<std::uint8_t, 3>;

// The bytes as they are, row 0 at the top, left to right.
void writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);

// What is not finite, in every picture: no exposure, clipping or scale hides it.
inline constexpr Rgb8 kMagenta{255, 0, 255};

}  // namespace glim
