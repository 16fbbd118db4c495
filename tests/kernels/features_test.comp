// One thread. Case bit k is what specialization constant k + kSpecSpheres was set to.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/features.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint bits; };

bool isSet(uint id)
{
    return (bits >> (id - kSpecSpheres) & 1u) != 0u;
}

void main()
{
    EXPECT_TRUE(kSpheres == isSet(kSpecSpheres));
    EXPECT_TRUE(kSmooth == isSet(kSpecSmooth));
    EXPECT_TRUE(kSpecular == isSet(kSpecSpecular));
    EXPECT_TRUE(kSurfaceLights == isSet(kSpecSurfaceLights));
    EXPECT_TRUE(kPunctualLights == isSet(kSpecPunctualLights));
    EXPECT_TRUE(kEnvironment == isSet(kSpecEnvironment));
    EXPECT_TRUE(kSobol == isSet(kSpecSobol));
    EXPECT_TRUE(kMollerTrumbore == isSet(kSpecMollerTrumbore));
    endTest();
}
