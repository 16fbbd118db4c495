// How far a picture x is from a reference r. All metrics are means over pixels and channels of linear radiance; pixels
// that are not finite in either picture are left out and counted.
#pragma once

#include "host/measure/picture.hpp"
#include "host/measure/squared_errors.hpp"

#include <array>
#include <optional>

namespace glim {

enum class IntervalSource {
    Variance,  // delta method, from the variance of every pixel of both pictures
    Blocks,    // delta method for a ratio of sums over 8x8 blocks (Cochran 1977, Sampling Techniques, section 6.3)
    None,      // fewer than 16 blocks and no variance
};

struct MeanRatio {
    double value = 0.0;  // mean(x) / mean(r)
    double low = 0.0, high = 0.0;  // 95 % interval; NaN with IntervalSource::None
};

struct MaxError {
    std::uint32_t x = 0, y = 0;
    int channel = 0;
    float value = 0.0F, reference = 0.0F;
};

struct Comparison {
    std::size_t compared = 0;  // pixels
    std::size_t nonFinite = 0, nonFiniteInReference = 0;
    SquaredErrors errors;
    TrimmedErrors trimmed;
    double epsilon = 0.0;  // of relMse
    double mape = 0.0;     // mean |x-r| / (|r| + .01 mean(r))
    std::array<MeanRatio, 3> ratio;
    MeanRatio ratioOfAll;  // all channels together; its interval allows for fully correlated channels
    IntervalSource intervalSource = IntervalSource::None;
    MaxError maxError;     // the largest |x-r|
    std::optional<SquaredErrors> noise, referenceNoise;  // estimateErrors of the one, noiseOfReference of the other
};

// Refuses (InputError) pictures of different sizes.
Comparison compareImages(const Picture& picture, const Picture& reference);

// The picture's expected distance from the truth if it is unbiased, from its own variance. Nothing where no variance is known.
std::optional<SquaredErrors> estimateErrors(const Picture& picture);
// What to subtract from a comparison in which it is the reference: the same, but relative to the reference's very values.
std::optional<SquaredErrors> noiseOfReference(const Picture& reference);

// Over the pixels that are finite, and channels.
double meanRadiance(const Picture& picture);
// What keeps relMse finite where the picture is black: .01 mean^2.
double relativeEpsilon(const Picture& reference);

// x - r, pixel by pixel.
Image signedDifference(const Picture& picture, const Picture& reference);

}  // namespace glim
