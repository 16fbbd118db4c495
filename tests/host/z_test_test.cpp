#include "host/measure/z_test.hpp"
#include "host/error.hpp"
#include "host/measure/confidence.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/noisy_picture.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glim {
namespace {

using test::addNoise;
using test::makeTruth;
using test::shareMargin;

constexpr int kTrials = 2000;
constexpr float kNoise = 0.3F;

TEST(Normal, LimitsAreTheTabulatedOnes)
{
    EXPECT_NEAR(twoSidedLimit(0.05), 1.959963985, 1e-9);
    EXPECT_NEAR(twoSidedLimit(0.01), 2.575829304, 1e-9);
    EXPECT_NEAR(twoSidedLimit(2e-9), 5.997807015, 1e-8);
    EXPECT_NEAR(sidakLevel(0.05, 1), 0.05, 1e-15);
    EXPECT_NEAR(sidakLevel(0.01, 1000), 1.0 - std::pow(0.99, 1e-3), 1e-15);
    EXPECT_NEAR(twoSidedLimit(sidakLevel(0.01, 1910)), 4.55, 0.01);
}

struct Rejections {
    double means = 0, blocks = 0, spread = 0;
};

// The shares of correct pictures of `width` x `height` that each test rejects at level .05.
Rejections rejectCorrect(std::uint32_t width, std::uint32_t height)
{
    const Picture truth = makeTruth(width, height);
    EXPECT_EQ(zTest(truth, truth).compared, std::size_t{width} * height);
    Rejections share;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
        const ZTest test = zTest(addNoise(truth, kNoise, 2 * trial), addNoise(truth, 0.5F * kNoise, 2 * trial + 1), 0.05);
        share.means += !test.meansAgree();
        share.blocks += !test.blocksAgree();
        share.spread += !test.spreadAgrees();
    }
    return {share.means / kTrials, share.blocks / kTrials, share.spread / kTrials};
}

TEST(ZTest, RejectsCorrectPicturesAtTheNominalRate)
{
    const Rejections share = rejectCorrect(61, 35);  // with narrow blocks at two edges
    EXPECT_NEAR(share.means, 0.05, shareMargin(0.05, kTrials));
    EXPECT_NEAR(share.blocks, 0.05, shareMargin(0.05, kTrials));
    // Three channels of P(|chi^2_40 / 40 - 1| > 4 sqrt(2 / 40)) = 4.0e-4, as that distribution is skewed.
    EXPECT_LT(share.spread, 0.0012 + shareMargin(0.0012, kTrials));
}

TEST(ZTest, ZHasUnitVariance)
{
    const Picture truth = makeTruth(32, 32);
    double squares = 0, meanSquare = 0;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
        const ZTest test = zTest(addNoise(truth, kNoise, 2 * trial), addNoise(truth, kNoise, 2 * trial + 1));
        squares += test.meanZ[1] * test.meanZ[1] / kTrials;
        meanSquare += test.meanSquare[2] / kTrials;
    }
    EXPECT_NEAR(squares, 1.0, 4 * std::sqrt(2.0 / kTrials));
    EXPECT_NEAR(meanSquare, 1.0, 4 * std::sqrt(2.0 / (16.0 * kTrials)));
}

// The stated power: a bias of `detectableBias` is found in 95 % of the pictures.
TEST(ZTest, FindsTheBiasItSaysItWouldFind)
{
    const Picture truth = makeTruth(64, 64);
    const double bias = zTest(addNoise(truth, kNoise, 1), truth).detectableBias;
    EXPECT_LT(bias, 0.03);
    const Picture biased = makeTruth(64, 64, static_cast<float>(1.0 + bias));
    double found = 0;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
        const ZTest test = zTest(addNoise(biased, kNoise, trial), truth);
        found += std::abs(test.meanZ[0]) > test.meanLimit;  // red, which with green has the noisier mean
    }
    EXPECT_NEAR(found / kTrials, 0.95, shareMargin(0.95, kTrials));
}

TEST(ZTest, FindsOnePercent)
{
    const Picture truth = makeTruth(128, 128), brighter = makeTruth(128, 128, 1.01F);
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        const ZTest right = zTest(addNoise(truth, 0.1F, seed), addNoise(truth, 0.05F, seed + 1000), 1e-4);
        const ZTest wrong = zTest(addNoise(brighter, 0.1F, seed), addNoise(truth, 0.05F, seed + 1000), 1e-4);
        EXPECT_TRUE(right.agrees());
        EXPECT_FALSE(wrong.meansAgree());
        EXPECT_LT(right.detectableBias, 0.01);
    }
}

TEST(ZTest, FindsAWrongBlockThatTheMeanHides)
{
    const Picture truth = makeTruth(128, 128);
    Picture picture = addNoise(truth, kNoise, 5);
    for (std::uint32_t y = 40; y < 48; ++y) {
        for (std::uint32_t x = 64; x < 72; ++x) {
            picture.radiance[y * 128 + x].z *= 1.3F;
        }
    }
    const ZTest test = zTest(picture, addNoise(truth, kNoise, 6));
    EXPECT_TRUE(test.meansAgree());
    EXPECT_FALSE(test.blocksAgree());
    EXPECT_GT(test.worstZ, test.blockLimit);
    EXPECT_EQ(test.worstX, 64U);
    EXPECT_EQ(test.worstY, 40U);
    EXPECT_EQ(test.worstChannel, 2);
}

TEST(ZTest, FindsAWrongVariance)
{
    const Picture truth = makeTruth(128, 128);
    for (const float factor : {0.5F, 2.0F}) {
        Picture picture = addNoise(truth, kNoise, 7);
        for (glm::vec3& variance : picture.variance) {
            variance *= factor;
        }
        EXPECT_FALSE(zTest(picture, truth).spreadAgrees());
    }
}

TEST(ZTest, ForgivesRoundingWhereThereIsNoNoiseAndNothingElse)
{
    const Picture truth = makeTruth(16, 16);
    Picture picture = makeTruth(16, 16, 1.0F + 0x1p-22F);
    const ZTest rounded = zTest(picture, truth);
    EXPECT_TRUE(rounded.agrees());
    EXPECT_EQ(rounded.blocks[0] + rounded.blocks[1] + rounded.blocks[2], 0U);
    picture.radiance[100].y *= 1.01F;
    const ZTest wrong = zTest(picture, truth);
    EXPECT_FALSE(wrong.blocksAgree());
    EXPECT_FALSE(wrong.agrees());
}

TEST(ZTest, LeavesOutUnknownPixelsButRefusesToTestNothing)
{
    const Picture truth = makeTruth(16, 16);
    Picture picture = addNoise(truth, kNoise, 8);
    picture.variance[3].x = std::numeric_limits<float>::infinity();
    picture.radiance[4].y = std::numeric_limits<float>::quiet_NaN();
    const ZTest test = zTest(picture, truth);
    EXPECT_EQ(test.compared, 254U);
    EXPECT_TRUE(test.agrees());
    picture.variance.assign(256, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    test::expectRefusal<InputError>([&] { zTest(picture, truth); }, MessageId::Empty);
    picture.variance.clear();
    test::expectRefusal<InputError>([&] { zTest(picture, truth); }, MessageId::Mismatch);
}

}  // namespace
}  // namespace glim
