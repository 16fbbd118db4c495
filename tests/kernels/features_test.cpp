#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

TEST(FeaturesTest, EachConstantIsSetByItsOwnId)
{
    for (uint id = kSpecSpheres; id <= kSpecMollerTrumbore; ++id) {
        KernelTest test(test_kernels::features_test);
        for (uint other = kSpecSpheres; other <= kSpecMollerTrumbore; ++other) {
            test.specialize(other, other == id ? 1 : 0);
        }
        test.cases(std::vector<uint>{1U << (id - kSpecSpheres)}).run();
    }
}

}  // namespace
}  // namespace glim
