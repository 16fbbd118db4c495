// One thread is one sample of a light from the origin: which light, which part of it, and where that lies. If this light were the
// only choice, the sample would be the same, and its pdf greater by 1 / probability.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light.glsl"

struct Result {
    uint light;
    uint primitive;
    vec3 wi;
    uint lit;
};

layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    uvec4 a = hash4(uvec4(TEST_THREAD, 0u, 0u, render.seed));
    uvec4 b = hash4(uvec4(TEST_THREAD, 1u, 0u, render.seed));
    uint chosen = selectLight(a.xy, render.lightCount);
    EXPECT_TRUE(chosen < render.lightCount);
    LightContext context = LightContext(vec3(0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 1.0, 0.0));
    FlatLight flatLight = fetchLight(chosen);
    LightSample light = sampleLight(flatLight, context, a.zw, unitFloat(b.xy));
    float probability = flatLight.probability;
    flatLight.probability = 1.0;
    LightSample certain = sampleLight(flatLight, context, a.zw, unitFloat(b.xy));
    EXPECT_TRUE(certain.wi == light.wi && certain.target == light.target);
    EXPECT_TRUE(certain.primitive == light.primitive && certain.tMax == light.tMax);
    // At most four products and quotients differ, half an ulp each, in the one and in the other.
    EXPECT_CLOSE(certain.pdf * probability, light.pdf, 5e-7);
    EXPECT_NEAR_VECTOR(certain.radiance, light.radiance * probability, 7e-7 * length(certain.radiance));
    results[TEST_THREAD] = Result(chosen, light.primitive, light.wi, uint(light.radiance != vec3(0.0)));
    endTest();
}
