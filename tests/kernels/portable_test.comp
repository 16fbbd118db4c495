// One thread is one number x and one exponent y. Result: the functions of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/portable.glsl"

struct Case {
    float x;         // above 0
    float y;
    float exponent;  // of exp2 and exp
};

struct Result {
    float log2, pow, exp2, exp;
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
        EXPECT_TRUE(portableExp(1e30) > 1e38 && portableExp(1e30) < 3.4e38);
        results[TEST_THREAD] = Result(portableLog2(c.x), portablePow(c.x, c.y), portableExp2(c.exponent), portableExp(c.exponent));
    }
    endTest();
}
