// One thread is one index and its seeds. Results: the plain and the scrambled point.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/sobol.glsl"

struct Case {
    uint index;
    uvec3 seeds;
    uvec2 point;  // expected, unscrambled
    uint keep;    // bits, from the top, in which `other` agrees with `index`; less than 32
    uint other;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_TRUE(sobolPoint(c.index) == c.point);
        // Owen's scramble: a digit depends on the digits above it and no others, so equal beginnings stay equal, and the
        // first different digit stays different.
        uint apart = scrambleOwen(c.index, c.seeds.x) ^ scrambleOwen(c.other, c.seeds.x);
        EXPECT_EQUAL(findMSB(apart), 31 - int(c.keep));
        EXPECT_EQUAL(findMSB(c.index ^ c.other), 31 - int(c.keep));
        results[TEST_THREAD] = scrambledSobolPoint(c.index, c.seeds);
    }
    endTest();
}
