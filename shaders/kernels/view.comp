// One thread is one pixel of the band, or several where the device has too few threads. Colours it by the film's pixel at that place.
// Reads pixels of one or two films. Updates the picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/view.glsl"
#include "lib/display.glsl"

const vec3 kAroundFilm = vec3(0.2);

vec3 colorAt(uvec2 at, uint index)
{
    if (at.x < pass.left || at.x >= pass.right || at.y < pass.top || at.y >= pass.bottom) {
        return kAroundFilm;
    }
    bool needsReference = pass.shownAs == kShownAsDifference || pass.shownAs == kShownAsSurfaces;
    return viewColor(viewed[index], needsReference ? referenceValues[index] : vec3(0.0), at, pass);
}

void main()
{
    uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint index = gl_GlobalInvocationID.x; index < pass.width * pass.rows; index += threads) {
        uvec2 at = uvec2(index % pass.width, pass.firstRow + index / pass.width);
        imageStore(picture, ivec2(at), vec4(colorAt(at, index), 1.0));
    }
}
