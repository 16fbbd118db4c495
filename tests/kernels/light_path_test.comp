// One thread is the begin of one light path, and the choice of a light by a random word.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light_path.glsl"

struct Result {
    PathRay ray;
    vec3 flux;
    float range;
    uint light;
    float probability;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint words[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        uint group;
        LightRay light = sampleEmission(lightPathId(render.seed, TEST_THREAD, 0u), group);
        LightChoice choice = chooseCausticLight(words[TEST_THREAD]);
        results[TEST_THREAD] = Result(light.ray, light.flux, light.range, choice.light, choice.probability);
        EXPECT_TRUE(light.flux == vec3(0.0) || abs(dot(light.ray.direction, light.ray.direction) - 1.0) < 1e-6);
    }
    endTest();
}
