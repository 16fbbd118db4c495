#include "test_kernels.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

namespace glim::thin_film_test {

struct Case {
    float cosine, ior, thickness;
    vec3 baseF0, reflectance, tolerance;
};

TEST(ThinFilmTest, IsTheReferences)
{
    compareWithOracle("thin film, absolute", test_kernels::thin_film_test, oracleCases<Case>("film_cases"));
}

}  // namespace glim::thin_film_test
