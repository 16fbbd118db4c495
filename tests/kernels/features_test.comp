// One thread looks at every specialization constant of scene and render.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/features.glsl"

struct Case {
    uint on;  // one bit per id
    uint direct, roulette, view, stackLevels;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case expected; };

bool isExpected(uint id)
{
    return (expected.on >> id & 1u) != 0u;
}

void main()
{
    if (TEST_THREAD == 0u) {
        EXPECT_TRUE(kSpheres == isExpected(kSpecSpheres));
        EXPECT_TRUE(kSlivers == isExpected(kSpecSlivers));
        EXPECT_TRUE(kSmooth == isExpected(kSpecSmooth));
        EXPECT_TRUE(kMirrors == isExpected(kSpecMirrors));
        EXPECT_TRUE(kGlasses == isExpected(kSpecGlasses));
        EXPECT_TRUE(kTriangleLights == isExpected(kSpecTriangleLights));
        EXPECT_TRUE(kSphereLights == isExpected(kSpecSphereLights));
        EXPECT_TRUE(kPunctualLights == isExpected(kSpecPunctualLights));
        EXPECT_TRUE(kEnvironment == isExpected(kSpecEnvironment));
        EXPECT_TRUE(kSobol == isExpected(kSpecSobol));
        EXPECT_TRUE(kMollerTrumbore == isExpected(kSpecMollerTrumbore));
        EXPECT_TRUE(kBruteForce == isExpected(kSpecBruteForce));
        EXPECT_TRUE(kLens == isExpected(kSpecLens));
        EXPECT_TRUE(kChosen == isExpected(kSpecChosen));
        EXPECT_TRUE(kSuspects == isExpected(kSpecSuspects));
        EXPECT_TRUE(kNotes == isExpected(kSpecNotes));
        EXPECT_TRUE(kLuminance == isExpected(kSpecLuminance));
        EXPECT_EQUAL(kDirect, expected.direct);
        EXPECT_EQUAL(kRoulette, expected.roulette);
        EXPECT_EQUAL(kView, expected.view);
        EXPECT_EQUAL(kStackLevels, expected.stackLevels);
    }
    endTest();
}
