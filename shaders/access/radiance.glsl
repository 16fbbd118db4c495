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

// The contribution is one of `samples` that add up to an estimate: the limit of its clamp is divided among them.
PathRadiance addLight(PathRadiance sum, vec3 contribution, uint pathLength, uint samples)
{
    ClampedLight light = clampIndirect(contribution, pathLength, render.clampIndirect / float(samples));
    return PathRadiance(sum.radiance + light.kept, sum.clamped + light.removed);
}

#if defined(UPDATES_RADIANCE)
void addRadiance(uint slot, vec3 contribution, uint pathLength, uint samples)
{
    if (isLengthInRange(pathLength)) {
        pathRadiance[slot] = addLight(fetchRadiance(slot), contribution, pathLength, samples);
    }
}
#endif

#endif
