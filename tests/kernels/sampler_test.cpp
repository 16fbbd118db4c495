#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

namespace glim {
namespace {

struct Case {
    std::uint32_t seed, pixel, index, dimension, sobol;
};

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
        cases.push_back({random.below(4), random.bits(), random.bits(), random.below(40), random.below(2)});
    }
    std::vector<Case> reversed(cases.rbegin(), cases.rend());
    reversed.resize(77777);  // another number of workgroups, too
    const std::vector<uvec2> forth = pairsOf(cases), back = pairsOf(reversed);
    for (std::size_t i = 0; i < back.size(); ++i) {
        ASSERT_EQ(back[i], forth[forth.size() - 1 - i]) << i;
    }
}

// H33: each aligned block of samples is a net of its own, whatever the pixel and dimension.
TEST(SamplerTest, BlocksAreNets)
{
    std::vector<Case> cases;
    for (std::uint32_t block = 0; block < 2000; ++block) {
        for (std::uint32_t i = 0; i < kBlockSamples; ++i) {
            cases.push_back({9, block * 7, block % 5 * kBlockSamples + i, block % 21, 1});
        }
    }
    const std::vector<uvec2> pairs = pairsOf(cases);
    for (std::size_t begin = 0; begin < pairs.size(); begin += kBlockSamples) {
        for (std::uint32_t a = 0; a <= 5; ++a) {
            std::set<std::uint64_t> cells;
            for (std::size_t i = begin; i < begin + kBlockSamples; ++i) {
                const std::uint64_t x = static_cast<std::uint64_t>(pairs[i].x) >> (32 - a);
                cells.insert(x << 5 | static_cast<std::uint64_t>(pairs[i].y) >> (27 + a));
            }
            ASSERT_EQ(cells.size(), kBlockSamples) << "block " << begin / kBlockSamples << ", split " << a;
        }
    }
}

struct Step {
    const char* name;
    std::uint32_t seed, pixel, index, dimension;
};

constexpr Step kSteps[] = {
    {"seed", 1, 0, 0, 0},        {"pixel", 0, 1, 0, 0},     {"row of 1024", 0, 1024, 0, 0}, {"sample", 0, 0, 1, 0},
    {"block", 0, 0, 32, 0},      {"page", 0, 0, 256, 0},    {"dimension", 0, 0, 0, 1},      {"bounce", 0, 0, 0, 5},
    {"pixel and block", 0, 1, 32, 0},
};

// H32: across pixels, the numbers of a sample and of its neighbour along each axis: neither correlated nor jointly uneven.
// One sample per pixel, since samples of a block are stratified.
void expectIndependent(const Step& step, std::uint32_t sobol, std::size_t tests, double& worst)
{
    constexpr std::uint32_t kPixels = 1U << 17;
    std::vector<Case> here, there;
    for (std::uint32_t p = 0; p < kPixels; ++p) {
        here.push_back({3, p, 5, 2, sobol});
        there.push_back({3 + step.seed, p + step.pixel, 5 + step.index, 2 + step.dimension, sobol});
    }
    const std::vector<uvec2> a = pairsOf(here), b = pairsOf(there);
    for (int j = 0; j < 4; ++j) {
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

TEST(SamplerTest, NeighboursAreIndependent)
{
    // Samples of one block share a scramble and are stratified against each other by design.
    const std::size_t tests = 2 * 4 * (std::size(kSteps) * 2 - 1);
    double worst = 0.0;
    for (const Step& step : kSteps) {
        for (const std::uint32_t sobol : {0U, 1U}) {
            if (sobol == 0 || step.index != 1) {
                expectIndependent(step, sobol, tests, worst);
            }
        }
    }
    std::cout << "  largest |correlation| sqrt(n): " << worst << ", limit " << scoreLimit(tests) << '\n';
}

}  // namespace
}  // namespace glim
