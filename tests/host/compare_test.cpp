#include "host/cli/commands.hpp"
#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/measure/compare_images.hpp"
#include "host/measure/error_picture.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/noisy_picture.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace glim {
namespace {

using test::addNoise;
using test::expectRefusal;
using test::makeTruth;
using test::ScratchFolder;
using test::shareMargin;

Picture uniform(std::uint32_t side, const glm::vec3& radiance) { return {side, side, std::vector<glm::vec3>(side * side, radiance), {}}; }

TEST(CompareImages, MetricsOfAKnownDifference)
{
    const Comparison result = compareImages(uniform(4, {1.5F, 2.0F, 3.0F}), uniform(4, {1.0F, 2.0F, 6.0F}));
    // Differences .5, 0, -3; mean(r) = 3, so eps = .09.
    EXPECT_DOUBLE_EQ(result.epsilon, 0.09);
    EXPECT_DOUBLE_EQ(result.errors.mse, (0.25 + 9) / 3);
    EXPECT_DOUBLE_EQ(result.errors.relMse, (0.25 / 1.09 + 9 / 36.09) / 3);
    EXPECT_DOUBLE_EQ(result.errors.relMseAbsolute, (0.25 / 1.01 + 9 / 36.01) / 3);
    EXPECT_DOUBLE_EQ(result.mape, (0.5 / 1.03 + 3 / 6.03) / 3);
    EXPECT_DOUBLE_EQ(result.ratio[0].value, 1.5);
    EXPECT_DOUBLE_EQ(result.ratio[1].value, 1.0);
    EXPECT_DOUBLE_EQ(result.ratio[2].value, 0.5);
    EXPECT_DOUBLE_EQ(result.ratioOfAll.value, 6.5 / 9);
    EXPECT_EQ(result.compared, 16U);
    EXPECT_EQ(result.maxError.channel, 2);
    EXPECT_EQ(result.maxError.value, 3.0F);
    EXPECT_EQ(result.maxError.reference, 6.0F);
    EXPECT_FALSE(result.noise || result.referenceNoise);
    EXPECT_EQ(result.intervalSource, IntervalSource::None);
    EXPECT_TRUE(std::isnan(result.ratioOfAll.low));
}

TEST(CompareImages, MeasureErrorsGivesTheSameErrors)
{
    Picture picture = addNoise(makeTruth(12, 9), 0.3F, 3), reference = addNoise(makeTruth(12, 9), 0.1F, 4);
    picture.radiance[5].g = std::numeric_limits<float>::quiet_NaN();
    reference.radiance[7].r = std::numeric_limits<float>::infinity();
    const SquaredErrors expected = compareImages(picture, reference).errors, alone = measureErrors(picture, reference).value();
    EXPECT_NEAR(alone.mse / expected.mse, 1.0, 1e-12);
    EXPECT_NEAR(alone.relMse / expected.relMse, 1.0, 1e-12);
    EXPECT_NEAR(alone.relMseAbsolute / expected.relMseAbsolute, 1.0, 1e-12);
    EXPECT_FALSE(measureErrors(uniform(2, glm::vec3(std::numeric_limits<float>::quiet_NaN())), uniform(2, glm::vec3(1.0F))));
}

TEST(CompareImages, EpsilonFollowsTheBrightness)
{
    const Comparison dim = compareImages(addNoise(makeTruth(8, 8), 0.2F, 1), makeTruth(8, 8));
    const Comparison bright = compareImages(addNoise(makeTruth(8, 8, 1024), 0.2F, 1), makeTruth(8, 8, 1024));
    EXPECT_NEAR(bright.errors.relMse, dim.errors.relMse, 1e-6 * dim.errors.relMse);
    EXPECT_NEAR(bright.mape, dim.mape, 1e-6 * dim.mape);
}

TEST(CompareImages, FindsTheLargestDifference)
{
    const Picture reference = makeTruth(9, 5);
    Picture picture = reference;
    picture.radiance[3 * 9 + 7].y -= 0.5F;
    picture.radiance[0].x += 0.25F;
    const Comparison result = compareImages(picture, reference);
    EXPECT_EQ(result.maxError.x, 7U);
    EXPECT_EQ(result.maxError.y, 3U);
    EXPECT_EQ(result.maxError.channel, 1);
}

TEST(CompareImages, CountsNonFinitePixelsAndLeavesThemOut)
{
    Picture picture = uniform(4, glm::vec3(1.0F)), reference = uniform(4, glm::vec3(2.0F));
    picture.radiance[0].x = std::numeric_limits<float>::quiet_NaN();
    picture.radiance[1].y = -std::numeric_limits<float>::infinity();
    reference.radiance[1].z = std::numeric_limits<float>::infinity();
    reference.radiance[2] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
    const Comparison result = compareImages(picture, reference);
    EXPECT_EQ(result.nonFinite, 2U);
    EXPECT_EQ(result.nonFiniteInReference, 2U);
    EXPECT_EQ(result.compared, 13U);
    EXPECT_DOUBLE_EQ(result.errors.mse, 1.0);
    EXPECT_DOUBLE_EQ(result.ratioOfAll.value, 0.5);
    EXPECT_DOUBLE_EQ(result.epsilon, 0.04);
}

TEST(CompareImages, RefusesOtherSizesOtherRowsAndNothingToCompare)
{
    expectRefusal<InputError>([] { compareImages(makeTruth(4, 5), makeTruth(5, 4)); }, MessageId::Mismatch,
                              {.value = "4x5", .expected = "5x4"});
    Film band;
    band.width = band.height = 2;
    band.pixels.resize(4);
    Film below = band;
    band.rowsBelow = below.rowsAbove = 2;
    expectRefusal<InputError>([&] { compareImages(makePicture(band), makePicture(below)); }, MessageId::Mismatch,
                              {.place = "rows", .value = "0", .expected = "2"});
    Picture aside = makePicture(band);
    aside.columnsLeft = 3;
    expectRefusal<InputError>([&] { compareImages(makePicture(band), aside); }, MessageId::Mismatch,
                              {.place = "columns", .value = "0", .expected = "3"});
    const Picture nothing = uniform(2, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
    expectRefusal<InputError>([&] { compareImages(nothing, uniform(2, glm::vec3(1.0F))); }, MessageId::Empty);
}

// Share of intervals for the true ratio 1.1 that contain it, per channel and over all.
std::array<double, 4> coverage(bool withVariance)
{
    constexpr int kTrials = 1000;
    const Picture truth = makeTruth(64, 64), brighter = makeTruth(64, 64, 1.1F);
    std::array<double, 4> share{};
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
        Picture picture = addNoise(brighter, 0.3F, 2 * trial), reference = addNoise(truth, 0.3F, 2 * trial + 1);
        if (!withVariance) {
            picture.variance.clear();
        }
        const Comparison result = compareImages(picture, reference);
        EXPECT_EQ(result.intervalSource, withVariance ? IntervalSource::Variance : IntervalSource::Blocks);
        const MeanRatio ratios[4] = {result.ratio[0], result.ratio[1], result.ratio[2], result.ratioOfAll};
        for (std::size_t i = 0; i < 4; ++i) {
            share[i] += (ratios[i].low <= 1.1 && 1.1 <= ratios[i].high) / static_cast<double>(kTrials);
        }
    }
    return share;
}

TEST(CompareImages, IntervalsFromVarianceHoldTheTruthInNinetyFivePercent)
{
    const auto share = coverage(true);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(share[c], 0.95, shareMargin(0.95, 1000));
    }
    EXPECT_GT(share[3], 0.95 - shareMargin(0.95, 1000));  // these channels are independent: wider than need be
}

TEST(CompareImages, IntervalsFromBlocksHoldTheTruthInNinetyFivePercent)
{
    for (const double share : coverage(false)) {
        EXPECT_NEAR(share, 0.945, shareMargin(0.945, 1000));  // a normal limit for Student's with 63 degrees of freedom
    }
}

TEST(EstimateErrors, IsTheExpectedErrorAgainstTheTruth)
{
    const Picture truth = makeTruth(64, 64);
    const Picture picture = addNoise(truth, 0.1F, 3);
    const auto estimate = estimateErrors(picture);
    ASSERT_TRUE(estimate);
    const SquaredErrors measured = compareImages(picture, truth).errors;
    // 12,288 squares of normal numbers: 1.3 % standard deviation, more where weights differ. The estimate is relative to 1 + min(d, 0), as
    // neighbours are alike: a deviation of d = .1 adds 2 d / sqrt(2 pi) + 3/2 d^2 = .095. It is never below the truth.
    EXPECT_NEAR(estimate->mse, measured.mse, 0.08 * measured.mse);
    EXPECT_NEAR(estimate->relMse, 1.095 * measured.relMse, 0.08 * measured.relMse);
    EXPECT_NEAR(estimate->relMseAbsolute, 1.095 * measured.relMseAbsolute, 0.08 * measured.relMseAbsolute);
}

TEST(EstimateErrors, OfAKnownVariance)
{
    Picture picture = uniform(2, {1.0F, 2.0F, 6.0F});
    picture.variance.assign(4, {0.25F, 0.0F, 9.0F});
    picture.variance[1].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_DOUBLE_EQ(estimateErrors(picture)->mse, 9.25 / 3);
    EXPECT_DOUBLE_EQ(estimateErrors(picture)->relMse, (0.25 / 1.09 + 9 / 36.09) / 3);
    EXPECT_DOUBLE_EQ(compareImages(picture, picture).referenceNoise->relMseAbsolute, (0.25 / 1.01 + 9 / 36.01) / 3);
    EXPECT_EQ(compareImages(picture, picture).withoutVariance, 1U);
    picture.variance[1].x = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(estimateErrors(picture)) << "a square overflowed: without it the error would be too small";
    EXPECT_FALSE(compareImages(picture, picture).noise);
    picture.variance[1].x = 0.25F;
    picture.radiance[2].y = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(estimateErrors(picture));
    EXPECT_TRUE(estimateReferenceNoise(picture)) << "of what is compared with it";
    picture.variance.clear();
    EXPECT_FALSE(estimateErrors(picture));
}

// Intervals from variances that float32 does not hold would be too narrow, or points.
TEST(CompareImages, IntervalsOfSmallAndLargeRadianceComeFromBlocks)
{
    const Picture truth = makeTruth(64, 64), noisy = addNoise(truth, 0.1F, 3);
    for (const int exponent : {0, -70, 70}) {
        Picture picture = noisy, reference = truth;
        for (Picture* each : {&picture, &reference}) {
            for (std::size_t i = 0; i < each->radiance.size(); ++i) {
                each->radiance[i] *= std::exp2(static_cast<float>(exponent));
                each->variance[i] = glm::vec3(0.01F) * std::exp2(static_cast<float>(exponent)) * std::exp2(static_cast<float>(exponent));
            }
        }
        const Comparison result = compareImages(picture, reference);
        EXPECT_EQ(result.intervalSource, exponent == 0 ? IntervalSource::Variance : IntervalSource::Blocks) << exponent;
        EXPECT_EQ(result.noise.has_value(), exponent == 0) << exponent;
        EXPECT_LT(result.ratioOfAll.low, result.ratioOfAll.high) << exponent;
    }
}

class CompareCommand : public testing::Test {
protected:
    static Image imageOf(const Picture& picture, bool asVariance)
    {
        Image image;
        image.width = picture.width;
        image.height = picture.height;
        for (const glm::vec3& value : asVariance ? picture.variance : picture.radiance) {
            image.channels["R"].push_back(value.x);
            image.channels["G"].push_back(value.y);
            image.channels["B"].push_back(value.z);
        }
        return image;
    }
    static std::string run(std::vector<std::string> arguments)
    {
        CommandLine line("", "", "");
        addCompare(line);
        arguments.insert(arguments.begin(), "compare");
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        try {
            line.run(arguments);
        } catch (...) {
            testing::internal::GetCapturedStdout();
            testing::internal::GetCapturedStderr();
            throw;
        }
        testing::internal::GetCapturedStderr();
        return testing::internal::GetCapturedStdout();
    }
    CompareCommand()
    {
        const Picture truth = makeTruth(64, 64);
        const Picture picture = addNoise(truth, 0.3F, 1), reference = addNoise(truth, 0.1F, 2);
        Image film = imageOf(picture, false);
        const Image variance = imageOf(picture, true);
        for (const auto& [name, plane] : variance.channels) {
            film.channels["variance." + name] = plane;
        }
        writeExr(a, film);
        writeExr(b, imageOf(reference, false));
        writeExr(v, imageOf(reference, true));
    }
    const ScratchFolder folder;
    const std::string a = folder / "a.exr", b = folder / "b.exr", v = folder / "v.exr", d = folder / "d.exr";
};

TEST_F(CompareCommand, PrintsJsonThatAgreesWithTheFunctions)
{
    const auto json = nlohmann::json::parse(run({a, b, "--variance", v, "--json", "--diff", d}));
    Picture reference = makePicture(readExr(b), b);
    setVariance(reference, readExr(v), v);
    const Picture picture = makePicture(readExr(a), a);
    const Comparison expected = compareImages(picture, reference);
    EXPECT_EQ(json["relmse"], expected.errors.relMse);
    EXPECT_EQ(json["relmse_absolute"], expected.errors.relMseAbsolute);
    EXPECT_EQ(json["trimmed"]["relmse"], expected.trimmed.kept.relMse);
    EXPECT_EQ(json["trimmed"]["dropped_share"]["mse"], expected.trimmed.share.mse);
    EXPECT_EQ(json["trimmed"]["dropped_pixels"], 4);
    EXPECT_EQ(json["reference_noise"]["mse"], expected.referenceNoise->mse);
    EXPECT_EQ(json["mean_ratio"]["interval"]["source"], "variance");
    EXPECT_EQ(json["mean_ratio"]["all"]["high"], expected.ratioOfAll.high);
    EXPECT_TRUE(json["z_test"]["agree"]);
    EXPECT_EQ(readExr(d).channels["G"][77], picture.radiance[77].y - reference.radiance[77].y);
}

TEST_F(CompareCommand, PrintsATable)
{
    const std::string table = run({a, b});
    EXPECT_NE(table.find("relMSE absolute"), std::string::npos);
    EXPECT_NE(table.find("95 % intervals from the scatter of 8x8 blocks"), std::string::npos);
    EXPECT_NE(table.find("without the 4 worst pixels (.1 %)"), std::string::npos);
    EXPECT_EQ(table.find("verdict"), std::string::npos);
    EXPECT_NE(run({a, b, "--variance", v}).find("agree up to noise"), std::string::npos);
    EXPECT_NE(run({a, a, "--variance", v}).find("4096 compared"), std::string::npos);
}

TEST_F(CompareCommand, DrawsTheErrors)
{
    const std::string png = folder / "d.png";
    run({a, b, "--diff-png", png});
    const auto pixels = test::decodePng(png);
    const Picture picture = makePicture(readExr(a), a), reference = makePicture(readExr(b), b);
    const ErrorPicture expected = drawErrors(picture, reference, compareImages(picture, reference).epsilon);
    ASSERT_EQ(pixels.size(), expected.pixels.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        EXPECT_TRUE(std::equal(pixels[i].begin(), pixels[i].end(), expected.pixels[i].begin())) << "pixel " << i;
    }
}

TEST_F(CompareCommand, RefusesBadInput)
{
    const auto refused = [&](const std::vector<std::string>& arguments, MessageId id, const test::Parts& parts) {
        expectRefusal<InputError>([&] { run(arguments); }, id, parts);
    };
    refused({a, folder / "missing.exr"}, MessageId::FileMissing, {.file = "missing.exr"});
    const std::string missing = folder / "missing.exr";  // looked for after the names of what is to be written
    const auto misnamed = [&](const std::string& option, const char* name, const char* ending) {
        const test::Parts parts{.file = name, .expected = ending};
        expectRefusal<UsageError>([&] { run({missing, b, option, folder / name}); }, MessageId::UnknownFormat, parts);
    };
    misnamed("--diff", "d.png", ".exr");
    misnamed("--diff-png", "d.exr", ".png");
    Image small = readExr(b);
    small.channels.erase("B");
    writeExr(v, small);
    refused({a, v}, MessageId::Missing, {.file = "v.exr", .place = "B"});
    writeExr(v, imageOf(makeTruth(32, 64), true));
    refused({a, b, "--variance", v}, MessageId::Mismatch, {.file = "v.exr", .value = "32x64", .expected = "64x64"});
    small = readExr(b);
    small.channels["G"][65] = -1.0F;
    writeExr(v, small);
    refused({a, b, "--variance", v}, MessageId::OutOfRange, {.file = "v.exr", .place = "pixel (1, 1)"});
    EXPECT_THROW(run({a, b, "--unknown"}), UsageError);
    EXPECT_THROW(run({a}), UsageError);
}

}  // namespace
}  // namespace glim
