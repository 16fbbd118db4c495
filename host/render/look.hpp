// Ways to look at a film as colours.
#pragma once

#include "host/image/png.hpp"
#include "host/render/film.hpp"

namespace glim {

// The values are those of kLookRadiance ... (shaders/shared/display_types.h).
//   Radiance, Albedo   sRGB of clip(2^exposure x)
//   Normal             .5 + .5 n of the surfaces' mean normal, without a transfer curve; black where no ray met a surface
//   Depth              of the nearest surface, linear from white (nearest of the picture) to dark grey (farthest); black where none
//   Rate               samples, heatColor from the fewest to the most of the picture; blue if all have the same
//   Steps              of a film of --view bvh-steps: inner nodes visited per ray, heatColor from 0 to what 99.9 % of the pixels
//                      do not exceed
enum class Look : std::uint32_t { Radiance, Normal, Depth, Albedo, Rate, Steps };

// The ends of the scale on which `look` shows depths, samples or steps.
struct LookRange {
    float low = 0.0F, high = 1.0F;
};
LookRange computeRange(const Film& film, Look look);

// `exposure` in stops, of radiance and albedo. kMagenta where the mean is not finite.
Rgb8 lookAt(const PixelMoments& pixel, Look look, const LookRange& range, double exposure);

}  // namespace glim
