// Radiance's .hdr files: red, green and blue with a common exponent. Ward, "Real Pixels" (Graphics Gems II, 1991).
#pragma once

#include "host/image/radiance_map.hpp"

namespace glim {

// Throws InputError that names the line or the row. Reads runs of the new and the old kind, plain pixels, all eight orders of the axes, and
// divides by the product of the EXPOSURE and COLORCORR lines.
RadianceMap readHdr(const std::filesystem::path& file);

}  // namespace glim
