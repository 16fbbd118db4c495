#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

TEST(FeaturesTest, EachConstantFollowsItsOwnId)
{
    // Unasked, everything is on but the textbook triangle test.
    std::uint32_t defaults = 0;
    for (std::uint32_t id = kSpecSpheres; id <= kSpecSobol; ++id) {
        defaults |= 1U << id;
    }
    KernelTest(test_kernels::features_test).cases(std::vector<uint>{defaults}).run();
    for (std::uint32_t id = kSpecSpheres; id <= kSpecMollerTrumbore; ++id) {
        SCOPED_TRACE("constant " + std::to_string(id));
        const std::uint32_t value = id == kSpecMollerTrumbore ? 1 : 0;
        KernelTest test(test_kernels::features_test);
        test.cases(std::vector<uint>{defaults ^ 1U << id}).specialize(id, value).run();
    }
}

}  // namespace
}  // namespace glim
