// One thread is one pixel of the film's tile, or several where the device has too few threads. Draws the part of the rectangle that the
// pixel covers. If the pixel has no sample yet, the earlier drawing stays (the picture of an earlier camera or of a coarser film), never
// black. Only the fields that `kAov` shows are loaded: on a software driver the loads are this kernel's cost.
// Reads the film. Updates the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/display.glsl"
#include "lib/display.glsl"

// The first pixel of the rectangle that is not left of or above the film's pixel `film`.
uvec2 computeCorner(uvec2 film)
{
    uvec2 size = uvec2(pass.filmWidth, pass.filmHeight);
    return (film * uvec2(pass.width, pass.height) + size - 1u) / size;
}

void drawPixel(uint pixel)
{
    PixelMoments moments = computeShownMoments(pixel);
    if (moments.count == 0u) {
        return;
    }
    vec4 color = drawnColor(moments, kAov, pass);
    uint index = pass.tileBegin + pixel;
    uvec2 film = uvec2(index % pass.filmWidth, index / pass.filmWidth);
    uvec2 low = computeCorner(film);
    uvec2 high = computeCorner(film + 1u);
    for (uint y = low.y; y < high.y; ++y) {
        for (uint x = low.x; x < high.x; ++x) {
            uvec2 at = uvec2(pass.left + x, pass.top + y);
            imageStore(picture, ivec2(at), vec4(overCheckers(color, at), 1.0));
        }
    }
}

void main()
{
    uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint pixel = gl_GlobalInvocationID.x; pixel < pass.tileCount; pixel += threads) {
        drawPixel(pixel);
    }
}
