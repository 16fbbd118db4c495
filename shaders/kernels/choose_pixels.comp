// One thread is one pixel of a slab. Puts it on the list of chosen pixels if it still needs samples.
// Reads the luminance of pixels. Appends to the list, whose count the host has set to 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_LUMINANCE
#define WRITES_CHOSEN_PIXELS
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/stop_rule.glsl"

// No camera ray of the pixel has met a surface. A pixel of another slab is not known, and counts as if.
bool hasMetNothing(ivec2 at)
{
    if (at.x < 0 || at.y < 0 || at.x >= int(pass.width) || at.y >= int(pass.height)) {
        return true;
    }
    uint pixel = uint(at.y) * pass.width + uint(at.x) - pass.slabBegin;
    return pixel < pass.pixelCount && filmLuminance[pixel].met == 0u;
}

// Nothing is there to be seen: neither in the pixel nor in its eight neighbours.
bool isEmpty(uint pixel)
{
    uint index = pass.slabBegin + pixel;
    ivec2 at = ivec2(index % pass.width, index / pass.width);
    bool empty = filmLuminance[pixel].count > 1u;
    for (int i = 0; i < 9; ++i) {
        empty = empty && hasMetNothing(at + ivec2(i % 3 - 1, i / 3 - 1));
    }
    return empty;
}

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount && !isAccurate(filmLuminance[pixel], pass.tolerance, pass.constantSamples) && !isEmpty(pixel)) {
        chosenPixels[atomicAdd(chosenCount, 1u)] = ChosenPixel(pixel, 0u);
    }
    checkLoopBudget(pass.canarySteps);
}
