// One thread is one pixel of the window's picture, or several where the device has too few threads. Draws what the film knows
// there; where it has no sample yet, what was drawn before stays: an earlier camera's picture or a coarser film's, never black.
// Reads the film. Updates the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/display.glsl"
#include "lib/display.glsl"

void drawPixel(uvec2 at)
{
    uvec2 film = at * uvec2(pass.filmWidth, pass.filmHeight) / uvec2(pass.width, pass.height);
    uint pixel = film.y * pass.filmWidth + film.x - pass.slabBegin;
    if (pixel < pass.slabCount) {
        PixelMoments moments = momentsOfPixel(pixel);
        if (moments.count > 0u) {
            imageStore(picture, ivec2(at), vec4(displayColor(moments, pass), 1.0));
        }
    }
}

void main()
{
    uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint id = gl_GlobalInvocationID.x; id < pass.width * pass.height; id += threads) {
        drawPixel(uvec2(id % pass.width, id / pass.width));
    }
}
