// One thread.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/finite.glsl"

void main()
{
    EXPECT_TRUE(floatBitsToUint(kInfinity) == 0x7f800000u);
    EXPECT_TRUE(kInfinity > 3.4028234e38);
    endTest();
}
