#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

struct Case {
    vec3 direct;
    vec3 indirect;
    vec3 sum;
    float clamped;
};

TEST(RadianceTest, AddsAndClampsIndirectLightOnly)
{
    const std::vector<Case> cases = {
        {{9, 1, 1}, {0.5F, 1, 2}, {9.5F, 2, 3}, 0.0F},          // within the limit of 2
        {{9, 1, 1}, {4, 8, 2}, {10, 3, 1.5F}, (3.0F + 6.0F + 1.5F) / 3.0F},  // scaled by a quarter
        {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0.0F}};
    Buffer radiance(testDevice(), "path radiances", BufferKind::Storage, cases.size() * sizeof(PathRadiance));
    KernelTest test(test_kernels::radiance_test);
    test.cases(cases).buffers({{kBindRadiance, &radiance}});
    test.pass().clampIndirect = 2.0F;
    test.run();
}

}  // namespace
}  // namespace glim
