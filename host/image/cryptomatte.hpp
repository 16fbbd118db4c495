// Cryptomatte: mattes by name, as RGBA layers of an EXR file (Friedman and Jones, "Cryptomatte Specification", 1.1.0).
#pragma once

#include "host/image/image.hpp"

#include <string_view>

namespace glim {

// The ids that a pixel keeps: those that cover most of it. Two to a layer: R and B are ids, G and A what they cover.
inline constexpr std::size_t kMatteRanks = 6;

// MurmurHash3_x86_32 with seed 0 (Austin Appleby, SMHasher).
std::uint32_t murmurHash3(std::string_view text);

// The bits of the float that stands for the name: its hash, with the exponent moved to 1 or 254 where the float would not be normal.
std::uint32_t matteId(std::string_view name);

// The channel of an id, as in CryptoObject00.R. Blender's readers of all versions know upper-case letters, and so does Nuke.
std::string matteIdChannel(const std::string& layer, std::size_t rank);
// The channel of what that id covers.
std::string matteCoverageChannel(const std::string& layer, std::size_t rank);

// Adds what describes the layer, with a manifest of these names in UTF-8 and their ids.
void addMatteAttributes(Image& image, const std::string& layer, const std::map<std::string, std::uint32_t>& manifest);

}  // namespace glim
