// One thread is a path at a surface that its ray has met: where it goes on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/scatter_path.glsl"

struct Case {
    Surface surface;
    PathRay ray;
    PathState state;
};

struct Result {
    uint alive;
    PathRay ray;
    PathState state;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        bool alive = scatterPath(SampleId(pass.seed, TEST_THREAD, 0u), c.state.bounce, c.surface, c.ray, c.state);
        results[TEST_THREAD] = Result(uint(alive), c.ray, c.state);
        EXPECT_TRUE(c.state.bounce < 100u);
    }
    endTest();
}
