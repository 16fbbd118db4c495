// One thread is one sample, some of which are not finite; thread 0 may also use up the loops that the driver allows.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/status.glsl"

struct Case {
    uint isBad;
    uint loops;
};

struct Result {
    uint loopsRun;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        if (c.isBad != 0u) {
            reportNonFinite(TEST_THREAD, 2u * TEST_THREAD + 1u);
        }
        uint done = 0u;
        for (uint i = 0u; i < c.loops; ++i) {
            done += 1u + (i >> 30u);
        }
        results[TEST_THREAD] = Result(done);
        EXPECT_TRUE(done <= c.loops);
    }
    checkLoopBudget(render.canarySteps);
    endTest();
}
