// One thread is one number. Result: what the driver makes of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"

struct Case {
    float x;      // of [-pi, pi]
    float y;      // positive
    float z;      // not zero
    float w;      // of [-1, 1]
};

struct Result {
    float sine, cosine, root, quotient, inverse, arctangent, power;
    float polar, arccosine;  // the angle whose cosine is w, two ways
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float polar = atan(sqrt((1.0 - c.w) * (1.0 + c.w)), c.w);
        results[TEST_THREAD] = Result(sin(c.x), cos(c.x), sqrt(c.y), c.x / c.z, inversesqrt(c.y), atan(c.x, c.z), exp2(c.x), polar,
                                      acos(c.w));
        EXPECT_TRUE(!isnan(sin(c.x)));
    }
    endTest();
}
