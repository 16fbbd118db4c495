#include "host/render/film.hpp"
#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iostream>
#include <limits>

namespace glim {
namespace {

constexpr std::uint32_t kSamples = 1U << 20;

std::vector<PixelMoments> pagesOf(const std::vector<vec3>& samples)
{
    const auto pages = static_cast<std::uint32_t>(samples.size() / kPageSamples);
    KernelTest test(test_kernels::moments_test);
    test.cases(samples).threads(pages).resultsOf<PixelMoments>(pages).run();
    return test.results<PixelMoments>();
}

PixelMoments blockOnHost(const vec3* samples)
{
    PixelMoments m{};
    m.depth = std::numeric_limits<float>::infinity();
    for (std::uint32_t i = 0; i < kBlockSamples; ++i) {
        m.mean += samples[i];
        m.depth = std::min(m.depth, samples[i].y);
    }
    m.count = kBlockSamples;
    m.blocks = 1;
    m.mean /= static_cast<float>(kBlockSamples);  // a power of two: exact
    m.alpha = m.mean.x;
    m.albedo = {m.mean.y, m.mean.z, m.mean.x};
    m.normal = {m.mean.z, m.mean.x, m.mean.y};
    m.clamped = m.mean.z;
    return m;
}

struct Truth {
    glm::dvec3 mean{0.0}, squares{0.0};
};

// Mean of the samples and sum over blocks of 32 (block mean - mean)^2, in double.
Truth truthOf(const std::vector<vec3>& samples)
{
    Truth truth;
    for (const vec3& s : samples) {
        truth.mean += glm::dvec3(s) / static_cast<double>(samples.size());
    }
    for (std::size_t begin = 0; begin < samples.size(); begin += kBlockSamples) {
        glm::dvec3 block(0.0);
        for (std::size_t i = begin; i < begin + kBlockSamples; ++i) {
            block += glm::dvec3(samples[i]) / static_cast<double>(kBlockSamples);
        }
        truth.squares += static_cast<double>(kBlockSamples) * (block - truth.mean) * (block - truth.mean);
    }
    return truth;
}

PixelMoments foldAll(const std::vector<PixelMoments>& pages, std::size_t begin, std::size_t end)
{
    Film film;
    film.pixels.resize(1);
    for (std::size_t i = begin; i < end; ++i) {
        foldPage(film, 0, {pages[i]});
    }
    return film.pixels[0];
}

glm::dvec3 relativeError(const glm::dvec3& found, const glm::dvec3& truth)
{
    return glm::abs(found - truth) / glm::max(glm::abs(truth), glm::dvec3(1e-30));
}

double largest(const glm::dvec3& v)
{
    return std::max({v.x, v.y, v.z});
}

// H26 for one stream: the device's bits are the host's, and both are near double.
void expectStream(const std::string& what, const std::function<double(Random&)>& draw)
{
    Random random(60);
    std::vector<vec3> samples(kSamples);
    for (vec3& s : samples) {
        s = {draw(random), draw(random), draw(random)};
    }
    const std::vector<PixelMoments> pages = pagesOf(samples);
    for (std::size_t i = 0; i < pages.size(); ++i) {
        PixelMoments page{};
        for (std::size_t at = i * kPageSamples; at < (i + 1) * kPageSamples; at += kBlockSamples) {
            page = foldMoments(page, blockOnHost(&samples[at]));
        }
        ASSERT_EQ(std::memcmp(&page, &pages[i], sizeof(page)), 0) << what << ", page " << i;
    }
    const PixelMoments whole = foldAll(pages, 0, pages.size());
    // The mean's rounding walks with the root of the number of folds: 64 pages stay within 1e-6.
    const PixelMoments some = foldAll(pages, 0, 64), halves = foldMoments(foldAll(pages, 0, 32), foldAll(pages, 32, 64));
    const Truth truth = truthOf(samples);
    const double meanError = largest(relativeError(whole.mean, truth.mean));
    const double varianceError = largest(relativeError(whole.squares, truth.squares));
    std::cout << "  " << what << ": relative error of the mean " << meanError << ", of the variance " << varianceError << '\n';
    EXPECT_EQ(whole.count, kSamples);
    EXPECT_EQ(whole.blocks, kSamples / kBlockSamples);
    EXPECT_LE(meanError, 1e-5) << what;
    EXPECT_TRUE(glm::all(glm::greaterThanEqual(whole.squares, vec3(0.0F)))) << what;
    if (truth.squares.x > 1e-12 * truth.mean.x * truth.mean.x) {
        EXPECT_LE(varianceError, 1e-4) << what;
    }
    EXPECT_LE(largest(relativeError(halves.mean, some.mean)), 1e-6) << what;
}

TEST(MomentsTest, ConstantStream)
{
    expectStream("constant .1", [](Random&) { return 0.1; });
}

TEST(MomentsTest, NarrowStream)
{
    expectStream("1 + .001 N", [](Random& random) { return 1.0 + 1e-3 * random.normal(); });
}

TEST(MomentsTest, BrightStream)
{
    expectStream("1e4 (1 + .01 N)", [](Random& random) { return 1e4 * (1.0 + 0.01 * random.normal()); });
}

TEST(MomentsTest, SkewedStream)
{
    expectStream("lognormal", [](Random& random) { return std::exp(2.0 * random.normal()); });
}

TEST(MomentsTest, SpikyStream)
{
    expectStream(".5 + 1e4 once in 1e4", [](Random& random) { return random.below(10000) == 0 ? 1e4 : 0.5; });
}

}  // namespace
}  // namespace glim
