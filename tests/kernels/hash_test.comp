// One thread is one counter, and one of the corners of the conversion to floats.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/hash.glsl"

struct Case {
    uvec4 counter;
    uvec4 hash;    // by the published recurrence
    uint bits;
    float unit;    // floor(bits / 2^8) / 2^24
    uint bin;      // floor(bits * 1000003 / 2^32): with the 24 bits of a float, one bin in sixteen would be missed
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_TRUE(hash4(c.counter) == c.hash);
        EXPECT_EQUAL(unitFloat(c.bits), c.unit);
        EXPECT_TRUE(unitFloat(c.bits) >= 0.0 && unitFloat(c.bits) < 1.0);
        EXPECT_TRUE(unitFloat(uvec2(c.bits, 0u)) == vec2(c.unit, 0.0));
        EXPECT_EQUAL(chooseBin(c.bits, 1000003u), c.bin);
    }
    endTest();
}
