// What tells devices apart by how they round (shaders/kernels/probe_arithmetic.comp): its inputs cover what kernels use, and its results
// are those of the operations that it names.
#include "host/gpu/commands.hpp"
#include "host/render/film_identity.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"
#include "tests/harness/arithmetic_device.hpp"
#include "tests/harness/test_device.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::probe_arithmetic_test {

TEST(ProbeArithmeticTest, GivesWhatTheOperationsGive)
{
    const KernelLayout layout(testDevice(), {{kBindProbed, BufferKind::Readback}}, 0);
    const Kernel kernel(layout, kernels::probe_arithmetic, {{kSpecWorkgroup, 64}});
    const Buffer buffer(testDevice(), "probed arithmetic", BufferKind::Readback, kProbedInputs * kProbedOperations * sizeof(float));
    const Bindings bindings(layout, {{kBindProbed, &buffer}});
    Commands commands(testDevice());
    commands.dispatch(kernel, bindings, {}, kProbedInputs / 64);
    commands.submitAndWait();
    const std::vector<float> probed = download<float>(buffer, kProbedInputs * kProbedOperations);
    double least = 1.0, most = 0.0;
    for (std::uint32_t i = 0; i < kProbedInputs; ++i) {
        std::uint32_t bits = i * 747796405U + 2891336453U;
        bits ^= bits >> 16U;
        const double unit = (bits >> 8U) * 0x1p-24 + 1e-7, angle = (unit - 0.5) * 12.0, wide = unit * std::exp2(i % 31U);
        const double expected[] = {std::sqrt(wide), unit / (wide + 0.37), std::hypot(unit, angle, wide), unit * angle + wide,
                                   std::lerp(angle, wide, unit)};
        for (std::uint32_t k = 0; k < kProbedOperations; ++k) {
            EXPECT_NEAR(probed[i * kProbedOperations + k], expected[k], 2e-5 * std::max(1.0, std::abs(expected[k]))) << i << ' ' << k;
        }
        least = std::min(least, unit);
        most = std::max(most, unit);
    }
    EXPECT_LT(least, 1e-3);
    EXPECT_GT(most, 0.999);
    EXPECT_EQ(arithmeticFingerprint(testDevice()).size(), 16U);
}

// The identity of a device that rounds to nearest is that of the others, whatever its own divisions are like.
TEST(ProbeArithmeticTest, TellsDevicesApartThatGiveOtherBits)
{
    const std::string own = arithmeticFingerprint(testDevice());
    for (const char* const arithmetic : {"exact", "adverse:0", "adverse:1"}) {
        EXPECT_EQ(arithmeticFingerprint(*deviceWith(arithmetic)), own) << arithmetic;
    }
    EXPECT_NE(arithmeticFingerprint(*deviceWith("native,adverse:1")), own);
}

}  // namespace glim::probe_arithmetic_test
