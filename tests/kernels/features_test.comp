// One thread looks at every specialization constant of the scene's features.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/features.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint expected; };

bool isExpected(uint id)
{
    return (expected >> id & 1u) != 0u;
}

void main()
{
    if (TEST_THREAD == 0u) {
        EXPECT_TRUE(kSpheres == isExpected(kSpecSpheres));
        EXPECT_TRUE(kSmooth == isExpected(kSpecSmooth));
        EXPECT_TRUE(kSpecular == isExpected(kSpecSpecular));
        EXPECT_TRUE(kSurfaceLights == isExpected(kSpecSurfaceLights));
        EXPECT_TRUE(kPunctualLights == isExpected(kSpecPunctualLights));
        EXPECT_TRUE(kEnvironment == isExpected(kSpecEnvironment));
        EXPECT_TRUE(kSobol == isExpected(kSpecSobol));
        EXPECT_TRUE(kMollerTrumbore == isExpected(kSpecMollerTrumbore));
    }
    endTest();
}
