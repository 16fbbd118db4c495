// One thread is one sample of a light from the origin: which one, which part of it, and where it lies.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light.glsl"

struct Result {
    uint light;
    uint record;
    vec3 wi;
};

layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    uvec4 a = hash4(uvec4(TEST_THREAD, 0u, 0u, pass.seed));
    uvec4 b = hash4(uvec4(TEST_THREAD, 1u, 0u, pass.seed));
    uint chosen = chooseLight(a.xy, pass.lightCount);
    EXPECT_TRUE(chosen < pass.lightCount);
    LightSample light = sampleLight(chosen, false, vec3(0.0), vec3(0.0, 1.0, 0.0), a.zw, unitFloat(b.xy));
    results[TEST_THREAD] = Result(chosen, light.record, light.wi);
    endTest();
}
