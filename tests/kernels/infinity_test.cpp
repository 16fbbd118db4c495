#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glim {
namespace {

TEST(InfinityTest, ExceedsEveryNumber)
{
    const float largest = std::numeric_limits<float>::max();
    KernelTest(test_kernels::infinity_test).cases(std::vector<float>{-largest, -1.0F, 0.0F, 1.0F, largest}).run();
}

}  // namespace
}  // namespace glim
