// Adds light to a path.
#ifndef GLIM_ACCESS_RADIANCE
#define GLIM_ACCESS_RADIANCE

#include "lib/clamp_indirect.glsl"
#include "paths.glsl"

// `pathLength`: surfaces met between camera and light; light with fewer or more than the render wants is dropped.
bool isLengthInRange(uint pathLength)
{
    return pathLength >= render.minPathLength && pathLength <= render.maxPathLength;
}

PathRadiance addLight(PathRadiance sum, vec3 contribution, uint pathLength, float clampLimit)
{
    ClampedLight light = clampIndirect(contribution, pathLength, clampLimit);
    return PathRadiance(sum.radiance + light.kept, sum.clamped + light.removed);
}

#if defined(UPDATES_RADIANCE)
void addRadiance(uint slot, vec3 contribution, uint pathLength)
{
    if (isLengthInRange(pathLength)) {
        storeRadiance(slot, addLight(fetchRadiance(slot), contribution, pathLength, render.clampIndirect));
    }
}
#endif

#endif
