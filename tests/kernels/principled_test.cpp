// The whole glTF material: against the reference in tests/oracle, reciprocity, and what an absent layer leaves.
#include "tests/support/albedo_buffer.hpp"

#include "test_kernels.hpp"
#include "tests/support/materials.hpp"
#include "tests/support/oracle_cases.hpp"

#include <gtest/gtest.h>

namespace glim::principled_test {

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

struct PairCase {
    vec3 wo, wi;
    MaterialCase material;
};

// f(wo, wi) = f(wi, wo). Iridescence is left out: what lies under a film sees its reflectance at wo alone.
TEST(PrincipledTest, OpaqueMaterialsAreReciprocal)
{
    Random random(3);
    std::vector<PairCase> cases(100000);
    for (PairCase& c : cases) {
        c.material = randomOpaque(random);
        const double cosine = random.below(4) == 0 ? random.logUniform(1e-4, 1.0) : 1.0 - random.uniform();
        c.wo = directionAt(cosine, 2.0 * std::numbers::pi * random.uniform());
        c.wi = directionAt(1.0 - random.uniform(), 2.0 * std::numbers::pi * random.uniform());
    }
    const AlbedoBuffer albedos;
    compareWithOracle("reciprocity, relative", test_kernels::principled_reciprocity_test, cases, albedos.bound());
}

}  // namespace glim::principled_test
