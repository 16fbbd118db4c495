#include "shaders/shared/limits.h"
#include "shaders/shared/path_types.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

namespace glim::sampler_test {

struct Case {
    std::uint32_t seed, pixel, index, dimension, sobol;
    std::uint32_t light = 0, k = 0, count = 0;

    bool operator==(const Case&) const = default;
};

constexpr std::uint32_t kLens = 0xffffffff;

std::vector<uvec2> pairsOf(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::sampler_test);
    test.cases(cases).resultsOf<uvec2>(cases.size()).run();
    return test.results<uvec2>();
}

// Numbers depend on the id and nothing else: the same cases in another order, on other threads, give the same bits.
TEST(SamplerTest, IsAFunctionOfTheSampleAlone)
{
    Random random(40);
    std::vector<Case> cases;
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const std::uint32_t dimension = random.below(41);
        cases.push_back({random.below(4), random.bits(), random.bits(), dimension == 40 ? kLens : dimension, random.below(2)});
    }
    std::vector<Case> reversed(cases.rbegin(), cases.rend());
    reversed.resize(77777);  // another number of workgroups, too
    const std::vector<uvec2> forth = pairsOf(cases), back = pairsOf(reversed);
    for (std::size_t i = 0; i < back.size(); ++i) {
        ASSERT_EQ(back[i], forth[forth.size() - 1 - i]) << i;
    }
}

// Each run of 2^m pairs has one in each of 2^m cells of equal size, of whatever shape.
void expectNets(const std::vector<uvec2>& pairs, std::uint32_t m)
{
    const std::size_t size = std::size_t{1} << m;
    for (std::size_t begin = 0; begin < pairs.size(); begin += size) {
        for (std::uint32_t a = 0; a <= m; ++a) {
            std::set<std::uint64_t> cells;
            for (std::size_t i = begin; i < begin + size; ++i) {
                const std::uint64_t x = static_cast<std::uint64_t>(pairs[i].x) >> (32 - a);
                cells.insert(x << m | static_cast<std::uint64_t>(pairs[i].y) >> (32 - m + a));
            }
            ASSERT_EQ(cells.size(), size) << "net " << begin / size << ", split " << a;
        }
    }
}

// H33: each aligned block of samples is a net of its own, whatever the pixel and dimension.
TEST(SamplerTest, H33BlocksAreNets)
{
    const auto casesOf = [](std::uint32_t firstSample, std::uint32_t sampleCount) {
        std::vector<Case> cases;
        for (std::uint32_t block = 0; block < 1000; ++block) {
            const std::uint32_t first = firstSample + block % 5 * sampleCount;
            for (std::uint32_t i = 0; i < sampleCount; ++i) {
                cases.push_back({9, block * 7, first + i, block % 18 == 17 ? kLens : block % 18, 1});
            }
        }
        return cases;
    };
    expectNets(pairsOf(casesOf(0, kFirstBlockSamples)), 5);
    expectNets(pairsOf(casesOf(kBlockSamples / 2, kBlockSamples / 2)), 6);
    expectNets(pairsOf(casesOf(kBlockSamples, kBlockSamples)), 7);
}

// Blocks are scrambled each by itself: no two of a pixel's have a point in common.
TEST(SamplerTest, NoTwoBlocksShareAScramble)
{
    std::vector<Case> cases;
    for (std::uint32_t i = 0; i < 1U << 14; ++i) {
        cases.push_back({9, 5, i, 3, 1});
    }
    std::set<std::uint64_t> seen;
    for (const uvec2 pair : pairsOf(cases)) {
        EXPECT_TRUE(seen.insert(static_cast<std::uint64_t>(pair.x) << 32 | pair.y).second);
    }
}

// The samples of one light, those of all camera samples one after the other: 32 of one sample, 8 of each of 4, 3 of each of 32.
TEST(SamplerTest, SamplesOfALightAreNets)
{
    for (const std::uint32_t count : {1U, 3U, 8U, 32U, 96U}) {
        std::vector<Case> cases;
        for (std::uint32_t light = 0; light < 300; ++light) {
            for (std::uint32_t i = 0; i < 96; ++i) {
                cases.push_back({9, light * 7, i / count, 1 + light % 16, 1, light % 5, i % count, count});
            }
        }
        SCOPED_TRACE(std::to_string(count) + " samples of each light");
        expectNets(pairsOf(cases), 5);
    }
}

// Number k of count of sample index is number index * count + k of the light's sequence, so that no two samples share a point.
TEST(SamplerTest, SamplesOfALightAreOneSequence)
{
    Random random(41);
    std::vector<Case> cases, plain;
    for (std::uint32_t i = 0; i < 50000; ++i) {
        const std::uint32_t count = 1 + random.below(64), k = random.below(count), index = random.below(1U << 20);
        const Case c{random.below(4), random.bits(), index, random.below(30), random.below(2), random.bits(), k, count};
        cases.push_back(c);
        plain.push_back({c.seed, c.pixel, index * count + k, c.dimension, c.sobol, c.light, 0, 1});
    }
    const std::vector<uvec2> a = pairsOf(cases), b = pairsOf(plain);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i], b[i]) << i;
    }
    for (const std::uint32_t sobol : {0U, 1U}) {
        std::vector<Case> all;
        for (std::uint32_t i = 0; i < 100000; ++i) {
            all.push_back({1, 2, i / 10, 3, sobol, 4, i % 10, 10});
        }
        std::set<std::uint64_t> points;
        for (const uvec2& pair : pairsOf(all)) {
            points.insert(static_cast<std::uint64_t>(pair.x) << 32 | pair.y);
        }
        EXPECT_EQ(points.size(), all.size()) << "sobol " << sobol;
    }
}

struct Step {
    const char* name;
    Case here, there;
    bool stratified = false;  // samples of one block share a scramble and are stratified against each other by design
};

constexpr Case kHere{3, 0, 5, 2, 0}, kLight{3, 0, 5, 3, 0, 0, 0, 4};

constexpr Step kSteps[] = {
    {"seed", kHere, {4, 0, 5, 2, 0}},
    {"pixel", kHere, {3, 1, 5, 2, 0}},
    {"row of 1024", kHere, {3, 1024, 5, 2, 0}},
    {"sample", kHere, {3, 0, 6, 2, 0}, true},
    {"block", kHere, {3, 0, 37, 2, 0}},
    {"page", kHere, {3, 0, 261, 2, 0}},
    {"dimension", kHere, {3, 0, 5, 3, 0}},
    {"bounce", kHere, {3, 0, 5, 7, 0}},
    {"pixel and block", kHere, {3, 1, 37, 2, 0}},
    {"lens and pixel", {3, 0, 5, 0, 0}, {3, 0, 5, kLens, 0}},
    {"lens and first light", {3, 0, 5, 1, 0}, {3, 0, 5, kLens, 0}},
    {"light", kLight, {3, 0, 5, 3, 0, 1, 0, 4}},
    {"light and hemisphere", kLight, {3, 0, 5, 3, 0, kNoLightIndex, 0, 4}},
    {"light and scattering", kLight, {3, 0, 20, 4, 0}},
    {"light and no split", kLight, {3, 0, 20, 3, 0}},
    {"light's other sample", kLight, {3, 0, 5, 3, 0, 0, 1, 4}, true},
    {"light and pixel", kLight, {3, 1, 5, 3, 0, 1, 0, 4}},
    {"light and seed", kLight, {4, 0, 5, 3, 0, 1, 0, 4}},
    {"its other number", kHere, kHere},
};

// H32: across pixels, the numbers of a sample and of its neighbour along each axis: neither correlated nor jointly uneven.
// One sample per pixel, since samples of a block are stratified.
void expectIndependent(const Step& step, std::uint32_t sobol, std::size_t tests, double& worst)
{
    constexpr std::uint32_t kPixels = 1U << 17;
    std::vector<Case> here, there;
    for (std::uint32_t p = 0; p < kPixels; ++p) {
        here.push_back(step.here);
        there.push_back(step.there);
        for (Case* c : {&here.back(), &there.back()}) {
            c->pixel += p;
            c->sobol = sobol;
        }
    }
    const std::vector<uvec2> a = pairsOf(here), b = pairsOf(there);
    const bool itself = step.here == step.there;
    for (int j = itself ? 1 : 0; j < (itself ? 2 : 4); ++j) {
        std::vector<double> x(kPixels), y(kPixels), counts(32 * 32, 0.0);
        for (std::uint32_t p = 0; p < kPixels; ++p) {
            x[p] = a[p][j / 2] * 0x1p-32;
            y[p] = b[p][j % 2] * 0x1p-32;
            ++counts[(a[p][j / 2] >> 27) * 32 + (b[p][j % 2] >> 27)];
        }
        const double score = correlationScore(x, y);
        worst = std::max(worst, score);
        EXPECT_LE(score, scoreLimit(tests)) << step.name << ", words " << j / 2 << " and " << j % 2 << ", sobol " << sobol;
        const std::vector<double> expected(counts.size(), kPixels / 1024.0);
        expectCounts(std::string(step.name) + (sobol != 0 ? ", Sobol'" : ", independent"), counts, expected, tests);
    }
}

TEST(SamplerTest, H32NeighboursAreIndependent)
{
    const std::size_t tests = 2 * 4 * (std::size(kSteps) * 2 - 1);
    double worst = 0.0;
    for (const Step& step : kSteps) {
        for (const std::uint32_t sobol : {0U, 1U}) {
            if (sobol == 0 || !step.stratified) {
                expectIndependent(step, sobol, tests, worst);
            }
        }
    }
    std::cout << "  largest |correlation| sqrt(n): " << worst << ", limit " << scoreLimit(tests) << '\n';
}

}  // namespace glim::sampler_test
