// AOVs (arbitrary output variables): the channels of a film, and how they are displayed as colours.
#pragma once

#include "host/image/png.hpp"
#include "host/render/film.hpp"
#include "host/render/settings.hpp"

namespace glim {

// How light becomes the colours of a picture. The values are those of kToneNone ... (shaders/shared/tone_mapping.h).
enum class Tone : std::uint32_t { None, Neutral, Agx };
const char* getName(Tone tone);  // none, neutral, agx
struct Look {
    double exposure = 0.0;  // stops, of radiance and albedo
    Tone tone = Tone::None;
};

// How each is displayed:
//   Radiance           sRGB of clip(tone(2^exposure x))
//   Albedo             sRGB of clip(2^exposure x)
//   Normal             .5 + .5 n of the surfaces' mean normal, without a transfer curve; black where no ray met a surface
//   Depth              of the nearest surface, linear from white (nearest of the picture) to dark grey (farthest); black where none
//   SampleCount        samples of a pixel, heatColor from the fewest to the most of the picture; blue if all have the same
//   BvhSteps           with --view bvh-steps: inner nodes visited per ray, heatColor from 0 to the 99.9th percentile of the pixels
//   Guide              with --view guide: .5 + .5 w of the guide's mean direction w, times log2(N) / 6, at most 1, where it chooses among
//                      1/N of all directions; black where there is no guide
// The ends of the scale on which `aov` shows depths, samples or steps.
struct DisplayRange {
    float low = 0.0F, high = 1.0F;
};
DisplayRange computeRange(const Film& film, Aov aov);

// Returns kMagenta if the mean is not finite.
Rgb8 displayColor(const PixelMoments& pixel, Aov aov, const DisplayRange& range, const Look& look);

// The same of the surfaces in the pixel alone, with their coverage as alpha. Transparent pixels are black.
Rgba8 displaySurfaces(const PixelMoments& pixel, Aov aov, const DisplayRange& range, const Look& look);

}  // namespace glim
