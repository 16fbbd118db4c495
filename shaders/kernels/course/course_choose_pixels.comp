// One thread is one pixel of a tile. Puts it on the list of chosen pixels if it has all of the first pass.firstSample samples and still
// needs more. So a pixel that has been left out once stays out, even if a neighbour meets a surface later: the samples of every pixel are
// the first ones, without a gap. A pixel with a sample that was not finite stays out too.
// Reads the luminance of pixels. Appends to the list, whose count the host has set to 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_LUMINANCE
#define WRITES_CHOSEN_PIXELS
#include "access/course/round.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/course/stop_rule.glsl"

// No camera ray of the pixel has met a surface. True outside the picture; false in another tile, which is not known.
bool hasMetNothing(ivec2 at)
{
    if (at.x < 0 || at.y < 0 || at.x >= int(render.width) || at.y >= int(render.height)) {
        return true;
    }
    uint pixel = uint(at.y) * render.width + uint(at.x) - pass.tileBegin;
    return pixel < pass.pixelCount && filmLuminance[pixel].met == 0u;
}

// No surface is in sight, neither in the pixel nor in its eight neighbours.
bool isEmpty(uint pixel)
{
    uint index = pass.tileBegin + pixel;
    ivec2 at = ivec2(index % render.width, index / render.width);
    bool empty = filmLuminance[pixel].count > 1u;
    for (int i = 0; i < 9; ++i) {
        empty = empty && hasMetNothing(at + ivec2(i % 3 - 1, i / 3 - 1));
    }
    return empty;
}

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount && filmLuminance[pixel].count >= pass.firstSample &&
        !isAccurate(filmLuminance[pixel], course.tolerance, course.constantSamples) && !isEmpty(pixel)) {
        chosenPixels[atomicAdd(chosenCount, 1u)] = ChosenPixel(pixel, 0u);
    }
    checkLoopBudget(render.canarySteps);
}
