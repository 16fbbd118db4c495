// H3, H37, H38: the program's kernels carry the marks that ask the driver for exact arithmetic, as they are embedded and as it gets them.
#include "host/render/kernel_set.hpp"
#include "kernels.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/features.h"
#include "tests/support/named.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace glim::float_marks_test {

// SPIR-V specification, sections 3.6, 3.20, 3.49.
constexpr std::uint32_t kOpExecutionMode = 16, kOpDecorate = 71, kNoContraction = 42, kSignedZeroInfNanPreserve = 4461,
                        kRoundingModeRte = 4462;
constexpr std::uint32_t kOpFNegate = 127, kOpFAdd = 129, kOpFSub = 131, kOpFMul = 133, kOpFDiv = 136, kOpFRem = 140, kOpFMod = 141,
                        kOpVectorTimesScalar = 142, kOpDot = 148;

bool isFloatArithmetic(std::uint32_t opcode)
{
    return opcode == kOpFNegate || opcode == kOpFAdd || opcode == kOpFSub || opcode == kOpFMul || opcode == kOpFDiv || opcode == kOpFRem ||
           opcode == kOpFMod || (opcode >= kOpVectorTimesScalar && opcode <= kOpDot);
}

test::Named<const EmbeddedShader*> named(const EmbeddedShader& shader) { return {shader.name, &shader}; }

class FloatMarksTest : public testing::TestWithParam<test::Named<const EmbeddedShader*>> {};

struct Marks {
    std::set<std::uint32_t> marked, arithmetic;  // ids
    bool keepsInfinity = false, roundsToNearest = false;
};

Marks marksOf(std::span<const std::uint32_t> words)
{
    Marks marks;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t opcode = words[at] & 0xffff;
        if (opcode == kOpDecorate && words[at + 2] == kNoContraction) {
            marks.marked.insert(words[at + 1]);
        }
        marks.keepsInfinity =
            marks.keepsInfinity || (opcode == kOpExecutionMode && words[at + 2] == kSignedZeroInfNanPreserve && words[at + 3] == 32);
        marks.roundsToNearest =
            marks.roundsToNearest || (opcode == kOpExecutionMode && words[at + 2] == kRoundingModeRte && words[at + 3] == 32);
        if (isFloatArithmetic(opcode)) {
            marks.arithmetic.insert(words[at + 2]);
        }
    }
    return marks;
}

TEST_P(FloatMarksTest, H3H37H38EveryOperationIsExact)
{
    const Marks embedded = marksOf(GetParam().value->words());
    EXPECT_TRUE(embedded.keepsInfinity);
    EXPECT_EQ(embedded.arithmetic, embedded.marked);
    EXPECT_FALSE(embedded.arithmetic.empty());
    for (const FeatureMask features :
         {FeatureMask{0}, kFeatureTriangleLights | kFeatureMirror, kFeaturePrincipled | kFeatureTextures, kAllFeatures}) {
        SCOPED_TRACE("features " + std::to_string(features));
        for (const Arithmetic& arithmetic : {Arithmetic{.exact = false}, Arithmetic{.declaresRounding = true}, Arithmetic{.adverse = 1}}) {
            const Marks given = marksOf(specialize(*GetParam().value, makeConstants(features), arithmetic));
            EXPECT_TRUE(given.keepsInfinity);
            EXPECT_EQ(given.roundsToNearest, arithmetic.declaresRounding);
            EXPECT_TRUE(std::includes(given.marked.begin(), given.marked.end(), given.arithmetic.begin(), given.arithmetic.end()));
            EXPECT_FALSE(given.arithmetic.empty());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Kernels, FloatMarksTest,
                         testing::Values(named(kernels::generate_rays), named(kernels::trace_closest), named(kernels::shade_surface),
                                         named(kernels::trace_paths), named(kernels::trace_shadow), named(kernels::accumulate)),
                         test::nameOfParameter);

}  // namespace glim::float_marks_test
