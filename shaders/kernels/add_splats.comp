// One thread is one pixel of a band, or one of a light group. Adds what light paths have brought in a pass to the block's sums, and empties the pass's. A pass that
// was stopped is emptied instead, so that the block has whole samples.
// Updates splats and the block's sums of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#define UPDATES_BLOCK_SPLATS
#include "access/splats.glsl"
#include "lib/add64.glsl"

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount) {
        Splat sum = blockSplats[pixel], more = splats[pixel];
        blockSplats[pixel] =
            Splat(add64(sum.red, more.red), add64(sum.green, more.green), add64(sum.blue, more.blue), add64(sum.clamped, more.clamped));
        splats[pixel] = Splat(uvec2(0u), uvec2(0u), uvec2(0u), uvec2(0u));
    }
    checkLoopBudget(render.canarySteps);
}
