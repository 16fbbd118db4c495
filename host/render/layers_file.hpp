// A picture for compositing and for trainings: what a film shows, as an EXR of the standard layers alone. It is no film.
//
// R G B A                   as drawn, denoised if it was; half floats
// albedo.R .G .B, normal.X .Y .Z   half floats
// depth.Z                   32-bit floats, since half floats have steps of a millimetre at two metres
#pragma once

#include "host/image/image.hpp"
#include "host/render/film.hpp"

#include <filesystem>

namespace glim {

// What half floats do not hold, beyond 65,504, is stored as that and warned of. Throws InputError if it cannot be written.
void writeLayers(const std::filesystem::path& path, const Film& film, ExrCompression compression = ExrCompression::Zip);

}  // namespace glim
