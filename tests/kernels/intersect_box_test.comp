// One thread is one ray and one box. Result: where the ray enters.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/intersect_box.glsl"

const uint kMiss = 0u;
const uint kHit = 1u;

struct Case {
    vec3 lo, hi, origin, direction;
    float tmax;
    uint verdict;  // kMiss: by more than the padding; kHit: the true box, exactly; else may be either
    uint nudges;   // three digits to base 5: ulps to add to each reciprocal, + 2; Vulkan allows 2.5 ulp
    float enter;   // expected
    float tolerance;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

vec3 nudge(vec3 v, uint nudges)
{
    ivec3 step = ivec3(nudges % 5u, nudges / 5u % 5u, nudges / 25u % 5u) - 2;
    return intBitsToFloat(floatBitsToInt(v) + step);
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 exact = reciprocalDirection(c.direction);
        EXPECT_TRUE(all(lessThanEqual(abs(exact), vec3(1.0000003e20))) && !any(isnan(exact)));
        EXPECT_TRUE((floatBitsToUint(exact) & 0x80000000u) == (floatBitsToUint(c.direction) & 0x80000000u));
        float enter = intersectBox(c.lo, c.hi, c.origin, nudge(exact, c.nudges), c.tmax);
        EXPECT_TRUE(c.verdict != kHit || enter >= 0.0);
        EXPECT_TRUE(c.verdict != kMiss || enter == -1.0);
        if (c.verdict == kHit) {
            EXPECT_NEAR(enter, c.enter, c.tolerance);
            EXPECT_TRUE(enter <= c.tmax * 1.000001);
        }
    }
    endTest();
}
