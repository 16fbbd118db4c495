#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"
#include "tests/support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace glim {
namespace {

constexpr std::uint32_t kCount = 1U << 20;

std::vector<uvec4> hashes(const std::vector<uvec4>& counters)
{
    KernelTest test(test_kernels::hash_test);
    test.cases(counters).resultsOf<uvec4>(counters.size()).run();
    return test.results<uvec4>();
}

// A picture's counters: 1024 pixels, 64 samples, 16 dimensions.
std::vector<uvec4> pictureCounters(std::uint32_t seed)
{
    std::vector<uvec4> counters;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        counters.push_back({i % 1024, i / 1024 % 64, i / 65536, seed});
    }
    return counters;
}

double unit(std::uint32_t bits)
{
    return bits * 0x1p-32;
}

// Jarzynski and Olano's pcg4d, computed by hand from its definition for the zero counters: after the first step every word
// is 1013904223 = c, and so on modulo 2^32.
TEST(HashTest, IsPcg4d)
{
    const std::uint32_t c = 1013904223U;
    std::uint32_t x = c + c * c, y = c + c * x, z = c + x * y, w = c + y * z;
    x ^= x >> 16, y ^= y >> 16, z ^= z >> 16, w ^= w >> 16;
    x += y * w, y += z * x, z += x * y, w += y * z;
    EXPECT_EQ(hashes({uvec4(0)})[0], uvec4(x, y, z, w));
}

// H31, and H32 as far as it is the hash's: no duplicates, every word uniform, words and neighbouring counters uncorrelated.
TEST(HashTest, IsUniformAndIndependent)
{
    for (int round = 0; round < testRounds(); ++round) {
        const std::vector<uvec4> h = hashes(pictureCounters(static_cast<std::uint32_t>(round)));
        std::vector<std::uint64_t> pairs;
        std::vector<double> words[4];
        std::vector<double> counts[4], joint(64 * 64, 0.0);
        for (const uvec4& v : h) {
            pairs.push_back(static_cast<std::uint64_t>(v.x) << 32 | v.y);
            ++joint[(v.x >> 26) * 64 + (v.y >> 26)];
            for (int k = 0; k < 4; ++k) {
                words[k].push_back(unit(v[k]));
                counts[k].resize(4096);
                ++counts[k][v[k] >> 20];
            }
        }
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end()) << "two counters have the same pair";
        const std::size_t tests = 5 * static_cast<std::size_t>(testRounds());
        expectCounts("pairs of words", joint, std::vector<double>(joint.size(), kCount / 4096.0), tests);
        for (int k = 0; k < 4; ++k) {
            expectCounts("word " + std::to_string(k), counts[k], std::vector<double>(4096, kCount / 4096.0), tests);
        }
    }
}

// H32: between neighbouring pixels, samples, dimensions and seeds, for every pair of words.
TEST(HashTest, NeighboursAreUncorrelated)
{
    const std::vector<uvec4> counters = pictureCounters(7);
    const std::vector<uvec4> here = hashes(counters);
    double worst = 0.0;
    for (int axis = 0; axis < 4; ++axis) {
        std::vector<uvec4> moved = counters;
        std::for_each(moved.begin(), moved.end(), [axis](uvec4& v) { ++v[axis]; });
        const std::vector<uvec4> there = hashes(moved);
        for (int j = 0; j < 16; ++j) {
            std::vector<double> a(kCount), b(kCount);
            std::transform(here.begin(), here.end(), a.begin(), [j](const uvec4& v) { return unit(v[j / 4]); });
            std::transform(there.begin(), there.end(), b.begin(), [j](const uvec4& v) { return unit(v[j % 4]); });
            worst = std::max(worst, correlationScore(a, b));
        }
    }
    std::cout << "  largest |correlation| sqrt(n) of 64: " << worst << ", limit " << scoreLimit(64) << '\n';
    EXPECT_LE(worst, scoreLimit(64));
}

}  // namespace
}  // namespace glim
