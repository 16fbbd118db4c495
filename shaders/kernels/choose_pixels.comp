// One thread is one pixel of a slab. Puts it on the list of chosen pixels if it still needs samples.
// Reads the luminance of pixels. Appends to the list, whose count the host has set to 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_LUMINANCE
#define WRITES_CHOSEN_PIXELS
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/stop_rule.glsl"

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount && !isAccurate(filmLuminance[pixel], pass.tolerance, pass.constantSamples)) {
        chosenPixels[atomicAdd(chosenCount, 1u)] = pixel;
    }
    checkLoopBudget(pass.canarySteps);
}
