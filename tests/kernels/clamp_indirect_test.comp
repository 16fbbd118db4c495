// One thread is one contribution.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/clamp_indirect.glsl"
#include "lib/finite.glsl"

struct Case {
    vec3 contribution;
    uint pathLength;
    float limit;
    vec3 kept;
    float removed;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        ClampedLight light = clampIndirect(c.contribution, c.pathLength, c.limit);
        EXPECT_NEAR_VECTOR(light.kept, c.kept, 4e-7 * length(c.kept));
        EXPECT_NEAR(light.removed, c.removed, 4e-7 * length(c.contribution));
        ClampedLight free = clampIndirect(c.contribution, c.pathLength, kInfinity);
        EXPECT_TRUE(floatBitsToUint(free.kept) == floatBitsToUint(c.contribution));
        EXPECT_EQUAL(free.removed, 0.0);
    }
    endTest();
}
