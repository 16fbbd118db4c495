// One thread is one slot of a pass; every slot must be somebody's.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/pass.glsl"
#include "expect.glsl"

layout(set = 0, binding = kBindResults, scalar) buffer Results { uint visits[]; };

void main()
{
    uint slot = interleavedInvocation();
    if (slot < pass.pixelCount * pass.sampleCount) {
        atomicAdd(visits[slot], 1u);
        SampleId id = sampleOfSlot(slot);
        EXPECT_EQUAL(id.pixel, pass.slabBegin + pass.firstPixel + slot / pass.sampleCount);
        EXPECT_EQUAL(id.index, pass.firstSample + slot % pass.sampleCount);
        EXPECT_EQUAL(id.seed, pass.seed);
    }
    endTest();
}
