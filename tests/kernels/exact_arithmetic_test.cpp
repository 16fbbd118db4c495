// Quotients and roots by integers (shaders/lib/exact.glsl) are those of IEEE 754, rounded to nearest, whatever the device's own are like;
// and the errors that adverse arithmetic adds are those that it says.
#include "host/gpu/commands.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/harness/arithmetic_device.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>

namespace glim::exact_arithmetic_test {

constexpr float kLeast = std::numeric_limits<float>::min();

struct Pair {
    float x, y;
};

std::vector<Pair> compute(Device& device, const std::vector<Pair>& pairs)
{
    const KernelLayout layout(device, {{kBindProbed, BufferKind::Storage}}, 0);
    const Kernel kernel(layout, newest(test_kernels::exact_arithmetic_test), {{kSpecWorkgroup, 64}});
    Buffer buffer(device, "numbers", BufferKind::Storage, pairs.size() * sizeof(Pair));
    upload(buffer, std::span<const Pair>(pairs));
    const Bindings bindings(layout, {{kBindProbed, &buffer}});
    Commands commands(device);
    commands.dispatch(kernel, bindings, {}, static_cast<std::uint32_t>((pairs.size() + 63) / 64));
    commands.submitAndWait();
    return download<Pair>(buffer, pairs.size());
}

float flush(float x) { return std::abs(x) < kLeast ? std::copysign(0.0F, x) : x; }

// Denormal operands are zero. A result is zero if it is denormal after rounding to 24 bits: the smallest normal number is one.
float quotientOf(float x, float y)
{
    const double exact = static_cast<double>(flush(x)) / static_cast<double>(flush(y));
    return std::abs(exact) < 0x1p-126
               ? std::copysign(std::abs(exact) * 0x1p60 < 0x1p-66 * (1 - 0x1p-25) ? 0.0F : kLeast, static_cast<float>(exact))
               : static_cast<float>(exact);
}

bool isSame(float a, float b) { return std::isnan(a) ? std::isnan(b) : std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

std::vector<Pair> edgesAndRandom()
{
    std::vector<float> edges;
    for (const std::uint32_t exponent : {0U, 1U, 2U, 63U, 64U, 126U, 127U, 128U, 190U, 191U, 253U, 254U, 255U}) {
        for (const std::uint32_t mantissa : {0U, 1U, 2U, 0x2aaaabU, 0x3504f2U, 0x3504f3U, 0x400000U, 0x555555U, 0x7ffffeU, 0x7fffffU}) {
            edges.push_back(std::bit_cast<float>(exponent << 23U | mantissa));
            edges.push_back(-edges.back());
        }
    }
    std::vector<Pair> pairs;
    for (const float x : edges) {
        for (const float y : edges) {
            pairs.push_back({x, y});
        }
    }
    Random random(1);
    for (std::size_t i = hardTrials(1000000); i > 0; --i) {
        const auto x = static_cast<std::uint32_t>(random.below(1U << 31U)), y = static_cast<std::uint32_t>(random.below(1U << 31U));
        // Of any size, of about one, and with quotients near a power of two.
        const std::uint32_t one = 127U << 23U, few = i % 1024;
        const std::uint32_t first = i % 3 == 0 ? x : one + x % (1U << 23U), second = i % 3 == 0 ? y : one + y % (1U << 23U);
        pairs.push_back({std::bit_cast<float>(first), std::bit_cast<float>(i % 3 == 2 ? first + few - 512 : second)});
    }
    return pairs;
}

class ExactArithmeticTest : public testing::TestWithParam<const char*> {};

TEST_P(ExactArithmeticTest, RoundsToNearest)
{
    const std::vector<Pair> pairs = edgesAndRandom(), results = compute(*deviceWith(GetParam()), pairs);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const float quotient = quotientOf(pairs[i].x, pairs[i].y), root = std::sqrt(flush(pairs[i].x));
        if (!isSame(results[i].x, quotient) || !isSame(results[i].y, root)) {
            ++wrong;
            EXPECT_GT(wrong, 5U) << std::hexfloat << pairs[i].x << " / " << pairs[i].y << " = " << results[i].x << ", not " << quotient
                                 << "; its root is " << results[i].y << ", not " << root;
        }
    }
    EXPECT_EQ(wrong, 0U) << "of " << pairs.size();
}

// The largest errors in ulp: relative, in units of 2^-23.
struct Errors {
    double quotient = 0.0, root = 0.0;
};

Errors errorsOf(const std::vector<Pair>& pairs, const char* arithmetic)
{
    const std::vector<Pair> results = compute(*deviceWith(arithmetic), pairs);
    Errors most;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto offBy = [](float result, double truth) { return std::abs(static_cast<double>(result) / truth - 1.0) * 0x1p23; };
        const double x = static_cast<double>(pairs[i].x), y = static_cast<double>(pairs[i].y);
        most.quotient = std::max(most.quotient, offBy(results[i].x, x / y));
        most.root = std::max(most.root, offBy(results[i].y, std::sqrt(x)));
    }
    return most;
}

// The errors of a device that the test above is to be right under: up to 2 ulp of quotients and 4 of roots are added to its own. These may
// be 2.5 and 4.5 (Vulkan, "Precision and Operation of SPIR-V Instructions": a root is as exact as 1 / inversesqrt, whose errors of 2.5 and
// 2 add up). At worst both have opposite signs.
TEST(AdverseArithmeticTest, NativeResultsAreOffByWhatVulkanAllows)
{
    std::vector<Pair> pairs = edgesAndRandom();
    std::erase_if(
        pairs, [](const Pair& pair) { return !(pair.x > 1e-9F && pair.x < 1e9F && std::abs(pair.y) > 1e-9F && std::abs(pair.y) < 1e9F); });
    const Errors own = errorsOf(pairs, "native");
    EXPECT_LE(own.quotient, 2.5);
    EXPECT_LE(own.root, 4.5);
    constexpr double kOfMantissa = 0.01;  // of an ulp: how far the relative size of one is below 2^-23 where mantissas are least
    for (const char* const arithmetic : {"native,adverse:0", "native,adverse:1"}) {
        const Errors errors = errorsOf(pairs, arithmetic);
        EXPECT_GT(errors.quotient, 2.0 - own.quotient - kOfMantissa);
        EXPECT_LE(errors.quotient, 2.0 + 2.5);
        EXPECT_GT(errors.root, 4.0 - own.root - kOfMantissa);
        EXPECT_LE(errors.root, 4.0 + 4.5);
    }
}

struct Case {
    float x, y;
    std::uint32_t seed;
};

struct Result {
    float flushed, moved, shifted, least, most;
    std::int32_t integer;
    std::uint32_t natural;
};

// By adverse.glsl itself, for seeds 0 to 63.
std::vector<Result> computeAdverse(float x, float y = 0.0F)
{
    std::vector<Case> cases;
    for (std::uint32_t seed = 0; seed < 64; ++seed) {
        cases.push_back({x, y, seed});
    }
    KernelTest test(test_kernels::adverse_arithmetic_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

constexpr float kInfinity = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

TEST(AdverseArithmeticTest, OnlyDenormalNumbersAreFlushed)
{
    for (const float x : {0.0F, kLeast, 1.0F, std::numeric_limits<float>::max(), kInfinity, kNan, kLeast / 2, 0x1p-149F}) {
        EXPECT_TRUE(isSame(computeAdverse(x)[1].flushed, flush(x))) << x;
        EXPECT_TRUE(isSame(computeAdverse(-x)[1].flushed, flush(-x))) << -x;
    }
}

TEST(AdverseArithmeticTest, NumbersMoveAsFarAsIsAllowedAndNoFarther)
{
    for (const float x : {1.5F, -1.0F, 0x1p-120F, 1e38F}) {
        std::set<int> steps;
        std::set<float> shifts;
        const std::vector<Result> results = computeAdverse(x);
        for (const Result& result : results) {
            steps.insert(std::bit_cast<std::int32_t>(result.moved) - std::bit_cast<std::int32_t>(x));
            shifts.insert(result.shifted - x);
        }
        EXPECT_EQ(steps, (std::set<int>{-3, -2, -1, 0, 1, 2, 3})) << x;
        EXPECT_EQ(std::bit_cast<std::int32_t>(results[0].moved) - std::bit_cast<std::int32_t>(x), 3) << "the worst is away from zero";
        if (std::abs(x) < 2.0F) {
            EXPECT_LT(*shifts.begin(), -0.8F * 0x1p-11F);
            EXPECT_GE(*shifts.begin(), -0x1p-11F);
            EXPECT_GT(*shifts.rbegin(), 0.8F * 0x1p-11F);
            EXPECT_LE(*shifts.rbegin(), 0x1p-11F);
        }
        EXPECT_NEAR(computeAdverse(0.0F)[0].shifted, 0x1p-11F, 0x1p-26F) << "the worst shift";
    }
    for (const float x : {0.0F, -0.0F, kLeast, kInfinity, -kInfinity, kNan, std::numeric_limits<float>::max()}) {
        for (const Result& result : computeAdverse(x)) {
            EXPECT_TRUE(isSame(result.moved, x)) << x;
        }
    }
}

// Where Vulkan leaves the choice, seeds choose either.
TEST(AdverseArithmeticTest, MinimaOfZerosAndOfNanAreEither)
{
    for (const auto& [x, y] : {Pair{1.0F, 2.0F}, Pair{2.0F, -1.0F}, Pair{-kInfinity, 0.0F}, Pair{3.0F, 3.0F}}) {
        for (const Result& result : computeAdverse(x, y)) {
            EXPECT_EQ(result.least, std::min(x, y));
            EXPECT_EQ(result.most, std::max(x, y));
        }
    }
    for (const auto& [x, y] : {Pair{0.0F, -0.0F}, Pair{-0.0F, 0.0F}, Pair{1.0F, kNan}, Pair{kNan, 1.0F}}) {
        std::size_t leastIsFirst = 0, mostIsFirst = 0;
        const std::vector<Result> results = computeAdverse(x, y);
        for (const Result& result : results) {
            EXPECT_TRUE(isSame(result.least, x) || isSame(result.least, y));
            EXPECT_TRUE(isSame(result.most, x) || isSame(result.most, y));
            leastIsFirst += isSame(result.least, x);
            mostIsFirst += isSame(result.most, x);
        }
        EXPECT_TRUE(leastIsFirst > 0 && leastIsFirst < results.size()) << x << ' ' << y;
        EXPECT_TRUE(mostIsFirst > 0 && mostIsFirst < results.size()) << x << ' ' << y;
    }
}

TEST(AdverseArithmeticTest, IntegersOutOfRangeAreAny)
{
    for (const float x : {0.0F, 0.9F, 1.9F, 16777216.0F, 2147483520.0F}) {
        for (const Result& result : computeAdverse(x)) {
            EXPECT_EQ(result.integer, static_cast<std::int32_t>(x));
            EXPECT_EQ(result.natural, static_cast<std::uint32_t>(x));
        }
    }
    for (const Result& result : computeAdverse(-2147483520.0F)) {
        EXPECT_EQ(result.integer, -2147483520);
    }
    EXPECT_EQ(computeAdverse(-0.9F)[1].natural, 0U);
    EXPECT_EQ(computeAdverse(4294967040.0F)[1].natural, 4294967040U);
    for (const float x : {4294967296.0F, -2147483904.0F, kInfinity, -kInfinity, kNan}) {
        std::set<std::int64_t> integers, naturals;
        for (const Result& result : computeAdverse(x)) {
            integers.insert(result.integer);
            naturals.insert(result.natural);
        }
        EXPECT_GT(integers.size(), 32U) << x;
        EXPECT_GT(naturals.size(), 32U) << x;
    }
}

TEST(AdverseArithmeticTest, WordsThatNameNoneAreRefused)
{
    for (const char* const words :
         {"exactly", "adverse", "adverse:", "adverse:-1", "adverse:1x", "native,", "native,exact", "nativeadverse:1"}) {
        EXPECT_THROW(deviceWith(words), InputError) << words;
    }
}

INSTANTIATE_TEST_SUITE_P(Arithmetics, ExactArithmeticTest, testing::Values("exact", "adverse:0", "adverse:1", "adverse:2", "adverse:3"));

}  // namespace glim::exact_arithmetic_test
