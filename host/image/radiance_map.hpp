// Latitude-longitude maps of radiance: .hdr (Radiance) and .exr (OpenEXR).
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace glim {

inline constexpr std::uint32_t kMaxMapWidth = 32768, kMaxMapHeight = 16384;
inline constexpr std::uint64_t kMaxMapTexels = std::uint64_t{1} << 27;  // 16,384 x 8,192

struct RadianceMap {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::vec3> texels;  // rows from the top, linear Rec.709
    std::uint64_t repaired = 0;     // texels with a negative or not finite channel, which is 0 now
};

// Tells the kind by the content. Throws InputError, "<file>: <sentence>".
RadianceMap readRadianceMap(const std::filesystem::path& file);

// Radiance's .hdr files: red, green and blue with a common exponent. Ward, "Real Pixels" (Graphics Gems II, 1991). Throws InputError that
// names the line or the row. Reads runs of the new and the old kind, plain pixels, all eight orders of the axes, and divides by the product
// of the EXPOSURE and COLORCORR lines. Own code, since stb_image reads one order of the axes and drops the exposure.
RadianceMap readHdr(const std::filesystem::path& file);

}  // namespace glim
