// A film as an EXR file from which every bit of it can be read back.
//
// R, G, B      mean radiance, linear Rec.709; A coverage, with which R, G, B are already multiplied
// variance.RGB variance of R, G, B as means of independent blocks; infinity where a pixel has fewer than two blocks, and
//              no such layer if that is so everywhere. For other programs: reading a film ignores it
// albedo.RGB, normal.XYZ, depth.Z   as in PixelMoments; depth is infinity where every sample missed
// count.X, blocks.X, squares.RGB, clamped.X   the rest of PixelMoments, which merging needs
//
// With light paths, R, G, B and variance are of camera and light paths together, and there are more layers for merging:
// camera.RGB   PixelMoments::mean
// splats.RGB, splatSquares.RGB, splatClamped.X, splatCount.X, splatBlocks.X   SplatMoments
//
// Layers end in one letter, as Blender expects; the attributes are named glim:*.
#pragma once

#include "host/render/film.hpp"

#include <filesystem>

namespace glim {

void writeFilm(const std::filesystem::path& path, const Film& film);

// Refuses (InputError) files that writeFilm did not write.
Film readFilm(const std::filesystem::path& path);

// All but `pixels`.
Film readFilmHeader(const std::filesystem::path& path);

// "0:256 512:768"
std::string sampleRangesText(const Film& film);

}  // namespace glim
