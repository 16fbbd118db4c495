#include "test_kernels.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::infinity_test {

TEST(InfinityTest, IsInfinite) { KernelTest(test_kernels::infinity_test).threads(1).run(); }

}  // namespace glim::infinity_test
