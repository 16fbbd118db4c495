// UASTC LDR 4x4, a subset of ASTC in bits of its own: "UASTC Texture Specification" (Binomial's wiki of Basis Universal).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace glim {

inline constexpr std::size_t kUastcBlockBytes = 16;

using UastcTexels = std::array<std::array<std::uint8_t, 4>, 16>;  // RGBA, rows from the top

// False if the block is of the reserved mode, or names a pattern that does not exist.
bool decodeUastc(std::span<const unsigned char, kUastcBlockBytes> block, UastcTexels& texels);

}  // namespace glim
