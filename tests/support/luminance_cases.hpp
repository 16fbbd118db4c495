// Luminances of pixels for tests of the course's stopping rule, and the rule in double.
#pragma once

#include "shaders/shared/pixel_moments.h"
#include "tests/harness/random.hpp"

#include <cmath>
#include <optional>
#include <vector>

namespace glim {

// The rounding error of the ratio of the rule's two sides in float: the interval takes two quotients of 2.5 ulp (one under a root), two
// roots of 4.5 ulp, and four products and constants of half an ulp; the other side one product. 19 ulp of 2^-24 to 2^-23.
constexpr double kRuleRounding = 19.0 * 0x1p-23;

// Half the 95 % interval, divided by the largest that it may be: tolerance times mean. At least two samples.
inline double shareOfTolerance(const LuminanceMoments& moments, float tolerance)
{
    const double n = moments.count;
    const double variance = static_cast<double>(moments.squares) / (n - 1.0);
    return 1.96 * std::sqrt(variance / n) / (static_cast<double>(tolerance) * static_cast<double>(moments.mean));
}

// nullopt where rounding decides.
inline std::optional<bool> isAccurateInDouble(const LuminanceMoments& moments, float tolerance, std::uint32_t constantSamples)
{
    if (moments.count < 2) {
        return false;
    }
    if (moments.squares == 0.0F) {
        return moments.count >= constantSamples;
    }
    if (!(moments.mean > 0.0F)) {
        return false;
    }
    const double share = shareOfTolerance(moments, tolerance);
    return std::abs(share - 1.0) <= kRuleRounding ? std::nullopt : std::optional(share < 1.0);
}

// Some with 0 to 3 samples, some without any difference, some without light; the others from far off the rule's boundary to
// within rounding of it.
// A surface has been met in each.
inline LuminanceMoments anyLuminance(Random& random, float tolerance)
{
    const std::uint32_t count = random.below(4) == 0 ? random.below(4) : static_cast<std::uint32_t>(random.logUniform(4, 1e5));
    if (random.below(8) == 0) {
        return {count, random.below(2) == 0 ? 0.0F : random.unitFloat(), 0.0F, count};
    }
    const auto mean = static_cast<float>(random.logUniform(1e-6, 1e4));
    if (count < 2) {
        return {count, mean, 0.0F, count};
    }
    if (random.below(16) == 0) {
        return {count, -mean, mean * mean, count};
    }
    const double away = random.logUniform(1e-7, 2.0);
    const double share = random.below(2) == 0 ? 1.0 + away : 1.0 / (1.0 + away);
    const double n = count, interval = share * static_cast<double>(tolerance) * static_cast<double>(mean);
    return {count, mean, static_cast<float>(n * (n - 1.0) * std::pow(interval / 1.96, 2.0)), count};
}

}  // namespace glim
