#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

namespace glim::dispersion_test {

struct Index {
    float nm, ior, spread, expected;
};

struct Case {
    Index index;
    vec2 u;
};

using glm::vec4;

// A grid of the numbers that choose a wavelength: colours have the mean 1 exactly, and wavelengths a triangular density.
TEST(DispersionTest, IndicesAndWavelengths)
{
    constexpr int kColumns = 3 * 128, kRows = 128;
    const std::vector<Index> indices = oracleCases<Index>("ior_cases");
    std::vector<Case> cases;
    for (int i = 0; i < kColumns * kRows; ++i) {
        const int column = i % kColumns, row = i / kColumns;
        cases.push_back({indices[static_cast<std::size_t>(i) % indices.size()],
                         {(static_cast<float>(column) + 0.5F) / kColumns, (static_cast<float>(row) + 0.5F) / kRows}});
    }
    KernelTest test(test_kernels::dispersion_test);
    test.cases(cases).resultsOf<vec4>(cases.size()).run();
    glm::dvec4 sum(0.0), squares(0.0);
    for (const vec4& result : test.results<vec4>()) {
        sum += glm::dvec4(result);
        squares += glm::dvec4(result) * glm::dvec4(result);
    }
    const auto n = static_cast<double>(cases.size());
    EXPECT_EQ(sum / n, glm::dvec4(1.0, 1.0, 1.0, sum.w / n));
    EXPECT_NEAR(sum.w / n, 0.0, 1e-3) << "nm";
    // The sum of two uniform numbers, each on 128 points: 2 * 60^2 / 12 (1 - 1 / 128^2).
    EXPECT_NEAR(squares.w / n, 600.0 * (1.0 - 1.0 / (128.0 * 128.0)), 0.01) << "nm^2";
}

}  // namespace glim::dispersion_test
