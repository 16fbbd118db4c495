#include "test_kernels.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

namespace glim::sheen_test {

struct Case {
    vec3 wo, wi;
    float alpha;
    float eval, evalTolerance, masking, maskingTolerance;
};

TEST(SheenTest, IsTheReferences)
{
    compareWithOracle("sheen, relative, value and masking", test_kernels::sheen_test, oracleCases<Case>("sheen_cases"));
}

}  // namespace glim::sheen_test
