// One thread is one pixel of the window's picture, or several where the device has too few threads. Draws the text over it.
// Reads the picture and the text. Writes what is shown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/display.glsl"
#include "lib/display.glsl"

void coverPixel(uvec2 at)
{
    vec3 color = imageLoad(picture, ivec2(at)).rgb;
    if (at.x < pass.textWidth && at.y < pass.textHeight) {
        uint text = textPixels[at.y * pass.textWidth + at.x];
        vec2 brightnessOpacity = vec2(text & 255u, text >> 8u & 255u) / 255.0;
        color = mix(color, vec3(brightnessOpacity.x), brightnessOpacity.y);
    }
    imageStore(shown, ivec2(at), vec4(roundToBytes(color), 1.0));
}

void main()
{
    uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint id = gl_GlobalInvocationID.x; id < pass.width * pass.height; id += threads) {
        coverPixel(uvec2(id % pass.width, id / pass.width));
    }
}
