// Adds light to a path.
#ifndef GLIM_ACCESS_RADIANCE
#define GLIM_ACCESS_RADIANCE

#include "lib/clamp_indirect.glsl"
#if defined(UPDATES_GROUP_LIGHT)
#include "light_groups.glsl"
#endif
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

#if defined(UPDATES_GROUP_LIGHT)
// Beside addRadiance. The second paths of shadow catchers have no groups.
void addToGroup(uint slot, uint group, vec3 contribution, uint pathLength)
{
    if (isLengthInRange(pathLength) && slot < samplesOfPass() && any(notEqual(contribution, vec3(0.0)))) {
        vec3 kept = clampIndirect(contribution, pathLength, render.clampIndirect).kept;
        storeGroupLight(slot, group, fetchGroupLight(slot, group) + kept);
    }
}
#endif

#endif
