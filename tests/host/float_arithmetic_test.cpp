// H3, H43: the host rounds products and sums one by one, as its flags ask. Where it does not, the watertight test leaks.
#include "places.h"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"

#include <gtest/gtest.h>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <cfloat>
#include <cmath>
#include <fstream>

#ifdef __FAST_MATH__
#error "-ffast-math lets the compiler drop NaN, infinities and the order of operations"
#endif

namespace glim {
namespace {

TEST(FloatArithmeticTest, H43EveryFileIsCompiledExactly)
{
    static_assert(FLT_EVAL_METHOD == 0);
    std::ifstream file(GLIM_BUILD_DIR "/compile_commands.json");
    const nlohmann::json commands = nlohmann::json::parse(file);
    int inexact = 0;
    for (const nlohmann::json& entry : commands) {
        const std::string command = entry.at("command");
        inexact += command.find("-ffp-contract=off") == std::string::npos ? 1 : 0;
        inexact += command.find("-ffast-math") == std::string::npos && command.find("-Ofast") == std::string::npos ? 0 : 1;
    }
    EXPECT_GT(commands.size(), 100U);
    EXPECT_EQ(inexact, 0);
    printHardCase("H43", "compiler flags", static_cast<double>(commands.size()), "all files with -ffp-contract=off");
}

// a b - c d, each product rounded, or the first one not.
float difference(float a, float b, float c, float d, bool fused) { return fused ? std::fma(a, b, -(c * d)) : a * b - c * d; }

// Woop's three edge functions for a ray along +z through the origin.
bool isHit(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c, bool fused)
{
    const float u = difference(c.x, b.y, c.y, b.x, fused), v = difference(a.x, c.y, a.y, c.x, fused),
                w = difference(b.x, a.y, b.y, a.x, fused);
    return (u >= 0.0F && v >= 0.0F && w >= 0.0F) || (u <= 0.0F && v <= 0.0F && w <= 0.0F);
}

// Two triangles on either side of an edge. The ray meets the edge as exactly as floats can say.
TEST(FloatArithmeticTest, H3FusedProductsLeak)
{
    Random random(3);
    int leaks[2] = {0, 0};
    const int rays = static_cast<int>(hardTrials(200000));
    for (int i = 0; i < rays; ++i) {
        const glm::dvec2 along = glm::normalize(glm::dvec2(random.normal(), random.normal())), across(-along.y, along.x);
        const glm::vec2 from = -random.uniform(0.1, 1.0) * along, to = random.uniform(0.1, 1.0) * along;
        const glm::vec2 left = random.uniform(0.3, 1.0) * across, right = -random.uniform(0.3, 1.0) * across;
        for (const bool fused : {false, true}) {
            leaks[fused ? 1 : 0] += isHit(from, to, left, fused) || isHit(to, from, right, fused) ? 0 : 1;
        }
    }
    printHardCase("H3", "two triangles at an edge", rays, "leaks " + std::to_string(leaks[0]),
                  "one product fused: " + std::to_string(leaks[1]) + " leaks");
    EXPECT_EQ(leaks[0], 0);
    EXPECT_GT(leaks[1], 0);
}

}  // namespace
}  // namespace glim
