// Films as PNGs to look at.
#pragma once

#include "host/render/film.hpp"

#include <filesystem>

namespace glim {

// By the film's --view, which its settings name:
//   shaded, albedo   sRGB of clip(2^exposure x), exposure in stops
//   normal           .5 + .5 n of the surfaces' mean normal, without a transfer curve; black where no ray met a surface
//   depth            of the surfaces, linear from white (nearest of the picture) to dark grey (farthest); black where there is none
//   bvh-steps        inner nodes visited per ray, heatColor from 0 to what 99.9 % of the pixels do not exceed
void writeFilmPng(const std::filesystem::path& path, const Film& film, double exposure);

// Samples per pixel, heatColor from the fewest to the most in the picture; blue if all have the same.
void writeRatesPng(const std::filesystem::path& path, const Film& film);

}  // namespace glim
