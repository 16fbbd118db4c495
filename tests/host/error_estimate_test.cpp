// The interval of a picture's error holds the truth as often as it says.
#include "host/measure/error_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <random>

namespace glim {
namespace {

constexpr std::uint32_t kBlock = 32;

using Random = std::mt19937_64;

// A pixel's true radiance and the sum of `kBlock` of its samples.
struct Population {
    const char* name;
    std::function<double(std::uint32_t pixel)> truth;
    std::function<double(std::uint32_t pixel, Random&)> block;
};

double shade(std::uint32_t pixel) { return 0.2 + pixel % 97 / 97.0; }

double sumOf(Random& random, const std::function<double(Random&)>& sample)
{
    double sum = 0.0;
    for (std::uint32_t i = 0; i < kBlock; ++i) {
        sum += sample(random);
    }
    return sum;
}

// Samples that differ by a tenth of their size.
Population smooth()
{
    return {"smooth", shade, [](std::uint32_t pixel, Random& random) {
                std::normal_distribution<double> normal(kBlock * shade(pixel), 0.1 * std::sqrt(kBlock) * shade(pixel));
                return normal(random);
            }};
}

// One pixel of ten has an edge between black and white; the others have no variance.
Population edges()
{
    const auto covered = [](std::uint32_t pixel) { return pixel % 10 == 0 ? (pixel / 10 % 63 + 0.5) / 63.0 : 1.0; };
    return {"edges", covered, [covered](std::uint32_t pixel, Random& random) {
                return std::binomial_distribution<int>(kBlock, covered(pixel))(random) * 1.0;
            }};
}

// Lognormal with a sigma of 2: the skewness is 414.
Population heavy()
{
    return {"heavy tails", [](std::uint32_t) { return std::exp(2.0); },
            [](std::uint32_t, Random& random) {
                return sumOf(random, [](Random& r) { return std::lognormal_distribution<double>(0.0, 2.0)(r); });
            }};
}

// One sample in a hundred thousand is ten thousand times as bright.
Population rare()
{
    return {"rare", [](std::uint32_t) { return 1.1; },
            [](std::uint32_t, Random& random) {
                const double ordinary = std::normal_distribution<double>(kBlock * 1.0, 0.1 * std::sqrt(kBlock))(random);
                return ordinary + 1e4 * std::binomial_distribution<int>(kBlock, 1e-5)(random);
            }};
}

Film draw(const Population& population, std::uint32_t pixels, std::uint32_t blocks, Random& random)
{
    Film film;
    film.width = pixels;
    film.height = 1;
    film.pixels.resize(pixels);
    for (std::uint32_t i = 0; i < pixels; ++i) {
        for (std::uint32_t b = 0; b < blocks; ++b) {
            PixelMoments block{};
            block.count = kBlock;
            block.blocks = 1;
            block.mean = glm::vec3(static_cast<float>(population.block(i, random) / kBlock));
            film.pixels[i] = foldMoments(film.pixels[i], block);
        }
    }
    return film;
}

SquaredErrors meanErrors(const Film& film, const Population& population)
{
    double mean = 0.0;
    for (std::uint32_t i = 0; i < film.width; ++i) {
        mean += population.truth(i) / film.width;
    }
    SquaredErrors errors;
    for (std::uint32_t i = 0; i < film.width; ++i) {
        const double truth = population.truth(i), error = static_cast<double>(film.pixels[i].mean.r) - truth;
        errors.mse += error * error / film.width;
        errors.relMse += error * error / (truth * truth + 0.01 * mean * mean) / film.width;
    }
    return errors;
}

struct Coverages {
    double mse = 0.0, relMse = 0.0;
};

// The share of films whose intervals hold their errors.
Coverages measureCoverage(const Population& population, std::uint32_t pixels, std::uint32_t blocks, int films)
{
    Random random(20261122);
    const auto holds = [](const Interval& interval, double error) { return error >= interval.low && error <= interval.high; };
    Coverages share;
    for (int i = 0; i < films; ++i) {
        const Film film = draw(population, pixels, blocks, random);
        const ErrorEstimate estimate = *estimateError(film);
        const SquaredErrors errors = meanErrors(film, population);
        share.mse += holds(estimate.mse, errors.mse) ? 1.0 / films : 0.0;
        share.relMse += holds(estimate.relMse, errors.relMse) ? 1.0 / films : 0.0;
    }
    std::printf("%s, %u pixels of %u blocks: the intervals hold MSE and relMSE of %.1f and %.1f %% of %d films\n", population.name, pixels,
                blocks, 100.0 * share.mse, 100.0 * share.relMse, films);
    return share;
}

// Five standard deviations below .95, for the share of so many films.
double minCoverage(int films) { return 0.95 - 5.0 * std::sqrt(0.95 * 0.05 / films); }

TEST(ErrorEstimate, H30IntervalCoversSmoothPictures)
{
    for (const std::uint32_t blocks : {2U, 4U, 16U}) {
        const Coverages share = measureCoverage(smooth(), 256, blocks, 1000);
        for (const double each : {share.mse, share.relMse}) {
            EXPECT_GE(each, minCoverage(1000));
            EXPECT_LE(each, 1.9 - minCoverage(1000)) << "nor is the interval too wide";
        }
    }
}

TEST(ErrorEstimate, H30IntervalCoversEdges)
{
    const Coverages share = measureCoverage(edges(), 640, 4, 1000);
    EXPECT_GE(share.mse, minCoverage(1000));
    EXPECT_GE(share.relMse, minCoverage(1000));
}

TEST(ErrorEstimate, H30IntervalCoversHeavyTails)
{
    const Coverages share = measureCoverage(heavy(), 256, 4, 200);
    EXPECT_GE(share.mse, minCoverage(200));
    EXPECT_GE(share.relMse, minCoverage(200));
}

// While the rare samples that make up the error are missing, no interval can hold it. Once one is there, the report says so.
TEST(ErrorEstimate, H30WarnsWhereRareSamplesAreAllOfTheError)
{
    EXPECT_LT(measureCoverage(rare(), 256, 4, 500).mse, 0.9) << "one film in three has met one";
    Random random(7);
    int few = 0, met = 0;
    for (int i = 0; i < 200; ++i) {
        const ErrorEstimate estimate = *estimateError(draw(rare(), 256, 4, random));
        const bool has = estimate.errors.mse > 1.0;
        met += has ? 1 : 0;
        few += has && estimate.isOfFew() ? 1 : 0;
    }
    EXPECT_GT(met, 0);
    EXPECT_EQ(few, met);
    EXPECT_FALSE(estimateError(draw(smooth(), 256, 4, random))->isOfFew());
}

TEST(ErrorEstimate, AgreesWithTheErrorsOfThePicture)
{
    Random random(1);
    Film film = draw(edges(), 640, 4, random);
    const ErrorEstimate estimate = *estimateError(film);
    EXPECT_DOUBLE_EQ(estimate.errors.mse, estimateErrors(makePicture(film))->mse);
    EXPECT_LT(estimate.mse.low, estimate.errors.mse);
    EXPECT_GT(estimate.mse.high, estimate.errors.mse);
    EXPECT_NEAR(std::sqrt(estimate.mse.low * estimate.mse.high), estimate.errors.mse, 1e-9 * estimate.errors.mse);
    EXPECT_NEAR(std::sqrt(estimate.relMse.low * estimate.relMse.high), estimate.errors.relMse, 1e-9 * estimate.errors.relMse);
    EXPECT_LE(estimate.pixelsOfHalf, 32U) << "of 64 edges, half";
    EXPECT_NEAR(estimate.mean, 0.95, 0.01);
    film.pixels.assign(film.pixels.size(), film.pixels[1]);
    const ErrorEstimate still = *estimateError(film);
    EXPECT_EQ(still.mse.high, 0.0) << "no variance, no error";
    EXPECT_FALSE(still.isOfFew());
    EXPECT_FALSE(estimateError(draw(smooth(), 16, 1, random))) << "one block says nothing of its error";
}

// The same numbers, times powers of two: where float32 holds the squares, the relative figures are the same; elsewhere there are none.
TEST(ErrorEstimate, IsTheSameAtEveryRadianceOrUnknown)
{
    const auto drawScaled = [](int exponent) {
        Random random(5);
        Population population = smooth();
        population.block = [&, block = population.block](std::uint32_t pixel, Random& r) { return std::ldexp(block(pixel, r), exponent); };
        return estimateError(draw(population, 256, 4, random));
    };
    const ErrorEstimate once = *drawScaled(0);
    const double root = relativeRoot(once.mse.value, once.mean);
    int known = 0;
    for (int exponent = -140; exponent <= 126; ++exponent) {
        const auto scaled = drawScaled(exponent);
        if (!scaled) {
            EXPECT_TRUE(exponent < -40 || exponent > 60) << exponent;
            continue;
        }
        ++known;
        for (const auto& [figure, expected] : {std::pair(scaled->mse, once.mse), std::pair(scaled->relMse, once.relMse)}) {
            EXPECT_NEAR(figure.low / figure.value, expected.low / expected.value, 1e-3) << exponent;
            EXPECT_NEAR(figure.high / figure.value, expected.high / expected.value, 1e-3) << exponent;
        }
        EXPECT_NEAR(scaled->relMse.value, once.relMse.value, 2e-3 * once.relMse.value) << exponent;
        EXPECT_NEAR(relativeRoot(scaled->mse.value, scaled->mean), root, 1e-3 * root) << exponent;
    }
    EXPECT_GT(known, 100);
}

TEST(ErrorEstimate, OfABlackPictureIsUnknown)
{
    Random random(1);
    Film film = draw(smooth(), 64, 4, random);
    for (PixelMoments& pixel : film.pixels) {
        pixel.mean = pixel.squares = glm::vec3(0.0F);
    }
    EXPECT_FALSE(estimateError(film));
    film.pixels[0].mean = glm::vec3(1.0F);
    EXPECT_EQ(estimateError(film)->mse.high, 0.0);
    for (const float broken : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
        film.pixels[1].squares.g = broken;
        EXPECT_FALSE(estimateError(film));
        film.pixels[1].squares.g = 0.0F;
        film.pixels[1].mean.b = broken;
        EXPECT_FALSE(estimateError(film));
        film.pixels[1].mean.b = 0.0F;
    }
    EXPECT_TRUE(estimateError(film));
}

}  // namespace
}  // namespace glim
