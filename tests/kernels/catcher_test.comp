// One thread is one slot of a pass, and where its path is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/catcher.glsl"
#include "access/traverse.glsl"

struct Case {
    uint slot;
    uint bounce;
    float alpha;  // of the first hit
};

struct Result {
    uint pixel, sampleIndex;
    uint sides;
    uint ends;
    uint slots;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SampleId id = makeSampleId(c.slot);
        bool ends = endsAtObject(c.slot, c.bounce, FirstHit(vec3(0.0), c.alpha, vec3(0.0), 0.0));
        results[TEST_THREAD] = Result(id.pixel, id.index, sidesOfRay(c.slot, c.bounce), uint(ends), slotsOfPass());
    }
    endTest();
}
