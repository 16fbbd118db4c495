// Whether float32 still holds a variance.
#pragma once

#include <algorithm>
#include <cmath>

namespace glim {

// Whether a mean variance (of pixels' means, over pixels and channels) is known, which sums of squares in float32 were made into. `mean`:
// the mean radiance, over the same. None of the squares may have overflowed. A device may flush what is below 2^-126, the least normal
// number, and folding two blocks of at most 128 samples multiplies that loss by up to 64 (shaders/lib/moments.glsl): 2^-120 may be missing.
// That must be small against the variance, or against the rounding of float32 radiance, 2^-24 of it. So the variance of a black picture is
// unknown: what it has not found may be small or large.
inline bool isWithinFloat(double variance, double mean)
{
    return std::isfinite(variance) && 0x1p-120 <= std::max(0x1p-10 * variance, 0x1p-48 * mean * mean);
}

}  // namespace glim
