// Errors pixel by pixel, and how far they are from a target.
#include "host/measure/error_map.hpp"

#include "host/measure/compare_images.hpp"
#include "host/preview/error_layer.hpp"
#include "host/preview/error_target.hpp"
#include "host/render/robust_radiance.hpp"
#include "shaders/shared/display_colors.h"
#include "tests/support/noisy_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace glim {
namespace {

Picture noisyPicture() { return test::addNoise(test::makeTruth(48, 32), 0.05F, 7); }

std::vector<float> errorsOf(const Picture& picture)
{
    return mapErrors(picture, robustRadiance(picture.width, picture.height, picture.radiance, picture.variance));
}

TEST(ErrorMapTest, ItsMeanIsTheRelMse)
{
    Picture picture = noisyPicture();
    const std::vector<float> whole = errorsOf(picture);
    const double expected = estimateErrors(picture)->relMse;
    EXPECT_GT(expected, 0.0);
    EXPECT_NEAR(std::accumulate(whole.begin(), whole.end(), 0.0) / static_cast<double>(whole.size()), expected, 1e-6 * expected);

    picture.variance[5] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    picture.variance[6].y = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> known = errorsOf(picture);
    EXPECT_EQ(known[5], static_cast<float>(kUnknownError));
    EXPECT_EQ(known[6], static_cast<float>(kUnknownError));
    known.erase(known.begin() + 5, known.begin() + 7);
    const double ofKnown = estimateErrors(picture)->relMse;
    EXPECT_NEAR(std::accumulate(known.begin(), known.end(), 0.0) / static_cast<double>(known.size()), ofKnown, 1e-6 * ofKnown);
}

TEST(ErrorMapTest, WhatIsNotFiniteHasNoError)
{
    Picture picture = noisyPicture();
    picture.radiance[9].z = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(std::isnan(errorsOf(picture)[9]));
    EXPECT_TRUE(std::isfinite(errorsOf(picture)[8]));
}

TEST(ErrorLayerTest, MapsOnlyWhatIsShown)
{
    const Picture picture = noisyPicture();
    const std::vector<glm::dvec3> likely(picture.radiance.begin(), picture.radiance.end());
    ErrorLayer layer;
    layer.take(picture, likely);
    EXPECT_FALSE(layer.isKnown()) << "no work while it is hidden";
    layer.show(true);
    layer.take(picture, likely);
    EXPECT_EQ(layer.values(), mapErrors(picture, likely));
    const std::uint64_t version = layer.version();
    layer.restart();
    EXPECT_FALSE(layer.isKnown());
    layer.take(picture, likely);
    EXPECT_NE(layer.version(), version);
    layer.show(false);
    EXPECT_FALSE(layer.isKnown());
}

// 2,000,000 samples had four times the target's error. 8,000,000 are needed, and 3,000,000 are there.
TEST(ErrorTargetTest, TellsTheTimeByTheFallOfTheError)
{
    const ErrorPoint last{10.0, 0.004, 2000000, true};
    EXPECT_EQ(describeTarget(0.001, last, 3000000, 1e5, false), "about 50 s to the target 0.001");
    EXPECT_EQ(describeTarget(0.001, last, 8000001, 1e5, false), "about 0 s to the target 0.001") << "until it is estimated again";
    EXPECT_EQ(describeTarget(0.001, last, 3000000, 0.0, false), "target 0.001: ETA unknown");
    EXPECT_EQ(describeTarget(0.001, last, 3000000, 1e5, true), "target 0.001: not reached");
    EXPECT_EQ(describeTarget(0.004, last, 3000000, 1e5, false), "target 0.004: reached");
    EXPECT_EQ(describeTarget(0.004, last, 3000000, 1e5, true), "target 0.004: reached");
    EXPECT_EQ(describeTarget(0.01, {10.0, 0.004, 2000000, false}, 3000000, 1e5, false), "target 0.01: some pixels have too few samples");
}

TEST(ErrorTargetTest, TheErrorIsEstimatedAgainWhereTheTargetIsExpected)
{
    const ErrorPoint last{10.0, 0.0011, 1000, true};
    EXPECT_DOUBLE_EQ(growthToNext(last, 0.001), 1.1);
    EXPECT_DOUBLE_EQ(growthToNext(last, 0.0001), 1.25) << "far away";
    EXPECT_DOUBLE_EQ(growthToNext(last, 0.0011), 1.25) << "it is reached";
    EXPECT_DOUBLE_EQ(growthToNext(last, 0.00109), 1.05) << "not after each sample";
}

}  // namespace
}  // namespace glim
