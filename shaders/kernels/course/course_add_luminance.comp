// One thread is one pixel of the pass. Adds its finished samples, in the order of their index, to the luminance moments that the course's
// adaptive rule uses. Samples that are not finite are left out. Does nothing while a path is alive.
// Reads radiance, first hits, rounds. Updates luminance.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RADIANCE
#define READS_FIRST_HITS
#define READS_ROUNDS
#define UPDATES_LUMINANCE
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/finite.glsl"
#include "lib/course/stop_rule.glsl"

void main()
{
    uint pixel = interleavedInvocation();
    if (pixel < pass.pixelCount && activePaths() == 0u) {
        uint at = getPassPixel(pixel);
        LuminanceMoments moments = filmLuminance[at];
        for (uint i = 0u; i < pass.sampleCount; ++i) {
            uint slot = pixel * pass.sampleCount + i;
            vec3 radiance = fetchRadiance(slot).radiance;
            if (isFinite(radiance)) {
                moments = addLuminance(moments, computeLuminance(radiance), fetchFirstHit(slot).alpha > 0.0);
            }
        }
        filmLuminance[at] = moments;
    }
    checkLoopBudget(render.canarySteps);
}
