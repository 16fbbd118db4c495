// H3, H37, H38: what the driver is asked for is in the kernels that the program holds.
#include "kernels.hpp"

#include <gtest/gtest.h>

#include <set>

namespace glim {
namespace {

// SPIR-V specification, sections 3.6, 3.20, 3.49.
constexpr std::uint32_t kOpExecutionMode = 16, kOpDecorate = 71, kNoContraction = 42, kSignedZeroInfNanPreserve = 4461;
constexpr std::uint32_t kOpFNegate = 127, kOpFAdd = 129, kOpFSub = 131, kOpFMul = 133, kOpFDiv = 136, kOpFRem = 140,
                        kOpFMod = 141, kOpVectorTimesScalar = 142, kOpDot = 148;

bool isFloatArithmetic(std::uint32_t opcode)
{
    return opcode == kOpFNegate || opcode == kOpFAdd || opcode == kOpFSub || opcode == kOpFMul || opcode == kOpFDiv ||
           opcode == kOpFRem || opcode == kOpFMod || (opcode >= kOpVectorTimesScalar && opcode <= kOpDot);
}

class FloatMarksTest : public testing::TestWithParam<const EmbeddedShader*> {};

TEST_P(FloatMarksTest, H3H37H38EveryOperationIsExact)
{
    const std::span<const std::uint32_t> words = GetParam()->words();
    std::set<std::uint32_t> marked, arithmetic;
    bool keepsInfinity = false;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t opcode = words[at] & 0xffff;
        if (opcode == kOpDecorate && words[at + 2] == kNoContraction) {
            marked.insert(words[at + 1]);
        }
        keepsInfinity = keepsInfinity ||
                        (opcode == kOpExecutionMode && words[at + 2] == kSignedZeroInfNanPreserve && words[at + 3] == 32);
        if (isFloatArithmetic(opcode)) {
            arithmetic.insert(words[at + 2]);
        }
    }
    EXPECT_TRUE(keepsInfinity);
    EXPECT_EQ(arithmetic, marked);
    EXPECT_EQ(arithmetic.empty(), GetParam() == &kernels::size_dispatch);
}

INSTANTIATE_TEST_SUITE_P(Kernels, FloatMarksTest,
                         testing::Values(&kernels::generate_rays, &kernels::size_dispatch, &kernels::trace_closest,
                                         &kernels::sample_lights, &kernels::bounce, &kernels::trace_shadow,
                                         &kernels::accumulate),
                         [](const auto& kernel) { return std::string(kernel.param->name); });

}  // namespace
}  // namespace glim
