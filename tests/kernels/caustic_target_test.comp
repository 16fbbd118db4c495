// One thread is one target, one emitter, a pair of numbers and a direction to be judged.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/caustic_target.glsl"

struct Case {
    vec4 target;
    Emitter emitter;
    vec2 u;
    vec3 probe;  // unit
};

struct Result {
    vec3 axis;
    float solidAngle, importance;
    uint around;
    vec3 w;
    uint holdsProbe;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        TargetCone cone = makeTargetCone(c.target, c.emitter);
        vec3 w = sampleTargetCone(cone, c.emitter, c.u);
        EXPECT_NEAR(dot(w, w), 1.0, 1e-6);
        results[TEST_THREAD] = Result(cone.axis, cone.solidAngle, cone.importance, uint(cone.around), w, uint(isInCone(cone, c.probe)));
    }
    endTest();
}
