// One thread is one choice of a light for one receiver, and a sample of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/light.glsl"

struct Case {
    vec3 p;
    vec3 receiverNormal;
    uint sight;
};

struct Result {
    uint light;
    float probability;
    uint primitive;
    vec3 wi;
    uint lit;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void drawLight(LightContext context)
{
    uvec4 bits = hash4(uvec4(TEST_THREAD, 0u, 0u, render.seed));
    LightChoice choice = chooseLight(context, bits.xy);
    if (choice.probability == 0.0) {
        results[TEST_THREAD] = Result(kNoLightIndex, 0.0, kNoPrimitive, vec3(0.0), 0u);
        return;
    }
    EXPECT_TRUE(choice.light < render.lightCount);
    // To the same bits, or MIS weights of a light that is sampled and of one that is hit do not add up.
    EXPECT_TRUE(choice.probability == computeLightProbability(context, choice.light));
    FlatLight flatLight = fetchLight(choice.light);
    LightSample light = sampleLight(flatLight, choice.probability, context, bits.zw);
    LightSample certain = sampleLight(flatLight, 1.0, context, bits.zw);
    EXPECT_TRUE(certain.wi == light.wi && certain.target == light.target);
    EXPECT_TRUE(certain.primitive == light.primitive && certain.tMax == light.tMax);
    // At most four products and quotients differ, half an ulp each, in the one and in the other.
    EXPECT_CLOSE(certain.pdf * choice.probability, light.pdf, 5e-7);
    EXPECT_NEAR_VECTOR(certain.radiance, light.radiance * choice.probability, 7e-7 * length(certain.radiance));
    results[TEST_THREAD] =
        Result(choice.light, choice.probability, light.primitive, light.wi, uint(light.radiance != vec3(0.0)));
}

// `sampleCount` threads for each receiver.
void main()
{
    Case c = cases[TEST_THREAD / pass.sampleCount];
    drawLight(LightContext(c.p, c.receiverNormal == vec3(0.0) ? vec3(0.0, 1.0, 0.0) : c.receiverNormal, c.receiverNormal, c.sight));
    endTest();
}
