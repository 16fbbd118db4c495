// What went wrong on the device, counted and located.
#ifndef GLIM_ACCESS_STATUS
#define GLIM_ACCESS_STATUS

#include "lib/canary.glsl"
#include "shared/bindings.h"
#include "shared/path_types.h"

layout(set = 0, binding = kBindStatus, scalar) buffer StatusBuffer { Status status; };

// Every kernel of a pass ends with this.
void checkLoopBudget(uint canarySteps)
{
    if (isLoopBudgetSpent(canarySteps)) {
        atomicAdd(status.loopCaps, 1u);
    }
}

void reportOverflow(uint entries)
{
    if (entries > 0u) {
        atomicAdd(status.overflows, entries);
    }
}

void reportTransparencyCap()
{
    atomicAdd(status.transparencyCaps, 1u);
}

void reportMediaCap()
{
    atomicAdd(status.mediaCaps, 1u);
}

// Of a path with `cut` of its throughput left, in units of kCutUnit.
void reportScatteringCap(uint cut)
{
    atomicAdd(status.scatteringCaps, 1u);
    uint before = atomicAdd(status.cutThroughput.x, cut);
    if (before + cut < before) {
        atomicAdd(status.cutThroughput.y, 1u);
    }
}

void reportSplatOverflow()
{
    atomicAdd(status.splatOverflows, 1u);
}

void reportNonFinite(uint pixel, uint sampleIndex)
{
    uint place = atomicAdd(status.nonFinite, 1u);
    if (place < kMaxLocated) {
        status.located[place] = Located(pixel, sampleIndex);
    }
}

#endif
