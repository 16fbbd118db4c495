// What a learning path writes down: kGuideRecords for each slot. A record is open until the path has met the next surface that scatters in
// many directions, and then until the light sample there has come back. Numbers of records are kept in place of the path's radiance, from 1
// on, so that paths can be put aside.
#ifndef GLIM_ACCESS_GUIDE_RECORDS
#define GLIM_ACCESS_GUIDE_RECORDS

#include "lib/octahedral.glsl"
#include "shared/bindings.h"
#include "shared/guide_types.h"
#include "shared/luminance.h"

layout(set = 0, binding = kBindGuideRecords, scalar) buffer GuideRecordsBuffer { GuideRecord guideRecords[]; };

uint recordAt(uint slot, float number)
{
    return slot * kGuideRecords + uint(number) - 1u;
}

uint packDirect(float luminance, uint lights, bool arrived)
{
    return (floatBitsToUint(luminance) & ~(kSampledLights | kSampleBlocked)) | lights | (arrived ? 0u : kSampleBlocked);
}

void clearRecords(uint slot)
{
    for (uint i = 0u; i < kGuideRecords; ++i) {
        guideRecords[slot * kGuideRecords + i].throughput = 0.0;
    }
}

// Light that the ray of record `number` has brought.
void addToRecord(uint slot, float number, vec3 light)
{
    if (number > 0.0) {
        guideRecords[recordAt(slot, number)].value += computeLuminance(light);
    }
}

// The light sample of its vertex has arrived.
void addDirect(uint slot, float number, vec3 light)
{
    if (number > 0.0) {
        uint at = recordAt(slot, number);
        guideRecords[at].direct = packDirect(computeLuminance(light), guideRecords[at].direct & kSampledLights, true);
    }
}

#endif
