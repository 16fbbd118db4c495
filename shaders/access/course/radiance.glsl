// Adds one of the light samples of a round.
#ifndef GLIM_ACCESS_COURSE_RADIANCE
#define GLIM_ACCESS_COURSE_RADIANCE

#include "access/course/round.glsl"
#include "access/radiance.glsl"

// The contribution is one of lightSamples that add up to an estimate: the limit of the clamp is divided among them.
void addShareOfRadiance(uint slot, vec3 contribution, uint pathLength)
{
    if (isLengthInRange(pathLength)) {
        float limit = render.clampIndirect / float(lightRound.lightSamples);
        storeRadiance(slot, addLight(fetchRadiance(slot), contribution, pathLength, limit));
    }
}

#endif
