// H3, H37, H38: the program's kernels carry the marks that ask the driver for exact arithmetic.
#include "kernels.hpp"
#include "tests/support/named.hpp"

#include <gtest/gtest.h>

#include <set>

namespace glim {
namespace {

// SPIR-V specification, sections 3.6, 3.20, 3.49.
constexpr std::uint32_t kOpExecutionMode = 16, kOpDecorate = 71, kNoContraction = 42, kSignedZeroInfNanPreserve = 4461;
constexpr std::uint32_t kOpFNegate = 127, kOpFAdd = 129, kOpFSub = 131, kOpFMul = 133, kOpFDiv = 136, kOpFRem = 140, kOpFMod = 141,
                        kOpVectorTimesScalar = 142, kOpDot = 148;

bool isFloatArithmetic(std::uint32_t opcode)
{
    return opcode == kOpFNegate || opcode == kOpFAdd || opcode == kOpFSub || opcode == kOpFMul || opcode == kOpFDiv || opcode == kOpFRem ||
           opcode == kOpFMod || (opcode >= kOpVectorTimesScalar && opcode <= kOpDot);
}

test::Named<const EmbeddedShader*> named(const EmbeddedShader& shader) { return {shader.name, &shader}; }

class FloatMarksTest : public testing::TestWithParam<test::Named<const EmbeddedShader*>> {};

TEST_P(FloatMarksTest, H3H37H38EveryOperationIsExact)
{
    const std::span<const std::uint32_t> words = GetParam().value->words();
    std::set<std::uint32_t> marked, arithmetic;
    bool keepsInfinity = false;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t opcode = words[at] & 0xffff;
        if (opcode == kOpDecorate && words[at + 2] == kNoContraction) {
            marked.insert(words[at + 1]);
        }
        keepsInfinity = keepsInfinity || (opcode == kOpExecutionMode && words[at + 2] == kSignedZeroInfNanPreserve && words[at + 3] == 32);
        if (isFloatArithmetic(opcode)) {
            arithmetic.insert(words[at + 2]);
        }
    }
    EXPECT_TRUE(keepsInfinity);
    EXPECT_EQ(arithmetic, marked);
    EXPECT_EQ(arithmetic.empty(), GetParam().value == &kernels::size_dispatch);
}

INSTANTIATE_TEST_SUITE_P(Kernels, FloatMarksTest,
                         testing::Values(named(kernels::generate_rays), named(kernels::size_dispatch), named(kernels::trace_closest),
                                         named(kernels::sample_lights_and_bounce), named(kernels::trace_paths),
                                         named(kernels::trace_shadow), named(kernels::accumulate)),
                         test::nameOfParameter);

}  // namespace
}  // namespace glim
