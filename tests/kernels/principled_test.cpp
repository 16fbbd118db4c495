// The whole glTF material: against the reference in tests/oracle, reciprocity, and what an absent layer leaves.
#include "tests/support/albedo_buffer.hpp"

#include "shaders/shared/features.h"
#include "test_kernels.hpp"
#include "tests/support/material_case.h"
#include "tests/support/oracle_cases.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

struct OracleCase {
    vec3 wo, wi;
    MaterialCase material;
    vec3 value, tolerance;
};

TEST(PrincipledTest, IsTheReferences)
{
    const AlbedoBuffer albedos;
    compareWithOracle("principled, relative to value and tolerance", test_kernels::principled_test,
                      oracleCases<OracleCase>("principled_cases"), albedos.bound());
}

}  // namespace
}  // namespace glim
