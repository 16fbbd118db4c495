// Adds light to a path. Needs UPDATES_RADIANCE.
#ifndef GLIM_ACCESS_RADIANCE
#define GLIM_ACCESS_RADIANCE

#include "lib/clamp_indirect.glsl"
#include "paths.glsl"

// `events`: surfaces met between camera and light; light with fewer or more than the pass wants is dropped. The contribution is
// one of `samples` that make up an estimate, and is clamped as such.
void addRadiance(uint slot, vec3 contribution, uint events, uint samples)
{
    if (events < pass.leastEvents || events > pass.mostEvents) {
        return;
    }
    ClampedLight light = clampIndirect(contribution, events, pass.clampIndirect / float(samples));
    PathRadiance sum = fetchRadiance(slot);
    pathRadiance[slot] = PathRadiance(sum.radiance + light.kept, sum.clamped + light.removed);
}

#endif
