// The microfacet lobes against the reference in tests/oracle.
#include "test_kernels.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

namespace glim::ggx_test {

struct GgxCase {
    vec3 wo, wi;
    vec2 alpha;
    float eval, evalTolerance, pdf, pdfTolerance;
};

struct TransmissionCase {
    vec3 wo, wi;
    float alpha, eta;
    float eval, evalTolerance, pdf, pdfTolerance;
    float cosine, reflected, reflectedTolerance;
};

struct MultipleScatteringCase {
    vec2 ab, average;
    vec3 f0;
    float f90;
    vec3 fms, albedo;
};

TEST(GgxTest, IsTheReferences)
{
    compareWithOracle("GGX, relative, value and density", test_kernels::ggx_test, oracleCases<GgxCase>("ggx_cases"));
}

TEST(GgxTransmissionTest, IsTheReferences)
{
    compareWithOracle("transmission, relative, value and density", test_kernels::ggx_transmission_test,
                      oracleCases<TransmissionCase>("transmission_cases"));
}

TEST(MultipleScatteringTest, IsTheReferences)
{
    compareWithOracle("multiple scattering, share and albedo", test_kernels::multiple_scattering_test,
                      oracleCases<MultipleScatteringCase>("multiple_scattering_cases"));
}

}  // namespace glim::ggx_test
