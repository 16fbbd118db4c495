// One thread is one number.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/infinity.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { float cases[]; };

void main()
{
    if (isTestThread()) {
        float x = cases[TEST_THREAD];
        EXPECT_EQUAL(floatBitsToUint(kInfinity), 0x7f800000u);
        EXPECT_TRUE(isinf(kInfinity) && x < kInfinity && -x > -kInfinity);
        EXPECT_TRUE(min(x, kInfinity) == x && kInfinity - x == kInfinity);
    }
    endTest();
}
