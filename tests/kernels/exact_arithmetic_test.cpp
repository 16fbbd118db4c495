// Quotients and roots by integers (shaders/lib/exact.glsl) are those of IEEE 754, rounded to nearest, whatever the device's own are like.
#include "host/gpu/commands.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "test_kernels.hpp"
#include "tests/support/arithmetic_device.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr float kLeast = std::numeric_limits<float>::min();

struct Pair {
    float x, y;
};

std::vector<Pair> compute(Device& device, const std::vector<Pair>& pairs)
{
    const KernelLayout layout(device, {{kBindProbed, BufferKind::Storage}}, 0);
    const Kernel kernel(layout, test_kernels::exact_arithmetic_test, {{kSpecWorkgroup, 64}});
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

// The errors of a device that the test above is to be right under.
TEST(AdverseArithmeticTest, NativeResultsAreOffByWhatVulkanAllows)
{
    std::vector<Pair> pairs = edgesAndRandom();
    std::erase_if(
        pairs, [](const Pair& pair) { return !(pair.x > 1e-9F && pair.x < 1e9F && std::abs(pair.y) > 1e-9F && std::abs(pair.y) < 1e9F); });
    for (const char* const arithmetic : {"native,adverse:0", "native,adverse:1"}) {
        const std::vector<Pair> results = compute(*deviceWith(arithmetic), pairs);
        double quotient = 0.0, root = 0.0;  // the most, in ulp
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto offBy = [](float result, double truth) { return std::abs(static_cast<double>(result) / truth - 1.0) * 0x1p23; };
            const double x = static_cast<double>(pairs[i].x), y = static_cast<double>(pairs[i].y);
            quotient = std::max(quotient, offBy(results[i].x, x / y));
            root = std::max(root, offBy(results[i].y, std::sqrt(x)));
        }
        EXPECT_GT(quotient, 1.9);
        EXPECT_LE(quotient, 2.5);
        EXPECT_GT(root, 3.9);
        EXPECT_LE(root, 4.5);
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

}  // namespace
}  // namespace glim
