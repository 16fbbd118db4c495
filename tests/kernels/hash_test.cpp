#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace glim::hash_test {

struct Case {
    uvec4 counter;
    uvec4 hash;
    uint bits;
    float unit;
    uint bin;
};

// pcg4d as Jarzynski and Olano 2020 define it, word by word modulo 2^32.
uvec4 pcg4d(const uvec4& counter)
{
    std::array<std::uint64_t, 4> v{};
    const auto cut = [](std::uint64_t x) { return x & 0xffffffffULL; };
    for (int k = 0; k < 4; ++k) {
        v[static_cast<std::size_t>(k)] = cut(counter[k] * 1664525ULL + 1013904223ULL);
    }
    for (int round = 0; round < 2; ++round) {
        v[0] = cut(v[0] + v[1] * v[3]);
        v[1] = cut(v[1] + v[2] * v[0]);
        v[2] = cut(v[2] + v[0] * v[1]);
        v[3] = cut(v[3] + v[1] * v[2]);
        if (round == 0) {
            for (std::uint64_t& word : v) {
                word ^= word >> 16;
            }
        }
    }
    return {v[0], v[1], v[2], v[3]};
}

std::vector<Case> hashCases()
{
    std::vector<Case> cases;
    for (uint i = 0; i < 65536; ++i) {
        const uvec4 counter(i % 64, i / 64, i % 7, i % 3);
        // The 256 numbers that round to 1.0 as float(u) / 2^32, the smallest ones, and some between.
        const uint bits = i < 512 ? 0xffffffffU - i : (i < 1024 ? i - 512 : i * 65537U);
        cases.push_back({counter, pcg4d(counter), bits, static_cast<float>(std::floor(bits / 256.0) / 16777216.0),
                         static_cast<uint>(std::uint64_t{bits} * 1000003 >> 32)});
    }
    return cases;
}

TEST(HashTest, H31H32IsPcg4dAndNeverReachesOne)
{
    const std::vector<Case> cases = hashCases();
    KernelTest(test_kernels::hash_test).cases(cases).run();
    const auto ones =
        std::count_if(cases.begin(), cases.end(), [](const Case& c) { return static_cast<float>(c.bits) * 0x1p-32F >= 1.0F; });
    printHardCase("H31", "the 512 largest and smallest numbers, and others", static_cast<double>(cases.size()), "all in [0, 1)",
                  "float(u) 2^-32: " + std::to_string(ones) + " are 1");
}

// A linear congruential generator seeded with the pixel's number: its first draw in neighbouring pixels.
double naiveCorrelation(uint pixels)
{
    double sum = 0.0;
    const auto unit = [](uint pixel) { return (pixel * 1664525U + 1013904223U) / 4294967296.0 - 0.5; };
    for (uint i = 0; i < pixels; ++i) {
        sum += unit(i) * unit(i + 1) * 12.0;
    }
    return sum / pixels;
}

// On the host's recurrence, which the test above has shown to be the device's: neighbouring pixels, samples and dimensions are
// uncorrelated. With n = 65,536 pairs a correlation has standard deviation n^-1/2; 6 lags, family level 1e-3: z = 3.76.
TEST(HashTest, H32NeighboursAreUncorrelated)
{
    const uint n = 65536;
    const auto unit = [](const uvec4& counter, int word) { return pcg4d(counter)[word] / 4294967296.0 - 0.5; };
    double worst = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        for (int word = 0; word < 2; ++word) {
            double sum = 0.0;
            for (uint i = 0; i < n; ++i) {
                const uvec4 here(i % 256, i / 256, i % 16, 0);
                uvec4 there = here;
                ++there[axis];
                sum += unit(here, word) * unit(there, word) * 12.0;
            }
            const double correlation = sum / n;
            worst = std::max(worst, std::abs(correlation));
            EXPECT_LE(std::abs(correlation), 3.76 / std::sqrt(static_cast<double>(n)));
        }
    }
    printHardCase("H32", "neighbouring pixels, samples, dimensions", 6.0 * n, "correlation at most " + figure(worst),
                  "seeded by the pixel's number: " + figure(naiveCorrelation(n)));
}

}  // namespace glim::hash_test
