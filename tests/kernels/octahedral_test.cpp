// Unit vectors in 32 bits come back within half a step of the code, on both halves of the octahedron and on its edges.
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::octahedral_test {

using glm::dvec3;

TEST(OctahedralTest, VectorsComeBackWithinAStep)
{
    Random random(5);
    std::vector<vec3> vectors;
    for (const float x : {-1.0F, 0.0F, 1.0F}) {
        for (const float y : {-1.0F, 0.0F, 1.0F}) {
            for (const float z : {-1.0F, -0.0F, 0.0F, 1.0F}) {
                if (x != 0.0F || y != 0.0F || z != 0.0F) {
                    vectors.push_back(glm::normalize(vec3(x, y, z)));
                }
            }
        }
    }
    for (int i = 0; i < 100000; ++i) {
        vectors.push_back(vec3(random.direction()));
    }
    KernelTest test(test_kernels::octahedral_test);
    test.cases(vectors).resultsOf<vec3>(vectors.size()).run();
    const std::vector<vec3> decoded = test.results<vec3>();
    double farthest = 0.0, longest = 0.0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        farthest = std::max(farthest, glm::distance(dvec3(decoded[i]), glm::normalize(dvec3(vectors[i]))));
        longest = std::max(longest, std::abs(glm::length(dvec3(decoded[i])) - 1.0));
    }
    // Rounding moves a point by sqrt(1/2) / 32767 at most in the square of the code. That is sqrt(3) times as far on the octahedron where
    // both coordinates move alike, and sqrt(3) times again on the sphere, in the middle of a face: 6.47e-5, and float's own rounding.
    EXPECT_LT(farthest, 6.5e-5);
    EXPECT_GT(farthest, 5e-5) << "the code has no more bits than that";
    // The square has three roundings, which half the error's size under the root; the root and the quotient have one each.
    EXPECT_LE(longest, 3.5 * 0x1p-24);
}

}  // namespace glim::octahedral_test
