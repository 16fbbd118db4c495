// One thread looks at every specialization constant of scene and render.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/features.glsl"

struct Case {
    FeatureMask features;
    uint on;  // one bit per id
    uint aov, stackLevels, unused;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case expected; };

bool isExpected(uint id)
{
    return (expected.on >> id & 1u) != 0u;
}

bool isNeeded(FeatureMask feature)
{
    return (expected.features & feature) != FeatureMask(0u);
}

void main()
{
    if (TEST_THREAD == 0u) {
        for (uint bit = 0u; bit < 32u; ++bit) {
            FeatureMask lower = FeatureMask(1u << bit, 0u), upper = FeatureMask(0u, 1u << bit);
            EXPECT_TRUE(hasFeature(lower) == isNeeded(lower));
            EXPECT_TRUE(hasFeature(upper) == isNeeded(upper));
        }
        EXPECT_TRUE(kSobol == isExpected(kSpecSobol));
        EXPECT_TRUE(kLens == isExpected(kSpecLens));
        EXPECT_TRUE(kChosen == isExpected(kSpecChosen));
        EXPECT_TRUE(kSuspects == isExpected(kSpecSuspects));
        EXPECT_TRUE(kNotes == isExpected(kSpecNotes));
        EXPECT_EQUAL(kAov, expected.aov);
        EXPECT_EQUAL(kStackLevels, expected.stackLevels);
    }
    endTest();
}
