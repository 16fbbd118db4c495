// Adds light to a path.
#ifndef GLIM_ACCESS_RADIANCE
#define GLIM_ACCESS_RADIANCE

#include "lib/clamp_indirect.glsl"
#include "paths.glsl"

// `events`: surfaces met between camera and light; light with fewer or more than the pass wants is dropped.
bool isWanted(uint events)
{
    return events >= pass.leastEvents && events <= pass.mostEvents;
}

// The contribution is one of `samples` that make up an estimate, and is clamped as such.
PathRadiance addLight(PathRadiance sum, vec3 contribution, uint events, uint samples)
{
    ClampedLight light = clampIndirect(contribution, events, pass.clampIndirect / float(samples));
    return PathRadiance(sum.radiance + light.kept, sum.clamped + light.removed);
}

#if defined(UPDATES_RADIANCE)
void addRadiance(uint slot, vec3 contribution, uint events, uint samples)
{
    if (isWanted(events)) {
        pathRadiance[slot] = addLight(fetchRadiance(slot), contribution, events, samples);
    }
}
#endif

#endif
