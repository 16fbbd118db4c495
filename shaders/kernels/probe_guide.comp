// One thread is one direction. Says how dense the guide's directions are there, as they are seen from one point.
// Reads the guide. Updates the directions.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/guide.glsl"
#include "access/guide_probe.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < pass.directions) {
        Guide guide = fetchGuide(pass.point, pass.normal);
        probed[i].pdf = pdfGuide(guide, probed[i].w);
        probed[i].share = guide.share;
    }
}
