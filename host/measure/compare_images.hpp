// How far a picture x is from a reference r. All metrics are means over pixels and channels of linear radiance; pixels
// that are not finite in either picture are left out and counted.
#pragma once

#include "host/measure/picture.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace glim {

struct SquaredErrors {
    double mse = 0.0;             // mean (x-r)^2
    double relMse = 0.0;          // mean (x-r)^2 / (r^2 + eps), eps = .01 mean(r)^2: the scene's brightness cancels
    double relMseAbsolute = 0.0;  // the same with eps = .01, as published comparisons use (Rousselle et al. 2011)
};

// Each of the three metrics drops its own largest terms. A few bright pixels may make up most of an error; trimmed figures stand beside
// the full ones, which alone are expected errors.
struct TrimmedErrors {
    std::size_t dropped = 0;  // pixels: .1 %, rounded down
    SquaredErrors kept;       // means over the other pixels
    SquaredErrors share;      // the dropped pixels' fraction of each sum; 0 if there is no error
};

// `pixels`: the mean over channels of each pixel's terms.
TrimmedErrors trimErrors(const std::vector<SquaredErrors>& pixels);

enum class IntervalSource {
    Variance,  // delta method, from the variance of every pixel of both pictures
    Blocks,    // delta method for a ratio of sums over 8x8 blocks (Cochran 1977, Sampling Techniques, section 6.3)
    None,      // fewer than 16 blocks and no variance
};

struct MeanRatio {
    double value = 0.0;            // mean(x) / mean(r)
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
    std::size_t withoutVariance = 0;  // of the picture, whose noise leaves them out
    SquaredErrors errors;
    TrimmedErrors trimmed;
    double epsilon = 0.0;  // of relMse
    double mape = 0.0;     // mean |x-r| / (|r| + .01 mean(r))
    std::array<MeanRatio, 3> ratio;
    MeanRatio ratioOfAll;  // all channels together; its interval allows for fully correlated channels
    IntervalSource intervalSource = IntervalSource::None;
    MaxError maxError;                                   // the largest |x-r|
    std::optional<SquaredErrors> noise, referenceNoise;  // estimateErrors(picture), estimateReferenceNoise(reference)
};

// Refuses (InputError) pictures of different sizes.
Comparison compareImages(const Picture& picture, const Picture& reference);

// Its `errors` alone, of pictures of one size; nothing if no pixel is finite in both.
std::optional<SquaredErrors> measureErrors(const Picture& picture, const Picture& reference);

// The picture's expected distance from the truth if it is unbiased, from its own variance. Nothing where no variance is known, where it
// left float's range (float_range.hpp), and where a pixel is not finite.
std::optional<SquaredErrors> estimateErrors(const Picture& picture);
// The same for a robustRadiance that is known.
std::optional<SquaredErrors> estimateErrors(const Picture& picture, const std::vector<glm::dvec3>& likely);
// The expected error of a reference, over its finite pixels and relative to its own values: to be subtracted from comparisons with it.
std::optional<SquaredErrors> estimateReferenceNoise(const Picture& reference);

// The mean over the channels of all finite pixels.
double meanRadiance(const Picture& picture);
// .01 mean^2, which keeps relMse finite where the picture is black.
double relativeEpsilon(const Picture& reference);

// x - r, pixel by pixel.
Image signedDifference(const Picture& picture, const Picture& reference);

}  // namespace glim
