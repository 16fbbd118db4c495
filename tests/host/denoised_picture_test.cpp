// The measured error of a denoised picture: unbiased for any denoiser and any noise, and as far off as it says.
#include "host/denoise/denoised_picture.hpp"
#include "host/measure/confidence.hpp"
#include "shaders/shared/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 64;

glm::vec3 truthAt(std::size_t i)
{
    const auto x = static_cast<float>(i % kSide), y = static_cast<float>(i / kSide);
    return glm::vec3(1.0F + std::sin(0.3F * x), x < 30.0F ? 0.3F : 2.0F, 0.5F + 0.01F * y);
}

using Noise = std::function<double(std::mt19937&)>;  // of mean 0 and variance 1

// Of pixels whose next samples are of such means: takes the pixel and how many these are.
FilmHalves simulateHalves(std::uint32_t samples, const std::function<glm::vec3(std::size_t, std::uint32_t)>& meanOf,
                          const std::function<bool(std::size_t)>& isSky)
{
    RenderSettings settings;
    settings.width = settings.height = kSide;
    FilmHalves halves(settings);
    FilmMoments page;
    page.pixels.resize(kSide * kSide);
    for (std::uint32_t sample = 0; sample < samples;) {
        const std::uint32_t end = FilmHalves::nextEnd(sample);
        for (std::size_t i = 0; i < page.pixels.size(); ++i) {
            PixelMoments block{};
            block.count = end - sample;
            block.blocks = 1;
            block.alpha = isSky(i) ? 0.0F : 1.0F;
            block.mean = meanOf(i, block.count);
            page.pixels[i] = foldMoments(page.pixels[i], block);
        }
        halves.take(page, end, false);
        sample = end;
    }
    halves.take(page, samples, true);
    return halves;
}

// 96 samples, 64 and 32 in a half, by noise that has the deviation after 16 samples.
FilmHalves halvesOf(std::uint32_t seed, double deviation, const Noise& noise)
{
    std::mt19937 random(seed);
    const auto meanOf = [&](std::size_t i, std::uint32_t count) {
        return truthAt(i) + static_cast<float>(deviation * std::sqrt(16.0 / count) * noise(random));  // of light: all channels alike
    };
    return simulateHalves(96, meanOf, [](std::size_t) { return false; });
}

std::vector<glm::vec3> blur(const Film& film, int radius)
{
    std::vector<glm::vec3> result;
    for (int i = 0; i < static_cast<int>(kSide * kSide); ++i) {
        const int x = i % static_cast<int>(kSide), y = i / static_cast<int>(kSide), last = static_cast<int>(kSide) - 1;
        glm::vec3 sum(0.0F);
        float count = 0.0F;
        for (int v = std::max(0, y - radius); v <= std::min(last, y + radius); ++v) {
            for (int u = std::max(0, x - radius); u <= std::min(last, x + radius); ++u) {
                sum += film.pixels[static_cast<std::size_t>(v) * kSide + static_cast<std::size_t>(u)].mean;
                count += 1.0F;
            }
        }
        result.push_back(sum / count);
    }
    return result;
}

double trueMse(const std::vector<glm::vec3>& radiance)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const glm::dvec3 error = glm::dvec3(radiance[i]) - glm::dvec3(truthAt(i));
        sum += glm::dot(error, error) / 3.0;
    }
    return sum / static_cast<double>(radiance.size());
}

double trueRelMse(const std::vector<glm::vec3>& radiance)
{
    const auto count = static_cast<double>(radiance.size());
    double mean = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        mean += glm::dot(glm::dvec3(truthAt(i)), glm::dvec3(1.0 / 3.0)) / count;
    }
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const glm::dvec3 truth(truthAt(i)), error = glm::dvec3(radiance[i]) - truth;
        sum += glm::dot(error * error / (truth * truth + 0.01 * mean * mean), glm::dvec3(1.0 / 3.0));
    }
    return sum / count;
}

const Noise kNormal = [](std::mt19937& random) { return std::normal_distribution<>()(random); };
const Noise kExponential = [](std::mt19937& random) { return std::exponential_distribution<>()(random) - 1.0; };

struct Coverage {
    int inside = 0;
    double ratio = 0.0, ratioSquares = 0.0;  // of the measured to the true error
    double zSquares = 0.0;                   // mean square of the differences of logarithms, in the standard errors that the interval has
};

Coverage coverageOf(int films, double deviation, const Noise& noise, const Denoiser& denoiser)
{
    Coverage coverage;
    for (int n = 0; n < films; ++n) {
        const auto picture = denoiseHalves(halvesOf(static_cast<std::uint32_t>(n) + 1, deviation, noise), denoiser);
        const Interval& mse = picture->measured.mse;
        const double truth = trueMse(picture->radiance), ratio = mse.value / truth;
        const double z = std::log(ratio) * 2.0 * twoSidedLimit(0.05) / std::log(mse.high / mse.low);
        coverage.inside += mse.low <= truth && truth <= mse.high ? 1 : 0;
        coverage.zSquares += z * z / films;
        coverage.ratio += ratio / films;
        coverage.ratioSquares += ratio * ratio / films;
    }
    return coverage;
}

class DenoisedErrorTest : public testing::TestWithParam<std::tuple<int, bool, double>> {};

// Blurs of several widths under little and much noise: from pictures whose error is all noise to such whose error is all bias.
TEST_P(DenoisedErrorTest, IsUnbiasedAndItsIntervalHolds)
{
    const auto [radius, skewed, deviation] = GetParam();
    constexpr int kFilms = 400;
    const Coverage found = coverageOf(kFilms, deviation, skewed ? kExponential : kNormal,
                                      [radius = radius](const Film& film) { return std::optional(blur(film, radius)); });
    const double error = std::sqrt((found.ratioSquares - found.ratio * found.ratio) / (kFilms - 1));
    EXPECT_NEAR(found.ratio, 1.0, twoSidedLimit(1e-4) * error + 0.01) << error;
    // 380 on average; 357 or fewer have the probability 2e-6. The standard error ignores that neighbours share noise, and is too large for
    // noise with long tails. That of z is .035.
    EXPECT_GE(found.inside, 358);
    const bool exact = radius == 0 && !skewed;  // what the interval assumes
    EXPECT_GT(std::sqrt(found.zSquares), exact ? 0.9 : skewed ? 0.6 : 0.85);
    EXPECT_LT(std::sqrt(found.zSquares), exact ? 1.1 : 1.2);
    RecordProperty("inside", found.inside);
    std::printf("radius %d, %s noise of %.2f: %d of %d intervals hold, z %.2f, measured / true %.3f +- %.3f\n", radius,
                skewed ? "exponential" : "normal", deviation, found.inside, kFilms, std::sqrt(found.zSquares), found.ratio, error);
}

INSTANTIATE_TEST_SUITE_P(Blurs, DenoisedErrorTest, testing::Combine(testing::Values(0, 1, 3), testing::Bool(), testing::Values(0.05, 0.5)));

// One denoiser that ruins a corner: there the noisy pixels stay.
TEST(DenoisedPicture, KeepsNoisyPixelsWhereDenoisingHurts)
{
    const FilmHalves halves = halvesOf(3, 0.1, kNormal);
    const auto ruin = [](const Film& film) {
        std::vector<glm::vec3> result = blur(film, 1);
        for (std::size_t i = 0; i < result.size(); ++i) {
            if (i % kSide < 16 && i / kSide < 16) {
                result[i] *= 1.5F;
            }
        }
        return std::optional(result);
    };
    const auto picture = denoiseHalves(halves, ruin);
    for (std::size_t y = 0; y < 16; ++y) {
        for (std::size_t x = 0; x < 16; ++x) {
            const std::size_t i = y * kSide + x;
            const glm::vec3 noisy = 0.5F * (halves.films()[0].pixels[i].mean + halves.films()[1].pixels[i].mean);
            EXPECT_EQ(picture->radiance[i], noisy);
        }
    }
    EXPECT_GE(picture->noisyShare, 256.0 / (kSide * kSide));
    EXPECT_LT(picture->noisyShare, 0.5);
    EXPECT_NEAR(picture->measured.mse.value, trueMse(picture->radiance), 0.3 * trueMse(picture->radiance));
    EXPECT_NEAR(picture->measured.relMse, trueRelMse(picture->radiance), 0.3 * trueRelMse(picture->radiance));
    EXPECT_EQ(picture->error.size(), picture->radiance.size());
}

// Every second pixel shows a black sky, the others a noisy surface. Nothing is put on the sky, of which each sample is known.
TEST(DenoisedPicture, LeavesTheSkyAsItIs)
{
    const auto isSky = [](std::size_t i) { return (i + i / kSide) % 2 == 0; };
    std::mt19937 random(1);
    const auto meanOf = [&](std::size_t i, std::uint32_t) {
        return glm::vec3(isSky(i) ? 0.0F : 5.0F + static_cast<float>(kNormal(random)));
    };
    const auto picture = denoiseHalves(simulateHalves(64, meanOf, isSky), [&](const Film& film) {
        std::vector<glm::vec3> result(film.pixels.size(), glm::vec3(5.0F));
        for (std::size_t i = 0; i < result.size(); ++i) {
            result[i] = isSky(i) ? glm::vec3(0.01F) : result[i];
        }
        return std::optional(result);
    });
    EXPECT_EQ(picture->noisyShare, 0.0);
    for (std::size_t i = 0; i < picture->radiance.size(); ++i) {
        EXPECT_EQ(picture->radiance[i], glm::vec3(isSky(i) ? 0.0F : 5.0F)) << i;
    }
}

TEST(DenoisedPicture, IsNoneIfTheDenoiserWasEnded)
{
    EXPECT_FALSE(denoiseHalves(halvesOf(3, 0.1, kNormal), [](const Film&) { return std::nullopt; }));
}

// One pixel whose samples are as bright as the ends of the halves of blocks that they lie in.
FilmHalves halvesOfOnePixel(std::uint32_t begin, std::uint32_t end)
{
    RenderSettings settings{.width = 1, .height = 1};
    settings.sampleBegin = begin;
    FilmHalves halves(settings);
    Film page;
    for (std::uint32_t sample = begin; sample < end;) {
        const std::uint32_t next = std::min(end, FilmHalves::nextEnd(sample));
        if (sample == begin || sample % kPageSamples == 0) {
            halves.beginPage();
            page.pixels.assign(1, {});
            page.splats.assign(1, {});
        }
        PixelMoments part{};
        part.count = next - sample;
        part.blocks = 1;
        part.mean = glm::vec3(static_cast<float>(next));
        page.pixels[0] = foldMoments(page.pixels[0], part);
        page.splats[0] = foldMoments(page.splats[0], {part.count, 1, 10.0F * part.mean, glm::vec3(0.0F), 0.0F});
        if (next == FilmHalves::nextEnd(sample)) {
            halves.take(page, next, false);
            halves.takeSplats(page, next, false);
        }
        sample = next;
    }
    halves.take(page, end, true);
    halves.takeSplats(page, end, true);
    return halves;
}

TEST(FilmHalves, AreAsEqualAsBlocksAllow)
{
    EXPECT_EQ(FilmHalves::nextEnd(0), 16U);
    EXPECT_EQ(FilmHalves::nextEnd(16), 32U);
    EXPECT_EQ(FilmHalves::nextEnd(64), 96U);
    EXPECT_EQ(FilmHalves::nextEnd(128), 192U);
    EXPECT_EQ(FilmHalves::nextEnd(300), 320U);
    struct Sizes {
        std::uint32_t begin, end, first, second;
    };
    for (const Sizes& known : {Sizes{0, 64, 32, 32},
                               {0, 65, 33, 32},
                               {0, 100, 64, 36},
                               {0, 128, 64, 64},
                               {0, 129, 65, 64},
                               {0, 192, 128, 64},
                               {0, 256, 128, 128},
                               {0, 384, 256, 128},
                               {0, 512, 256, 256},
                               {0, 1024, 512, 512},
                               {100, 256, 28, 128},
                               {256, 512, 128, 128},
                               {300, 1000, 340, 360}}) {
        const FilmHalves halves = halvesOfOnePixel(known.begin, known.end);
        EXPECT_EQ(halves.films()[0].pixels[0].count, known.first) << known.begin << ':' << known.end;
        EXPECT_EQ(halves.films()[1].pixels[0].count, known.second) << known.begin << ':' << known.end;
    }
    EXPECT_FALSE(hasBothHalves(FilmHalves(RenderSettings{})));
    EXPECT_FALSE(hasBothHalves(halvesOfOnePixel(0, 32)));
    EXPECT_TRUE(hasBothHalves(halvesOfOnePixel(0, 40)));
}

// Halves of a block stay together, and the variance is that between them.
TEST(FilmHalves, HaveTheirBlocks)
{
    const FilmHalves halves = halvesOfOnePixel(0, 128);
    const auto& [first, second] = halves.films();
    EXPECT_EQ(first.pixels[0].blocks, 4U);
    EXPECT_EQ(second.pixels[0].blocks, 2U);
    EXPECT_NEAR(first.pixels[0].mean.r, (16.0F + 32.0F + 48.0F + 64.0F) / 4.0F, 1e-3F);
    EXPECT_NEAR(second.pixels[0].mean.r, (96.0F + 128.0F) / 2.0F, 1e-3F);
    EXPECT_NEAR(second.splats[0].mean.r, 1120.0F, 1e-2F);
    EXPECT_NEAR(computeVarianceOfMean(second.pixels[0]).r, 256.0F, 1e-2F);  // of 96 and 128
    EXPECT_EQ(first.splats[0].count, 64U);
    EXPECT_NEAR(halvesOfOnePixel(0, 512).films()[0].pixels[0].mean.r, 0.25F * (40.0F + 112.0F + 320.0F + 384.0F), 1e-2F);
}

}  // namespace
}  // namespace glim
