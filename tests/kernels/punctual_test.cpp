#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim {
namespace {

struct Case {
    float cosine, cosInner, cosOuter, falloff, tolerance;
};

// H16: KHR_lights_punctual, "Inner and Outer Cone Angles": attenuation = (saturate(cos * scale + offset))^2 with
// scale = 1 / (cosInner - cosOuter), offset = -cosOuter * scale.
TEST(PunctualTest, FallsOffTowardsTheRim)
{
    Random random(90);
    std::vector<Case> cases;
    for (int i = 0; i < 100000; ++i) {
        const float outer = static_cast<float>(random.uniform(-0.9, 0.99));
        const float inner = outer + static_cast<float>((0.9999 - static_cast<double>(outer)) * random.logUniform(2e-2, 1.0));
        const float cosine = i % 2 == 0 ? static_cast<float>(random.uniform(-1.0, 1.0))
                                        : outer + (inner - outer) * static_cast<float>(random.uniform(-0.1, 1.1));
        const double scale = 1.0 / (static_cast<double>(inner) - static_cast<double>(outer));
        const double offset = -static_cast<double>(outer) * scale;
        const double ramp = std::clamp(static_cast<double>(cosine) * scale + offset, 0.0, 1.0);
        // Two differences and a quotient of 2.5 ulp, doubled by the square.
        cases.push_back({cosine, inner, outer, static_cast<float>(ramp * ramp), 1e-6F});
    }
    KernelTest(test_kernels::punctual_test).cases(cases).run();
}

}  // namespace
}  // namespace glim
