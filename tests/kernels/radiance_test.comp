// One thread is one path that receives two contributions: a direct and an indirect one.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UPDATES_RADIANCE
#include "access/radiance.glsl"
#include "expect.glsl"

struct Case {
    vec3 direct;
    vec3 indirect;
    vec3 sum;
    float clamped;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        pathRadiance[TEST_THREAD] = PathRadiance(vec3(0.0), 0.0);
        addRadiance(TEST_THREAD, c.direct, 1u);
        addRadiance(TEST_THREAD, c.indirect, 2u);
        EXPECT_NEAR_VECTOR(pathRadiance[TEST_THREAD].radiance, c.sum, 1e-6 * length(c.sum));
        EXPECT_NEAR(pathRadiance[TEST_THREAD].clamped, c.clamped, 1e-6 * length(c.indirect));
    }
    endTest();
}
