// PNG files, for people to look at: 8 bits a channel.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace glim {

// `linear`, clipped to 0..1, after the sRGB transfer function (IEC 61966-2-1).
std::uint8_t srgbByte(double linear);

using Rgb8 = std::array<std::uint8_t, 3>;
using Rgba8 = std::array<std::uint8_t, 4>;  // the colour is not multiplied by alpha

// Of channels from 0 to 255.
Rgb8 roundToBytes(const glm::dvec3& color);

// Writes sRGB bytes as they are. Row 0 is at the top, pixels go from left to right.
void writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgb8>& pixels);
void writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height, const std::vector<Rgba8>& pixels);

// The colour of pixels that are not finite, in every picture. No exposure, clipping or scale may hide them.
inline constexpr Rgb8 kMagenta{255, 0, 255};

}  // namespace glim
