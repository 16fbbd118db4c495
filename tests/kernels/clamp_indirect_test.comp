// One thread is one contribution.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/clamp_indirect.glsl"
#include "lib/infinity.glsl"

struct Case {
    vec3 contribution;
    uint events;
    float limit;
    vec3 kept;      // expected
    float removed;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

bool isUntouched(ClampedLight light, vec3 contribution)
{
    return floatBitsToUint(light.kept) == floatBitsToUint(contribution) && light.removed == 0.0;
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        ClampedLight light = clampIndirect(c.contribution, c.events, c.limit);
        float largest = max(c.contribution.r, max(c.contribution.g, c.contribution.b));
        EXPECT_NEAR_VECTOR(light.kept, c.kept, 4e-7 * largest);
        EXPECT_NEAR(light.removed, c.removed, 4e-7 * largest);
        vec3 kept = light.kept;
        EXPECT_TRUE(c.events < 2u || max(kept.r, max(kept.g, kept.b)) <= c.limit * 1.000001);
        EXPECT_TRUE(c.events >= 2u || isUntouched(light, c.contribution));
        EXPECT_TRUE(largest > c.limit || isUntouched(light, c.contribution));
        EXPECT_TRUE(isUntouched(clampIndirect(c.contribution, c.events, kInfinity), c.contribution));
        vec3 whole = light.kept + vec3(light.removed);
        EXPECT_NEAR(whole.r + whole.g + whole.b, c.contribution.r + c.contribution.g + c.contribution.b, 1e-6 * largest);
    }
    endTest();
}
