// One thread is one case.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/warp.glsl"

struct Case {
    float u;
    vec2 point;  // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_NEAR_VECTOR(sampleCircle(c.u), c.point, 4e-7);
    }
    endTest();
}
