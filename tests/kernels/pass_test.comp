// One thread is one invocation of a dispatch; it marks its place in the order of work, and asks for its sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"

struct Case {
    uint seed, pixel, index;
};

struct Result {
    uint visits;
    uint group;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) buffer Results { Result results[]; };

void main()
{
    uint place = interleavedInvocation();
    EXPECT_TRUE(place < gl_NumWorkGroups.x * gl_WorkGroupSize.x);
    atomicAdd(results[place].visits, 1u);
    results[place].group = gl_WorkGroupID.x;
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SampleId id = makeSampleId(TEST_THREAD);
        EXPECT_EQUAL(id.seed, c.seed);
        EXPECT_EQUAL(id.pixel, c.pixel);
        EXPECT_EQUAL(id.index, c.index);
    }
    endTest();
}
