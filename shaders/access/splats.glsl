// Adds light to the pixels that a light path has found, in fixed point.
#ifndef GLIM_ACCESS_SPLATS
#define GLIM_ACCESS_SPLATS

#include "lib/clamp_indirect.glsl"
#include "lib/finite.glsl"
#include "pass.glsl"
#include "status.glsl"

// The picture's pixels from Pass::tileBegin on; of each light group, if the film has groups.
layout(set = 0, binding = kBindSplats, scalar) buffer SplatsBuffer { Splat splats[]; };

#if defined(UPDATES_BLOCK_SPLATS)
layout(set = 0, binding = kBindBlocks, scalar) buffer BlockSplatsBuffer { Splat blockSplats[]; };
#endif

const float kMaxUnits = 4611686018427387904.0;  // 2^62

// Adds a number of units below kMaxUnits.
#define ADD_UNITS(sum, units) \
    { \
        float rounded = roundEven(units); \
        uint high = uint(rounded * (1.0 / 4294967296.0)); \
        uint low = uint(rounded - float(high) * 4294967296.0); \
        if (low != 0u) { \
            uint before = atomicAdd(sum.x, low); \
            high += before + low < before ? 1u : 0u; \
        } \
        if (high != 0u) { \
            uint before = atomicAdd(sum.y, high); \
            if (before + high < before || before + high > mostHigh) { \
                reportSplatOverflow(); \
            } \
        } \
    }

// contribution: to a sample of the picture's pixel. pathLength: surfaces met between camera and light. group: of lights. ratio: of what a
// camera path would have brought, of interest with comparesPaths.
void addSplat(uint pixel, uint sampleIndex, vec3 contribution, uint pathLength, uint group, float ratio)
{
    uint pixels = uint(splats.length()) / max(render.lightGroups, 1u), at = pixel - pass.tileBegin;
    if (pixel < pass.tileBegin || at >= pixels) {
        return;
    }
    at += group * pixels;
    if (!isFinite(contribution)) {
        reportNonFinite(pixel, sampleIndex);
        return;
    }
    ClampedLight light = clampIndirect(contribution, pathLength, render.clampIndirect);
    vec3 units = light.kept * render.splatScale;
    uint mostHigh = 0xffffffffu / max(render.lightGroups, 1u);  // what all groups have together must fit too
    float removed = light.removed * render.splatScale;
    if (render.comparesPaths != 0u) {
        vec3 scaled = contribution * render.splatScale;
        removed = min(dot(scaled, scaled) * (1.0 / 3.0) * ratio * kComparedShare, 0.5 * kMaxUnits);
    }
    if (!(max(max(units.r, units.g), max(units.b, removed)) < kMaxUnits)) {
        reportSplatOverflow();
        return;
    }
    ADD_UNITS(splats[at].red, units.r)
    ADD_UNITS(splats[at].green, units.g)
    ADD_UNITS(splats[at].blue, units.b)
    if (removed > 0.0) {
        ADD_UNITS(splats[at].clamped, removed)
    }
}

#endif
