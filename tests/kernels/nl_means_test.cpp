// The denoiser against the same sums in double precision, and what its weights promise.
#include "host/denoise/nl_means.hpp"
#include "shaders/shared/denoise_types.h"
#include "tests/harness/arithmetic_device.hpp"
#include "tests/harness/test_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace glim::nl_means_test {

// A film of `blocks` blocks of noisy means about `truth`, each with the standard deviation `noise` of its radiance.
template <class Truth>
Film noisyFilm(std::uint32_t width, std::uint32_t height, std::uint32_t blocks, float noise, Truth truth)
{
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    Film film;
    film.width = width;
    film.height = height;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            PixelMoments sum{};
            for (std::uint32_t b = 0; b < blocks; ++b) {
                PixelMoments block{};
                block.count = 16;
                block.blocks = 1;
                const glm::vec3 mean = truth(x, y);
                block.mean = mean * (1.0F + noise * glm::vec3(normal(random), normal(random), normal(random)));
                sum = foldMoments(sum, block);
            }
            film.pixels.push_back(sum);
        }
    }
    return film;
}

std::vector<glm::vec3> denoise(const Film& film, Device& device = testDevice())
{
    return NlMeans(device).denoise(film, [] { return true; }).value();
}

// As the kernels do it, in double precision and by other loops.
std::vector<glm::dvec3> denoiseByDefinition(const Film& film)
{
    const int width = static_cast<int>(film.width), height = static_cast<int>(film.height);
    const auto isInside = [&](int x, int y) { return x >= 0 && y >= 0 && x < width && y < height; };
    const auto at = [&](int x, int y) -> const PixelMoments& { return film.pixels[static_cast<std::size_t>(y * width + x)]; };
    std::vector<glm::dvec3> pooled;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::dvec3 sum(0.0);
            int count = 0;
            for (int j = std::max(0, y - 2); j <= std::min(height - 1, y + 2); ++j) {
                for (int i = std::max(0, x - 2); i <= std::min(width - 1, x + 2); ++i, ++count) {
                    sum += glm::dvec3(computeVarianceOfMean(at(i, j)));
                }
            }
            pooled.push_back(sum / static_cast<double>(count));
        }
    }
    std::vector<glm::dvec3> result;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::dvec3 sum(0.0);
            double weights = 0.0;
            for (int dy = -5; dy <= 5; ++dy) {
                for (int dx = -5; dx <= 5; ++dx) {
                    if (!isInside(x + dx, y + dy)) {
                        continue;
                    }
                    double distance = 0.0;
                    int count = 0;
                    for (int j = -2; j <= 2; ++j) {
                        for (int i = -2; i <= 2; ++i) {
                            if (isInside(x + i, y + j) && isInside(x + dx + i, y + dy + j)) {
                                const glm::dvec3 a(at(x + i, y + j).mean), b(at(x + dx + i, y + dy + j).mean);
                                const glm::dvec3 va = pooled[static_cast<std::size_t>((y + j) * width + x + i)];
                                const glm::dvec3 vb = pooled[static_cast<std::size_t>((y + dy + j) * width + x + dx + i)];
                                for (int c = 0; c < 3; ++c) {
                                    const double difference = a[c] - b[c];
                                    distance += (difference * difference - va[c] - std::min(va[c], vb[c])) / (0.25 * (va[c] + vb[c]));
                                }
                                ++count;
                            }
                        }
                    }
                    const double weight = std::exp(-std::max(0.0, distance / (3.0 * count)));
                    sum += weight * glm::dvec3(at(x + dx, y + dy).mean);
                    weights += weight;
                }
            }
            result.push_back(sum / weights);
        }
    }
    return result;
}

glm::vec3 edge(std::uint32_t x, std::uint32_t y)
{
    return x < 17 ? glm::vec3(0.2F, 0.5F, 1.0F) : glm::vec3(0.8F + 0.01F * static_cast<float>(y));
}

TEST(NlMeans, GivesTheWeightedMeanOfItsDefinition)
{
    const Film film = noisyFilm(33, 21, 6, 0.4F, edge);
    const std::vector<glm::vec3> denoised = denoise(film);
    const std::vector<glm::dvec3> expected = denoiseByDefinition(film);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(static_cast<double>(denoised[i][c]), expected[i][c], 1e-4 * expected[i][c]) << i;
        }
    }
}

double meanSquareError(const std::vector<glm::vec3>& pixels, std::uint32_t width)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const glm::vec3 error = pixels[i] - edge(static_cast<std::uint32_t>(i) % width, static_cast<std::uint32_t>(i) / width);
        sum += static_cast<double>(glm::dot(error, error));
    }
    return sum / static_cast<double>(pixels.size());
}

TEST(NlMeans, TakesNoiseAwayAndKeepsAnEdge)
{
    const Film film = noisyFilm(64, 64, 8, 0.3F, edge);
    std::vector<glm::vec3> noisy;
    for (const PixelMoments& pixel : film.pixels) {
        noisy.push_back(pixel.mean);
    }
    const std::vector<glm::vec3> denoised = denoise(film);
    // 121 pixels would give 121 times less; patches that seem unlike by chance, the edge and the ramp take some of it.
    EXPECT_LT(meanSquareError(denoised, 64), meanSquareError(noisy, 64) / 15.0);
    for (std::size_t y = 0; y < 64; ++y) {
        EXPECT_LT(denoised[64 * y + 16].r, 0.35F);
        EXPECT_GT(denoised[64 * y + 17].r, 0.65F);
    }
}

// The unit of radiance changes no bit, and neither does the way in which the work was cut.
TEST(NlMeans, UnitOfRadianceDoesNotMatter)
{
    Film film = noisyFilm(48, 40, 4, 0.3F, edge);
    const std::vector<glm::vec3> expected = denoise(film);
    for (PixelMoments& pixel : film.pixels) {
        pixel.mean *= 0x1p-40F;
        pixel.squares *= 0x1p-80F;
    }
    const std::vector<glm::vec3> small = denoise(film);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(small[i] * 0x1p40F, expected[i]);
    }
}

TEST(NlMeans, BandsOfALargePictureJoin)
{
    constexpr std::uint32_t kWidth = 65535, kSeam = 14;  // a band's rows
    Film wide = noisyFilm(kWidth, 24, 2, 0.3F, edge), strip;
    strip.width = kWidth;
    strip.height = 24 - 4;
    strip.pixels.assign(wide.pixels.begin() + 4 * std::ptrdiff_t{kWidth}, wide.pixels.end());
    // The same scale: that of the whole.
    const std::vector<glm::vec3> whole = denoise(wide), part = denoise(strip);
    static_assert(kSeam - 1 >= 4 + kDenoiseMargin);
    for (std::uint32_t y = 4 + kDenoiseMargin; y < 24; ++y) {
        for (std::uint32_t x = 0; x < kWidth; ++x) {
            ASSERT_EQ(whole[y * kWidth + x], part[(y - 4) * kWidth + x]) << x << ' ' << y;
        }
    }
}

TEST(NlMeans, WhatHasNoNoiseStaysAsItIs)
{
    const Film film = noisyFilm(40, 40, 3, 0.0F, edge);
    const std::vector<glm::vec3> denoised = denoise(film);
    for (std::size_t i = 0; i < denoised.size(); ++i) {
        EXPECT_NEAR(denoised[i].r, film.pixels[i].mean.r, 2e-5F) << i;
    }
}

// Nor does their noise, beyond the pixels that look at them.
TEST(NlMeans, BrokenPixelsSpoilNoPixelFarAway)
{
    Film film = noisyFilm(40, 40, 4, 0.3F, edge);
    film.pixels[20 * 40 + 20].mean = glm::vec3(1e30F);
    film.pixels[20 * 40 + 20].squares = glm::vec3(std::numeric_limits<float>::infinity());
    film.pixels[30 * 40 + 5] = PixelMoments{};
    film.pixels[10 * 40 + 10].blocks = 1;
    const std::vector<glm::vec3> denoised = denoise(film);
    for (std::size_t i = 0; i < denoised.size(); ++i) {
        ASSERT_TRUE(std::isfinite(denoised[i].r)) << i;
        const int away = std::max(std::abs(static_cast<int>(i % 40) - 20), std::abs(static_cast<int>(i / 40) - 20));
        if (away > kDenoiseMargin) {
            EXPECT_LT(denoised[i].r, 2.0F) << i;
        }
    }
}

// With weights about 2^-126: devices may flush what is smaller.
TEST(NlMeans, BlackPixelsBesideBrightOnesHaveTheSameBitsOnAllDevices)
{
    const Film film = noisyFilm(40, 40, 6, 0.46F, [](std::uint32_t x, std::uint32_t) { return glm::vec3(x < 20 ? 0.0F : 1.0F); });
    const std::vector<glm::vec3> denoised = denoise(film);
    EXPECT_TRUE(denoise(film, *deviceWith("adverse:1")) == denoised);
    EXPECT_TRUE(std::ranges::any_of(denoised, [](const glm::vec3& pixel) { return pixel.r > 0.0F && pixel.r < 1e-30F; }));
}

TEST(NlMeans, EndsWhenItIsTold)
{
    EXPECT_FALSE(NlMeans(testDevice()).denoise(noisyFilm(64, 64, 2, 0.3F, edge), [] { return false; }));
}

}  // namespace glim::nl_means_test
