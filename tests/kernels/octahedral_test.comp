// One thread is one unit vector. Result: what it is decoded to.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/octahedral.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { vec3 cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec3 results[]; };

void main()
{
    if (isTestThread()) {
        uint code = encodeNormal(cases[TEST_THREAD]);
        vec3 n = decodeNormal(code);
        EXPECT_TRUE(decodeNormal(encodeNormal(n)) == n || distance(decodeNormal(encodeNormal(n)), n) < 7e-5);
        results[TEST_THREAD] = n;
    }
    endTest();
}
