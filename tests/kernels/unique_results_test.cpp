// Kernels that make films and pictures use no float instruction whose result Vulkan leaves to the driver, once quotients and roots are
// computed by integers ("Precision and Operation of SPIR-V Instructions").
#include "host/gpu/specialize.hpp"
#include "host/render/film_identity.hpp"
#include "host/spirv/module.hpp"
#include "kernels.hpp"

#include <gtest/gtest.h>

#include <set>

namespace glim::unique_results_test {

using namespace spirv;

// Rounded to nearest: OpFNegate, OpFAdd, OpFSub, OpFMul, OpFDiv, OpVectorTimesScalar.
const std::set<std::uint32_t> kUnique = {127, 129, 131, 133, 136, 142};
// RoundEven, FAbs, SAbs, FSign, SSign, Floor, Ceil, Sqrt, minima and maxima, clamps of integers, FindILsb, FindUMsb.
const std::set<std::uint32_t> kUniqueExtended = {2, 4, 5, 6, 7, 8, 9, 31, 37, 38, 39, 40, 41, 42, 44, 45, 73, 75};

std::string describe(const EmbeddedShader& shader, const Instruction& instruction)
{
    return std::string(shader.name) + ": opcode " + std::to_string(instruction.opcode()) +
           (instruction.opcode() == kOpExtInst ? ", GLSL.std.450 " + std::to_string(instruction.words[4]) : "");
}

TEST(UniqueResults, OfAllKernelsThatMakePictures)
{
    std::vector<EmbeddedShader> shaders = filmKernels();
    shaders.insert(shaders.end(), {kernels::pool_variance, kernels::compare_pixels, kernels::weigh_patches});
    std::size_t quotients = 0;
    for (const EmbeddedShader& shader : shaders) {
        for (const Instruction& instruction : Module(shader.words()).functions) {
            quotients += instruction.opcode() == kOpFDiv;
            if (isFloatArithmetic(instruction.opcode())) {
                EXPECT_EQ(kUnique.count(instruction.opcode()), 1U) << describe(shader, instruction);
            }
            if (instruction.opcode() == kOpExtInst) {
                EXPECT_EQ(kUniqueExtended.count(instruction.words[4]), 1U) << describe(shader, instruction);
            }
        }
    }
    EXPECT_GT(quotients, 300U);
}

// An exact quotient for each component would take a GPU several times as long as one reciprocal.
TEST(UniqueResults, NoVectorIsDividedByANumber)
{
    std::size_t quotients = 0;
    for (const EmbeddedShader& shader : filmKernels()) {
        std::set<Id> splats;
        for (const Instruction& i : Module(shader.words()).functions) {
            if (i.opcode() == kOpCompositeConstruct && std::set<Id>(i.words.begin() + 3, i.words.end()).size() == 1) {
                splats.insert(i.result);
            }
            quotients += i.opcode() == kOpFDiv;
            EXPECT_FALSE(i.opcode() == kOpFDiv && splats.contains(i.words[4])) << describe(shader, i);
        }
    }
    EXPECT_GT(quotients, 300U);
}

// With exact arithmetic the only native quotients and roots are the approximations within lib/exact.glsl.
TEST(UniqueResults, OfQuotientsAndRoots)
{
    const auto countNative = [](const EmbeddedShader& shader, const Arithmetic& arithmetic) {
        std::size_t count = 0;
        for (const Instruction& instruction : Module(specialize(shader, {}, arithmetic)).functions) {
            count += instruction.opcode() == kOpFDiv || instruction.isExtended(kGlslSqrt) || instruction.isExtended(kGlslInverseSqrt);
        }
        return count;
    };
    EXPECT_GT(countNative(kernels::trace_paths, {.exact = false}), 50U);
    EXPECT_EQ(countNative(kernels::trace_paths, {}), 2U);
}

}  // namespace glim::unique_results_test
