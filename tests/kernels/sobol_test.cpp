#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace glim::sobol_test {

struct Case {
    std::uint32_t index;
    uvec3 seeds;
    uvec2 point;
    std::uint32_t keep, other;
};

// Sobol' 1967: the first two dimensions by their direction numbers, v_j = 2^(31 - j) and v_j = v_(j-1) xor v_(j-1) / 2.
uvec2 sobolPoint(std::uint32_t index)
{
    uvec2 point(0), direction(0x80000000U);
    for (; index != 0; index >>= 1) {
        point ^= (index & 1) != 0 ? direction : uvec2(0);
        direction = {direction.x >> 1, direction.y ^ direction.y >> 1};
    }
    return point;
}

Case makeCase(std::uint32_t index, const uvec3& seeds, Random& random)
{
    const std::uint32_t keep = random.below(32), flipped = 0x80000000U >> keep;
    return {index, seeds, sobolPoint(index), keep, (index ^ flipped) ^ (random.bits() & (flipped - 1))};
}

std::vector<uvec2> scrambled(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::sobol_test);
    test.cases(cases).resultsOf<uvec2>(cases.size()).run();
    return test.results<uvec2>();
}

// H33: elementary intervals without exactly one point, over every split of m bits among the two coordinates. A net has none.
int countUnevenIntervals(const uvec2* points, std::uint32_t m)
{
    std::ptrdiff_t uneven = 0;
    for (std::uint32_t a = 0; a <= m; ++a) {
        std::vector<int> counts(1U << m, 0);
        for (std::uint32_t i = 0; i < 1U << m; ++i) {
            const std::uint64_t x = static_cast<std::uint64_t>(points[i].x) >> (32 - a);
            const std::uint64_t y = static_cast<std::uint64_t>(points[i].y) >> (32 - (m - a));
            ++counts[x << (m - a) | y];
        }
        uneven += std::count_if(counts.begin(), counts.end(), [](int count) { return count != 1; });
    }
    return static_cast<int>(uneven);
}

std::vector<uvec2> independentPoints(std::size_t count, std::uint64_t seed)
{
    Random random(seed);
    std::vector<uvec2> points(count);
    std::generate(points.begin(), points.end(), [&random] {
        const std::uint32_t x = random.bits();
        return uvec2(x, random.bits());
    });
    return points;
}

TEST(SobolTest, H33FirstPointsAreANet)
{
    Random random(30);
    std::vector<Case> cases;
    std::vector<uvec2> points;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        cases.push_back(makeCase(i, uvec3(0), random));
        points.push_back(cases.back().point);
    }
    for (int i = 0; i < 100000; ++i) {
        cases.push_back(makeCase(random.bits(), {random.bits(), random.bits(), random.bits()}, random));
    }
    scrambled(cases);  // the kernel compares its points with these
    EXPECT_EQ(countUnevenIntervals(points.data(), 12), 0);
}

// The first `length` points of each of `count` scrambled sequences, one after the other.
std::vector<uvec2> sequences(std::uint32_t count, std::uint32_t length, std::uint64_t seed)
{
    Random random(seed);
    std::vector<Case> cases;
    for (std::uint32_t s = 0; s < count; ++s) {
        const uvec3 seeds(random.bits(), random.bits(), random.bits());
        for (std::uint32_t i = 0; i < length; ++i) {
            cases.push_back(makeCase(i, seeds, random));
        }
    }
    return scrambled(cases);
}

// Every aligned run of 2^m, here all of 32 and the first 4096 of a sequence, for many seeds.
TEST(SobolTest, H33ScrambledRunsAreNets)
{
    constexpr std::uint32_t kSequences = 64, kLength = 4096;
    const std::vector<uvec2> points = sequences(kSequences, kLength, 31);
    int uneven = 0;
    for (std::uint32_t s = 0; s < kSequences; ++s) {
        uneven += countUnevenIntervals(&points[s * kLength], 12);
    }
    for (std::size_t block = 0; block < points.size(); block += 32) {
        uneven += countUnevenIntervals(&points[block], 5);
    }
    const int naive = countUnevenIntervals(independentPoints(kLength, 34).data(), 12);
    printHardCase("H33", "elementary intervals without exactly one point", kSequences * kLength, std::to_string(uneven),
                  "independent points: " + std::to_string(naive) + " of " + std::to_string(13 * kLength));
    EXPECT_EQ(uneven, 0);
    EXPECT_GT(naive, 0);
}

// Scrambling makes each point uniform: the same index under many seeds.
TEST(SobolTest, ScrambledPointsAreUniform)
{
    constexpr std::uint32_t kSeeds = 1U << 18;
    for (const std::uint32_t index : {0U, 1U, 31U}) {
        Random random(32 + index);
        std::vector<Case> cases;
        for (std::uint32_t i = 0; i < kSeeds; ++i) {
            cases.push_back(makeCase(index, {random.bits(), random.bits(), random.bits()}, random));
        }
        std::vector<double> counts(64 * 64, 0.0), low(4096, 0.0);
        for (const uvec2& p : scrambled(cases)) {
            ++counts[(p.x >> 26) * 64 + (p.y >> 26)];
            ++low[p.x >> 8 & 4095];  // the lowest bits that unitFloat uses
        }
        const std::vector<double> expected(4096, kSeeds / 4096.0);
        expectCounts("index " + std::to_string(index), counts, expected, 6);
        expectCounts("low bits of index " + std::to_string(index), low, expected, 6);
    }
}

// Slope of log MSE against log n over n = 2^4 .. 2^12 for the mean of f over the unit square, whose truth is known.
double errorSlope(const std::vector<uvec2>& points, std::uint32_t length, double truth, const std::function<double(double, double)>& f)
{
    std::vector<double> logError;
    for (std::uint32_t m = 4; m <= 12; ++m) {
        double squares = 0.0;
        for (std::size_t begin = 0; begin < points.size(); begin += length) {
            double sum = 0.0;
            for (std::size_t i = begin; i < begin + (1U << m); ++i) {
                sum += f((points[i].x + 0.5) * 0x1p-32, (points[i].y + 0.5) * 0x1p-32);
            }
            const double error = sum / (1U << m) - truth;
            squares += error * error;
        }
        logError.push_back(std::log2(squares));
    }
    double slope = 0.0;  // least squares over m - 8 = -4 .. 4, whose squares add up to 60
    for (int i = 0; i < 9; ++i) {
        slope += (i - 4) * logError[static_cast<std::size_t>(i)] / 60.0;
    }
    return slope;
}

struct Slopes {
    double smooth, edge;
};

Slopes slopesOf(const std::vector<uvec2>& points, std::uint32_t length)
{
    return {
        errorSlope(points, length, 0.25 * std::pow(std::exp(1.0) - 1.0, 2.0), [](double x, double y) { return 0.25 * std::exp(x + y); }),
        errorSlope(points, length, std::numbers::pi / 4.0, [](double x, double y) { return x * x + y * y < 1.0 ? 1.0 : 0.0; })};
}

// H33.
TEST(SobolTest, H33ErrorsFallAsTheyShould)
{
    constexpr std::uint32_t kSequences = 128, kLength = 4096;
    const Slopes slopes = slopesOf(sequences(kSequences, kLength, 33), kLength);
    const Slopes naive = slopesOf(independentPoints(kSequences * kLength, 35), kLength);
    printHardCase("H33", "slopes of log MSE", kSequences * kLength, "smooth " + figure(slopes.smooth) + ", edge " + figure(slopes.edge),
                  "independent points: " + figure(naive.smooth) + ", " + figure(naive.edge));
    EXPECT_LE(slopes.smooth, -2.5);
    EXPECT_NEAR(slopes.edge, -1.5, 0.15);
    EXPECT_GT(naive.smooth, -2.5);
    EXPECT_GT(naive.edge, -1.5 + 0.15);
}

}  // namespace glim::sobol_test
