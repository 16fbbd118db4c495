// One thread looks at every specialization constant of the course.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/course/round.glsl"
#include "expect.glsl"

struct Case {
    uint mollerTrumbore, bruteForce, direct, roulette;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case expected; };

void main()
{
    if (TEST_THREAD == 0u) {
        EXPECT_EQUAL(uint(kMollerTrumbore), expected.mollerTrumbore);
        EXPECT_EQUAL(uint(kBruteForce), expected.bruteForce);
        EXPECT_EQUAL(kDirect, expected.direct);
        EXPECT_EQUAL(kRoulette, expected.roulette);
    }
    endTest();
}
