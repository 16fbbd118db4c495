// One thread is one ray and one node.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/intersect_node.glsl"

struct Case {
    uvec4 texels[kNodeTexels];
    vec3 origin, direction;
    float tmax;
    uint nudges;    // three digits to base 5: ulps to add to each reciprocal, + 2; Vulkan allows 2.5 ulp
    uint mustHit;   // bits of the word of hits
    uint mustMiss;
    uint octant;     // expected
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
        EXPECT_EQUAL(rayOctant(exact), c.octant);
        uint hits = intersectChildren(c.texels[0], c.texels[1], c.texels[2], c.texels[3], c.texels[4], c.origin, nudge(exact, c.nudges),
                                      c.octant, c.tmax);
        EXPECT_EQUAL(hits & c.mustHit, c.mustHit);
        EXPECT_EQUAL(hits & c.mustMiss, 0u);
    }
    endTest();
}
