#include "host/measure/compare_images.hpp"
#include "host/measure/error_picture.hpp"
#include "shaders/shared/display_colors.h"
#include "tests/support/noisy_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim {
namespace {

using test::addNoise;
using test::makeTruth;

std::vector<SquaredErrors> rising(std::size_t count)
{
    std::vector<SquaredErrors> pixels(count);
    for (std::size_t i = 0; i < count; ++i) {
        pixels[i] = {static_cast<double>(i + 1), static_cast<double>(count - i), 1.0};
    }
    return pixels;
}

TEST(TrimErrors, DropsTheLargestTermsOfEachMetric)
{
    // 1 to 2000 without 1999 and 2000, each in the order of its own metric; equal terms are as good as each other.
    const TrimmedErrors trimmed = trimErrors(rising(2000));
    EXPECT_EQ(trimmed.dropped, 2U);
    EXPECT_DOUBLE_EQ(trimmed.kept.mse, 999.5);
    EXPECT_DOUBLE_EQ(trimmed.kept.relMse, 999.5);
    EXPECT_DOUBLE_EQ(trimmed.kept.relMseAbsolute, 1.0);
    EXPECT_DOUBLE_EQ(trimmed.share.mse, 3999.0 / 2001000.0);
    EXPECT_DOUBLE_EQ(trimmed.share.relMse, 3999.0 / 2001000.0);
    EXPECT_DOUBLE_EQ(trimmed.share.relMseAbsolute, 0.001);
}

TEST(TrimErrors, DropsNothingIfAThousandthIsLessThanAPixel)
{
    const TrimmedErrors trimmed = trimErrors(rising(999));
    EXPECT_EQ(trimmed.dropped, 0U);
    EXPECT_DOUBLE_EQ(trimmed.kept.mse, 500.0);
    EXPECT_EQ(trimmed.share.mse, 0.0);
    const TrimmedErrors exact = trimErrors(std::vector<SquaredErrors>(5000));
    EXPECT_EQ(exact.dropped, 5U);
    EXPECT_EQ(exact.kept.relMse, 0.0);
    EXPECT_EQ(exact.share.relMse, 0.0);
}

TEST(TrimErrors, FirefliesAreTheShareThatTheyHave)
{
    const Picture truth = makeTruth(64, 64);
    Picture picture = addNoise(truth, 0.01F, 1);
    const double calm = compareImages(picture, truth).errors.mse;
    for (const std::size_t i : {5U, 700U, 2000U, 4095U}) {
        picture.radiance[i] = truth.radiance[i] + 10.0F;
    }
    const Comparison result = compareImages(picture, truth);
    EXPECT_EQ(result.trimmed.dropped, 4U);
    // Four of 4,096 pixels, each wrong by 10: their error is known to float32, and without them the noise is left.
    EXPECT_NEAR(result.errors.mse, calm + 400.0 / 4096.0, 1e-5);
    EXPECT_NEAR(result.trimmed.kept.mse, calm, 0.01 * calm);
    EXPECT_NEAR(result.trimmed.share.mse, 400.0 / 4096.0 / result.errors.mse, 1e-6);
    EXPECT_GT(result.trimmed.share.relMse, 0.99);
}

Rgb8 colorOf(double difference) { return roundToBytes(differenceColor(difference)); }

TEST(DifferenceColor, IsBlueBelowAndRedAbove)
{
    EXPECT_EQ(colorOf(0.0), (Rgb8{255, 255, 255}));
    EXPECT_EQ(colorOf(1.0), (Rgb8{200, 0, 0}));
    EXPECT_EQ(colorOf(7.0), colorOf(1.0));
    EXPECT_EQ(colorOf(-1.0), (Rgb8{0, 40, 200}));
    EXPECT_EQ(colorOf(-std::numeric_limits<double>::infinity()), colorOf(-1.0));
    EXPECT_EQ(colorOf(0.5), (Rgb8{228, 128, 128}));
}

TEST(DrawErrors, ColoursShowTheSignAndTheScaleIsThe95thPercentile)
{
    // Errors of -1 to 1 in 101 equal steps against a reference of 2, and one firefly: 95 % stay below .95.
    Picture reference{102, 1, std::vector<glm::vec3>(102, glm::vec3(2.0F)), {}}, picture = reference;
    for (std::size_t i = 0; i < 101; ++i) {
        picture.radiance[i] += 0.02F * (static_cast<float>(i) - 50.0F);
    }
    picture.radiance[101] = glm::vec3(1e6F);
    const ErrorPicture drawn = drawErrors(picture, reference, 0.04);
    EXPECT_NEAR(drawn.scale, 0.96 / std::sqrt(4.04), 1e-6);
    EXPECT_EQ(drawn.pixels[0], colorOf(-1.0));
    EXPECT_EQ(drawn.pixels[26], colorOf(-0.5));
    EXPECT_EQ(drawn.pixels[50], colorOf(0.0));
    EXPECT_EQ(drawn.pixels[74], colorOf(0.5));
    EXPECT_EQ(drawn.pixels[101], colorOf(1.0));
}

TEST(DrawErrors, OfNothingWrongIsWhiteAndOfNothingFiniteMagenta)
{
    const Picture truth = makeTruth(20, 20);
    const ErrorPicture same = drawErrors(truth, truth, 0.01);
    EXPECT_EQ(same.scale, 0.0);
    EXPECT_EQ(same.pixels, std::vector<Rgb8>(400, Rgb8{255, 255, 255}));
    Picture corner = truth;
    corner.radiance[3] -= 0.1F;  // the only one: a scale of what 95 % stay below would be 0
    corner.radiance[4].y = std::numeric_limits<float>::quiet_NaN();
    const ErrorPicture drawn = drawErrors(corner, truth, 0.01);
    EXPECT_GT(drawn.scale, 0.0);
    EXPECT_EQ(drawn.pixels[3], colorOf(-1.0));
    EXPECT_EQ(drawn.pixels[4], kMagenta);
    EXPECT_EQ(drawn.pixels[5], colorOf(0.0));
    const Picture black{1, 1, {glm::vec3(0.0F)}, {}}, lit{1, 1, {glm::vec3(1.0F)}, {}};
    EXPECT_EQ(drawErrors(lit, black, 0.0).pixels[0], colorOf(1.0));
}

// Of 100 pixels that differ by 1, 2 ... 100, at a reference of 10.
TEST(DrawErrors, TheScaleIsRelativeOrPlain)
{
    Picture picture{100, 1, {}, {}}, reference{100, 1, std::vector<glm::vec3>(100, glm::vec3(10.0F)), {}};
    for (int i = 0; i < 100; ++i) {
        picture.radiance.emplace_back(11.0F + static_cast<float>(i));
    }
    EXPECT_DOUBLE_EQ(chooseErrorScale(picture, reference, 0.0, 1.0), 96.0);
    EXPECT_DOUBLE_EQ(chooseErrorScale(picture, reference, 1.0, 0.0), 9.6);
}

}  // namespace
}  // namespace glim
