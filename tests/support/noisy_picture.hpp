// Pictures with normal noise of known variance, around known radiance.
#pragma once

#include "host/measure/picture.hpp"

#include <cmath>
#include <random>

namespace glim::test {

// Radiance from 0.2 to 2.2, different in every pixel and channel, times `scale`.
inline Picture makeTruth(std::uint32_t width, std::uint32_t height, float scale = 1.0F)
{
    Picture picture{width, height, {}, {}};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const float phase = 0.37F * static_cast<float>(i);
        picture.radiance.push_back(scale * glm::vec3(1.2F + std::sin(phase), 1.2F + std::cos(phase), 0.5F));
    }
    picture.variance.assign(picture.radiance.size(), glm::vec3(0.0F));
    return picture;
}

// `truth` with independent noise of standard deviation `relative` times each value, and that noise as its variance.
inline Picture addNoise(const Picture& truth, float relative, std::uint32_t seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    Picture picture = truth;
    for (std::size_t i = 0; i < picture.radiance.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const float deviation = relative * truth.radiance[i][c];
            picture.radiance[i][c] += deviation * normal(random);
            picture.variance[i][c] = deviation * deviation;
        }
    }
    return picture;
}

// Four standard deviations of the share of `trials` in which an event of probability p happens.
inline double shareMargin(double p, int trials) { return 4.0 * std::sqrt(p * (1.0 - p) / trials); }

}  // namespace glim::test
