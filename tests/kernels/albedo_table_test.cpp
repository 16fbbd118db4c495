// What kernels look up in the tables of albedos, against the reference's quadrature.
#include "tests/support/albedo_buffer.hpp"

#include "test_kernels.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

namespace glim::albedo_table_test {

struct Case {
    float cosine, alpha;
    vec2 ab, average;
    float sheen;
};

TEST(AlbedoTableTest, IsTheReferences)
{
    const AlbedoBuffer albedos;
    compareWithOracle("albedos, of GGX and sheen", test_kernels::albedo_table_test, oracleCases<Case>("albedo_cases"), albedos.bound());
}

}  // namespace glim::albedo_table_test
