// One thread is one look-up. Results: the value.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/texture.glsl"

struct Case {
    uint textureTexel;
    vec4 uv;
    uint texel;   // of a view
};

struct Result {
    vec4 value;
    uvec4 fetched;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_TRUE(sampleTexture(0u, c.uv) == vec4(1.0));
        results[TEST_THREAD] = Result(sampleTexture(c.textureTexel, c.uv), fetchTexel(c.texel));
    }
    endTest();
}
