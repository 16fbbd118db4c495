// How many samples each pixel of a film should get next, from what the film knows of its noise.
#include "host/render/allocate_samples.hpp"
#include "host/render/block_queue.hpp"
#include "shaders/shared/limits.h"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 32;

std::size_t at(std::uint32_t x, std::uint32_t y) { return std::size_t{y} * kSide + x; }

// Every pixel has two blocks. Their means give this variance of a sample.
Film makeFilm(float mean, float variance)
{
    Film film;
    film.width = film.height = kSide;
    PixelMoments pixel{};
    pixel.count = 2 * kBlockSamples;
    pixel.blocks = 2;
    pixel.mean = glm::vec3(mean);
    pixel.squares = glm::vec3(variance);
    film.pixels.assign(std::size_t{kSide} * kSide, pixel);
    return film;
}

double meanOf(const std::vector<double>& values)
{
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(AllocateSamplesTest, EvenFilmsAreSampledEvenly)
{
    for (const float variance : {0.0F, 1.0F}) {
        for (const double share : computeShares(makeFilm(1.0F, variance), SquaredError::Relative)) {
            EXPECT_NEAR(share, 1.0, 1e-12);
        }
    }
}

// A pixel's own variance, whether zero or large, does not change its own share.
TEST(AllocateSamplesTest, APixelIsNotAskedAboutItself)
{
    Film film = makeFilm(1.0F, 1.0F);
    for (const float own : {0.0F, 1e6F}) {
        film.pixels[at(16, 16)].squares = glm::vec3(own);
        const std::vector<double> shares = computeShares(film, SquaredError::Absolute);
        EXPECT_DOUBLE_EQ(shares[at(16, 16)], shares[at(0, 0)]);
        // The 48 neighbours' root mean variance.
        const double expected = std::sqrt((47.0 + static_cast<double>(own)) / 48.0);
        for (const auto& [x, y] : {std::pair(13U, 13U), std::pair(19U, 16U), std::pair(15U, 16U)}) {
            EXPECT_NEAR(shares[at(x, y)] / shares[at(0, 0)], expected, 1e-9 * expected) << x << ", " << y;
        }
        EXPECT_DOUBLE_EQ(shares[at(12, 16)], shares[at(0, 0)]);
        EXPECT_DOUBLE_EQ(shares[at(16, 20)], shares[at(0, 0)]);
        EXPECT_NEAR(meanOf(shares), 1.0, 1e-12);
    }
}

// In bright halves four times the variance is the same relative error.
TEST(AllocateSamplesTest, RelativeErrorsCountByRadiance)
{
    Film film = makeFilm(10.0F, 1.0F);
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = kSide / 2; x < kSide; ++x) {
            film.pixels[at(x, y)].mean = glm::vec3(20.0F);
            film.pixels[at(x, y)].squares = glm::vec3(4.0F);
        }
    }
    const std::vector<double> absolute = computeShares(film, SquaredError::Absolute);
    EXPECT_NEAR(absolute[at(28, 3)] / absolute[at(3, 3)], 2.0, 1e-9);
    const std::vector<double> relative = computeShares(film, SquaredError::Relative);
    // 1 % of the mean's square is added to each square.
    const double epsilon = 0.01 * 15.0 * 15.0;
    const double expected = std::sqrt(4.0 / (400.0 + epsilon) / (1.0 / (100.0 + epsilon)));
    EXPECT_NEAR(relative[at(28, 3)] / relative[at(3, 3)], expected, 1e-6);
}

// Nothing is known of pixels with one block or none: they do not count as neighbours.
TEST(AllocateSamplesTest, PixelsOfUnknownVarianceAreLeftOut)
{
    Film film = makeFilm(1.0F, 1.0F);
    film.pixels[at(8, 8)].blocks = 1;
    film.pixels[at(9, 8)].blocks = 0;
    film.pixels[at(8, 8)].squares = glm::vec3(1e9F);
    film.pixels[at(20, 20)].squares.g = std::numeric_limits<float>::infinity();
    for (const double share : computeShares(film, SquaredError::Absolute)) {
        EXPECT_NEAR(share, 1.0, 1e-12);
    }
    Film alone = makeFilm(1.0F, 1.0F);
    alone.width = alone.height = 1;
    alone.pixels.resize(1);
    EXPECT_EQ(computeShares(alone, SquaredError::Relative), std::vector<double>{1.0});
}

TEST(AllocateSamplesTest, BlocksComeToTheWantedMeanWithinHalfOfOne)
{
    Random random(81);
    for (const double mean : {160.0, 192.0, 200.0, 1000.0}) {
        std::vector<double> shares(1000);
        std::vector<std::uint32_t> samples(shares.size());
        for (std::size_t i = 0; i < shares.size(); ++i) {
            shares[i] = 0.5 + 4.0 * random.uniform() * random.uniform() * random.uniform();
            samples[i] = kBlockSamples * (1 + random.below(3));
        }
        const std::vector<std::uint32_t> blocks = allocateBlocks(shares, samples, mean);
        double before = 0.0, after = 0.0, share = 0.0, given = 0.0;
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            before += samples[i];
            after += samples[i] + kBlockSamples * blocks[i];
            if (blocks[i] > 1) {
                share += shares[i];
                given += samples[i] + kBlockSamples * blocks[i];
            }
        }
        EXPECT_NEAR(after, std::max(before, mean * 1000.0), 0.5 * kBlockSamples) << mean;
        // A pixel that gets more than one block has the samples of its share.
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            if (blocks[i] > 1) {
                EXPECT_NEAR(samples[i] + kBlockSamples * blocks[i], given / share * shares[i], 1.6 * kBlockSamples) << i;
            }
        }
    }
}

TEST(AllocateSamplesTest, PixelsWithEnoughSamplesGetNoMore)
{
    const std::vector<double> shares{0.5, 1.0, 1.5};
    EXPECT_EQ(allocateBlocks(shares, {320, 320, 320}, 320.0), (std::vector<std::uint32_t>{0, 0, 0}));
    EXPECT_EQ(allocateBlocks(shares, {6400, 640, 640}, 2600.0), (std::vector<std::uint32_t>{0, 0, 1}));
}

// --- whether choosing pixels biases ---

// Samples are 1, and one in 10,000 is 1,001: a tenth of the light comes in spikes that most pixels never meet.
class SpikyFilm {
public:
    explicit SpikyFilm(std::uint64_t seed)
        : random_(seed)
    {
        skip();
    }

    static constexpr double kTruth = 1.1;

    void addBlocks(PixelMoments& moments, std::uint32_t blocks, std::uint32_t samples)
    {
        for (std::uint32_t i = 0; i < blocks; ++i) {
            PixelMoments block{};
            block.count = samples;
            block.blocks = 1;
            double sum = samples;
            while (left_ < samples) {
                sum += 1000.0;
                const double used = left_;
                skip();
                left_ += used;
            }
            left_ -= samples;
            block.mean = glm::vec3(static_cast<float>(sum / samples));
            moments = foldMoments(moments, block);
        }
    }

private:
    // Samples until the next spike.
    void skip() { left_ = std::floor(std::log1p(-random_.uniform()) / std::log1p(-1e-4)) + 1.0; }

    Random random_;
    double left_ = 0.0;
};

// The mean of a picture of 32x32 with 256 samples a pixel in four rounds, minus the truth. If the noise around is estimated from all
// samples, chosen ones too, the first round has no bias, and later rounds have a growing one.
double errorOfRounds(std::uint64_t seed, bool asksChosenOnes)
{
    SpikyFilm spikes(seed);
    Film common, all;
    common.width = common.height = kSide;
    common.pixels.resize(std::size_t{kSide} * kSide);
    std::vector<std::uint32_t> chosen(common.pixels.size(), 0);
    std::vector<PixelMoments> chosenMoments(common.pixels.size());
    for (PixelMoments& pixel : common.pixels) {
        spikes.addBlocks(pixel, 2, kFirstBlockSamples);
    }
    std::uint32_t commonSamples = 2 * kFirstBlockSamples;
    for (const std::uint32_t mean : {96U, 128U, 192U, 256U}) {
        const std::uint32_t wanted = std::max(64U, mean / 2 / kBlockSamples * kBlockSamples);
        for (; commonSamples < wanted; commonSamples += blockSamples(commonSamples)) {
            for (PixelMoments& pixel : common.pixels) {
                spikes.addBlocks(pixel, 1, blockSamples(commonSamples));
            }
        }
        all = common;
        for (std::size_t i = 0; i < chosen.size() && asksChosenOnes; ++i) {
            all.pixels[i] = foldMoments(common.pixels[i], chosenMoments[i]);
        }
        const auto blocks = allocateBlocks(computeShares(all, SquaredError::Relative), chosen, mean - wanted);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            spikes.addBlocks(chosenMoments[i], blocks[i], kBlockSamples);
            chosen[i] += blocks[i] * kBlockSamples;
        }
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        sum += static_cast<double>(foldMoments(common.pixels[i], chosenMoments[i]).mean.r);
    }
    return sum / static_cast<double>(chosen.size()) / SpikyFilm::kTruth - 1.0;
}

TEST(AllocateSamplesTest, H29RareSpikesAreNotDiluted)
{
    constexpr int kFilms = 1000;
    std::vector<double> errors, naive;
    for (int film = 0; film < kFilms; ++film) {
        errors.push_back(errorOfRounds(1000 + film, false));
        naive.push_back(errorOfRounds(1000 + film, true));
    }
    printHardCase("H29", "a tenth of the light in one sample of 1e4", kFilms * 256.0 * kSide * kSide,
                  "mean off by " + figure(100.0 * meanOf(errors)) + " %",
                  "asking chosen samples too: " + figure(100.0 * meanOf(naive)) + " %");
    expectSampleMean("samples by the noise of common ones", errors, 0.0, 1);
    EXPECT_LT(meanOf(naive), -0.005);
}

// Every pixel's samples, in the order of their index and each once, whatever a sweep may take.
TEST(BlockQueueTest, GivesEveryBlockOnceAndInOrder)
{
    for (const std::uint32_t most : {1U, 32U, 100U, 256U, 1U << 20}) {
        BlockQueue queue(4, 64);
        const std::vector<std::uint32_t> wanted{0, 1, 13, 64};
        queue.add({0, 1, 10, 60});
        queue.add({0, 0, 3, 4});
        std::vector<std::uint32_t> next(4, 64);
        std::size_t sweeps = 0;
        while (const auto sweep = queue.take(most)) {
            ++sweeps;
            EXPECT_TRUE(std::has_single_bit(sweep->sampleCount / kBlockSamples)) << sweep->sampleCount;
            EXPECT_LE(sweep->sampleCount, std::max(most, kBlockSamples));
            ASSERT_FALSE(sweep->pixels.empty());
            for (std::size_t i = 0; i < sweep->pixels.size(); ++i) {
                EXPECT_TRUE(i == 0 || sweep->pixels[i - 1].pixel < sweep->pixels[i].pixel);
                EXPECT_EQ(sweep->pixels[i].sample, next[sweep->pixels[i].pixel]);
                next[sweep->pixels[i].pixel] += sweep->sampleCount;
            }
        }
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            EXPECT_EQ(next[i], 64 + kBlockSamples * wanted[i]);
        }
        EXPECT_EQ(queue.samples(), (std::vector<std::uint32_t>{0, kBlockSamples, 13 * kBlockSamples, 64 * kBlockSamples}));
        EXPECT_EQ(queue.begin(), 64U);
        EXPECT_EQ(queue.end(), next[3]);
        EXPECT_TRUE(queue.isEmpty());
        if (most == 1U << 20) {
            EXPECT_EQ(sweeps, 4U);  // 64, 8, 4, 1
        }
    }
}

}  // namespace
}  // namespace glim
