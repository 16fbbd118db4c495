// One thread is one node of the light tree and one receiver. Results: its importance without and with the receiver's normal.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/light_importance.glsl"

struct Case {
    LightNode node;
    vec3 p, n;
    uint isScalable;  // its lengths stay within float's range
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

float importanceAtScale(Case c, float scale)
{
    c.node.center *= scale;
    c.node.radius *= scale;
    return lightImportance(c.node, c.p * scale, c.n) * (scale * scale);
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        float importance = importanceAtScale(c, 1.0);
        if (c.isScalable != 0u) {
            // A power of two rounds nothing.
            EXPECT_EQUAL(importanceAtScale(c, 8192.0), importance);
            EXPECT_EQUAL(importanceAtScale(c, 1.0 / 8192.0), importance);
        }
        results[TEST_THREAD] = vec2(lightImportance(c.node, c.p, vec3(0.0)), importance);
    }
    endTest();
}
