// One thread is one ray and one capsule. Result: t.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/intersect_capsule.glsl"

struct Case {
    vec3 origin, direction, base, axis;
    float radius, tmax;
    uint onSurface;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { float results[]; };

float intersectUpTo(Case c, float tmax)
{
    return intersectCapsule(c.origin, c.direction, c.base, c.axis, c.radius, tmax, c.onSurface != 0u);
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float t = intersectUpTo(c, c.tmax);
        EXPECT_TRUE(t == -1.0 || (t > 0.0 && t <= c.tmax));
        EXPECT_TRUE(t < 0.0 || intersectUpTo(c, t) == t);
        EXPECT_TRUE(t < 2.0e-38 || intersectUpTo(c, uintBitsToFloat(floatBitsToUint(t) - 1u)) == -1.0);
        results[TEST_THREAD] = t;
    }
    endTest();
}
