// One thread is one slot of the pass. Puts what --view asks for in the place of the radiance of its path: normals, distances along
// the view axis (0 on a miss), base colours, or visits to inner nodes and tests of primitives by the camera ray.
// Reads the scene, rays, first hits; nothing has bounced. Writes radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RAYS
#define READS_FIRST_HITS
#define WRITES_RADIANCE
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

vec3 stepsOf(PathRay ray)
{
    Steps steps;
    traceClosest(ray, steps);
    return vec3(steps.nodes, steps.primitives, 0.0);
}

vec3 viewOf(uint slot)
{
    if (kView == kViewBvhSteps) {
        return stepsOf(fetchRay(slot));
    }
    FirstHit first = fetchFirstHit(slot);
    if (kView == kViewDepth) {
        return vec3(first.alpha > 0.0 ? first.depth : 0.0);
    }
    return kView == kViewAlbedo ? first.albedo : first.normal;
}

void main()
{
    uint slot = interleavedInvocation();
    if (slot < pass.pixelCount * pass.sampleCount) {
        pathRadiance[slot] = PathRadiance(viewOf(slot), 0.0);
    }
    checkLoopBudget(pass.canarySteps);
}
