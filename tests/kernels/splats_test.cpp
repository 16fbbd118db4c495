// Splats: sums in fixed point of 64 bits, against integers of the host.
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

namespace glim::splats_test {

constexpr std::uint32_t kPixels = 5, kFirst = 100;  // pixels 100 to 104 of the picture

struct Case {
    uint pixel;
    uint sampleIndex;
    uint pathLength;
    vec3 contribution;
    uint group = 0;
};

using Sums = std::array<std::uint64_t, 4>;  // red, green, blue, clamped

struct Outcome {
    std::vector<Sums> sums;
    Status status;
};

// `before`: what each sum of each pixel holds at first.
Outcome add(const std::vector<Case>& cases, float scale = 1.0F, float clamp = INFINITY, std::uint64_t before = 0, uint groups = 0)
{
    const std::size_t count = kPixels * std::max(1U, groups);
    const uvec2 words(static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(before >> 32U));
    Buffer splats(testDevice(), "test's splats", BufferKind::Storage, count * sizeof(Splat));
    Buffer status(testDevice(), "test's status", BufferKind::Storage, sizeof(Status));
    upload(splats, std::span<const Splat>(std::vector<Splat>(count, Splat{words, words, words, words})));
    upload(status, std::span<const Status>(std::vector<Status>(1)));
    KernelTest test(test_kernels::splats_test);
    test.cases(cases).buffers({{kBindSplats, &splats}, {kBindStatus, &status}});
    test.pass().tileBegin = kFirst;
    test.parameters().splatScale = scale;
    test.parameters().clampIndirect = clamp;
    test.parameters().lightGroups = groups;
    test.run();
    Outcome outcome{{}, download<Status>(status, 1)[0]};
    const auto wide = [](const uvec2& sum) { return std::uint64_t{sum.y} << 32U | sum.x; };
    for (const Splat& splat : download<Splat>(splats, count)) {
        outcome.sums.push_back({wide(splat.red), wide(splat.green), wide(splat.blue), wide(splat.clamped)});
    }
    return outcome;
}

// Integers that float holds, of up to `bits` bits.
float anyUnits(Random& random, std::uint32_t bits)
{
    const float mantissa = static_cast<float>(random.bits() >> 8U);
    return std::floor(std::ldexp(mantissa, static_cast<int>(random.below(bits)) - 23));
}

std::vector<Case> anyCases(std::uint64_t seed, std::size_t count, std::uint32_t bits)
{
    Random random(seed);
    std::vector<Case> cases;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 units(anyUnits(random, bits), anyUnits(random, bits), anyUnits(random, bits));
        cases.push_back({kFirst + random.below(kPixels), 0, 1, units});
    }
    return cases;
}

std::vector<Sums> sumsOf(const std::vector<Case>& cases, std::uint64_t before = 0)
{
    std::vector<Sums> sums(kPixels, {before, before, before, before});
    for (const Case& c : cases) {
        for (int k = 0; k < 3; ++k) {
            sums[c.pixel - kFirst][static_cast<std::size_t>(k)] += static_cast<std::uint64_t>(c.contribution[k]);
        }
    }
    return sums;
}

// Of 1 to 46 bits: 100,000 of them on five pixels carry into the upper word some 20,000 times.
TEST(SplatsTest, SumsAreThoseOfIntegersOf64Bits)
{
    for (const std::uint32_t bits : {20U, 33U, 46U}) {
        const std::vector<Case> cases = anyCases(bits, 100000, bits);
        const Outcome outcome = add(cases);
        EXPECT_EQ(outcome.sums, sumsOf(cases)) << bits << " bits";
        EXPECT_EQ(outcome.status.splatOverflows, 0U);
        EXPECT_EQ(outcome.status.nonFinite, 0U);
    }
}

// Every addition of 2^32 - 256 to the lower word carries, but for one in 2^24.
TEST(SplatsTest, EveryCarryCounts)
{
    const std::vector<Case> cases(65536, {kFirst + 2, 0, 1, vec3(0x1p32F - 256.0F, 1.0F, 0x1p31F)});
    EXPECT_EQ(add(cases, 1.0F, INFINITY, 0xffffffffULL).sums, sumsOf(cases, 0xffffffffULL));
}

TEST(SplatsTest, NoOrderChangesABit)
{
    std::vector<Case> cases = anyCases(5, 50000, 40);
    for (Case& c : cases) {
        c.contribution *= 1.0F / 3.0F;  // so that units are rounded
    }
    const std::vector<Sums> first = add(cases).sums;
    std::mt19937 random(1);
    for (int round = 0; round < 3; ++round) {
        std::ranges::shuffle(cases, random);
        EXPECT_EQ(add(cases).sums, first);
    }
}

// To the nearest unit, however many there are. Doubles hold every product here exactly.
TEST(SplatsTest, LightIsRoundedToTheNearestUnit)
{
    Random random(6);
    constexpr float kScale = 0x1p20F;
    for (int i = 0; i < 40; ++i) {
        const auto units = static_cast<float>(random.logUniform(0.1, 0x1p26));
        const Outcome outcome = add({{kFirst, 0, 1, vec3(units / kScale)}}, kScale);
        const double error = static_cast<double>(outcome.sums[0][0]) - static_cast<double>(units);
        EXPECT_LE(std::abs(error), 0.5) << units << " units";
    }
    for (const float units : {0x1.fffffep-2F, 8388609.0F, 8388611.0F, 16777215.0F}) {
        EXPECT_LE(std::abs(static_cast<double>(add({{kFirst, 0, 1, vec3(units)}}).sums[0][0]) - static_cast<double>(units)), 0.5) << units;
    }
}

TEST(SplatsTest, OtherPixelsAreLeftAlone)
{
    std::vector<Case> cases;
    for (const uint pixel : {0U, kFirst - 1, kFirst + kPixels, 0xffffffffU}) {
        cases.push_back({pixel, 0, 1, vec3(7.0F)});
    }
    EXPECT_EQ(add(cases).sums, std::vector<Sums>(kPixels));
}

// 2^62 units and more at once, or a sum of 2^64 and more: counted, since the picture is wrong.
TEST(SplatsTest, OverflowsAreCounted)
{
    const float most = std::nextafter(0x1p62F, 0.0F);
    const Outcome large = add({{kFirst, 0, 1, vec3(1.0F, 0x1p62F, 2.0F)}, {kFirst, 0, 1, vec3(0.0F, 0.0F, most)}});
    EXPECT_EQ(large.status.splatOverflows, 1U);
    EXPECT_EQ(large.sums[0], (Sums{0, 0, static_cast<std::uint64_t>(most), 0}));
    const std::vector<Case> four(4, {kFirst + 1, 0, 1, vec3(most, 0.0F, 1.0F)});
    EXPECT_EQ(add(four).status.splatOverflows, 0U);
    std::vector<Case> five(5, four[0]);
    EXPECT_EQ(add(five).status.splatOverflows, 1U);
    // By the carry alone.
    EXPECT_EQ(add({{kFirst, 0, 1, vec3(1.0F, 0.0F, 0.0F)}}, 1.0F, INFINITY, ~std::uint64_t{0}).status.splatOverflows, 1U);
}

// A contribution with any channel that is not finite is in no sum, and is located.
TEST(SplatsTest, NonFiniteLightIsCountedAndLeftOut)
{
    const float nan = std::bit_cast<float>(0x7fc00000U);
    std::vector<Case> cases;
    for (const float bad : {nan, INFINITY, -INFINITY}) {
        for (int k = 0; k < 3; ++k) {
            Case c{kFirst + 3, 10 * static_cast<uint>(cases.size()) + 1, 1, vec3(5.0F)};
            c.contribution[k] = bad;
            cases.push_back(c);
        }
    }
    cases.push_back({kFirst + 3, 0, 1, vec3(2.0F)});
    const Outcome outcome = add(cases);
    EXPECT_EQ(outcome.sums[3], (Sums{2, 2, 2, 0}));
    EXPECT_EQ(outcome.status.splatOverflows, 0U);
    ASSERT_EQ(outcome.status.nonFinite, 9U);
    std::uint32_t samples = 0;
    for (std::uint32_t i = 0; i < 9; ++i) {
        EXPECT_EQ(outcome.status.located[i].pixel, kFirst + 3);
        samples |= 1U << (outcome.status.located[i].sampleIndex / 10);
    }
    EXPECT_EQ(samples, 0x1ffU);
}

// With --clamp-indirect, light that has met two surfaces is cut to the limit, and what is cut is kept apart.
TEST(SplatsTest, ClampedLightIsKeptApart)
{
    const Outcome outcome = add({{kFirst, 0, 1, vec3(64.0F, 32.0F, 0.0F)}, {kFirst + 1, 0, 2, vec3(64.0F, 32.0F, 0.0F)}}, 1024.0F, 16.0F);
    EXPECT_EQ(outcome.sums[0], (Sums{65536, 32768, 0, 0}));
    EXPECT_EQ(outcome.sums[1], (Sums{16384, 8192, 0, (48 + 24) * 1024 / 3}));
}

// The sums of a group lie behind those of the group before.
TEST(SplatsTest, EachLightGroupHasItsOwnSums)
{
    constexpr uint kGroups = 3;
    std::vector<Case> cases = anyCases(9, 20000, 33);
    std::vector<Sums> expected(kPixels * kGroups);
    Random random(2);
    for (Case& c : cases) {
        c.group = random.below(kGroups);
        for (int k = 0; k < 3; ++k) {
            expected[c.group * kPixels + c.pixel - kFirst][static_cast<std::size_t>(k)] += static_cast<std::uint64_t>(c.contribution[k]);
        }
    }
    EXPECT_EQ(add(cases, 1.0F, INFINITY, 0, kGroups).sums, expected);
    cases = {{kFirst + kPixels, 0, 1, vec3(7.0F), 1}, {kFirst - 1, 0, 1, vec3(7.0F), 1}};
    EXPECT_EQ(add(cases, 1.0F, INFINITY, 0, kGroups).sums, std::vector<Sums>(kPixels * kGroups)) << "of other pixels";
}

// What all of them have together is a sum of 64 bits, too.
TEST(SplatsTest, OverflowOfAllGroupsTogetherIsReported)
{
    const std::vector<Case> cases{{kFirst, 0, 1, vec3(0x1p40F), 2}};
    EXPECT_EQ(add({{kFirst, 0, 1, vec3(0x1p40F)}}, 1.0F, INFINITY, 0x7fffff0000000000ULL).status.splatOverflows, 0U);
    EXPECT_EQ(add(cases, 1.0F, INFINITY, 0x3fffff0000000000ULL, 4).status.splatOverflows, 3U) << "of its three channels";
    EXPECT_EQ(add(cases, 1.0F, INFINITY, 0x3ffff00000000000ULL, 4).status.splatOverflows, 0U);
}

}  // namespace glim::splats_test
