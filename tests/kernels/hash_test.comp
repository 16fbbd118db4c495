// One thread is four counters. Result: their hash.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/hash.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uvec4 cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec4 results[]; };

void main()
{
    if (isTestThread()) {
        uvec4 h = hash4(cases[TEST_THREAD]);
        EXPECT_TRUE(unitFloat(h.xy) == vec2(unitFloat(h.x), unitFloat(h.y)));
        // All 2^24 floats, 16 for each of 2^20 threads, from the least and the greatest bits that give them.
        bool right = true;
        for (uint i = 0u; i < 16u; ++i) {
            uint value = (TEST_THREAD * 16u + i) & 0xffffffu;
            float expected = float(value) / 16777216.0;
            right = right && unitFloat(value << 8u) == expected && unitFloat((value << 8u) | 0xffu) == expected;
            right = right && expected >= 0.0 && expected < 1.0;
        }
        EXPECT_TRUE(right);
        EXPECT_TRUE(unitFloat(0xffffffffu - TEST_THREAD % 256u) < 1.0);
        results[TEST_THREAD] = h;
    }
    endTest();
}
