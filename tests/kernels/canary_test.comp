// One thread is one lane: it counts to its case, and then asks the canary.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { uint cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec2 results[]; };

void main()
{
    if (isTestThread()) {
        uint steps = cases[TEST_THREAD];
        uint counted = 0u;
        uint x = steps;
        for (uint i = 0u; i < steps; ++i) {
            x = x * 1664525u + 1013904223u;  // nothing that a compiler could sum up
            counted += 1u + (x >> 31u) * 0u;
        }
        results[TEST_THREAD] = uvec2(counted, isLoopBudgetSpent(render.canarySteps) ? 1u : 0u);
    }
    report.sentinel = 0u;
    atomicAdd(report.threads, 1u);
}
