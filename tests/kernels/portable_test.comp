// One thread is one number x, one exponent y and some angles. Result: the functions of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/portable.glsl"

struct Case {
    float x;         // above 0
    float y;
    float exponent;  // of exp2 and exp
    vec2 point;      // whose angle is asked for
    float angle;     // of [-pi/2, pi/2]
};

struct Result {
    float log2, pow, exp2, exp, atan2;
    vec2 cosSin;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_EQUAL(portablePow(c.x, 0.0), 1.0);
        EXPECT_EQUAL(portablePow(0.0, abs(c.y) + 1e-3), 0.0);
        EXPECT_EQUAL(portableExp(0.0), 1.0);
        EXPECT_EQUAL(portableExp(-1e30), 0.0);
        EXPECT_TRUE(floatBitsToUint(portableExp2(-126.25)) == 0u);  // not a denormal number
        EXPECT_TRUE(portableExp(1e30) > 1e38 && portableExp(1e30) < 3.4e38);
        EXPECT_EQUAL(portableAtan2(0.0, 0.0), 0.0);
        EXPECT_EQUAL(portableAtan2(0.0, c.x), 0.0);
        EXPECT_EQUAL(portableAtan2(0.0, -c.x), 3.14159265);
        EXPECT_EQUAL(portableAtan2(c.x, 0.0), 1.57079633);
        EXPECT_EQUAL(portableAtan2(-c.point.y, c.point.x), -portableAtan2(c.point.y, c.point.x));
        EXPECT_EQUAL(portableCosSin(0.0).x, 1.0);
        EXPECT_EQUAL(portableCosSin(0.0).y, 0.0);
        results[TEST_THREAD] = Result(portableLog2(c.x), portablePow(c.x, c.y), portableExp2(c.exponent), portableExp(c.exponent),
                                      portableAtan2(c.point.y, c.point.x), portableCosSin(c.angle));
    }
    endTest();
}
