// One thread is one slot of the pass. Replaces the radiance of its path by what --view asks for: normals, distances along
// the view axis (0 on a miss), base colours, or visits to inner nodes and tests of primitives by the camera ray.
// Reads the scene, rays, first hits; nothing has bounced. Writes radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_RAYS
#define READS_FIRST_HITS
#define WRITES_RADIANCE
#include "access/path_time.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

vec3 countSteps(PathRay ray)
{
    Steps steps = Steps(0u, 0u);
    traceClosest(ray, unrestrictedQuery(), steps);
    return vec3(steps.nodes, steps.primitives, 0.0);
}

vec3 getAov(uint slot)
{
    if (kAov == kAovBvhSteps) {
        beginPath(makeSampleId(slot));
        return countSteps(fetchRay(slot));
    }
    FirstHit first = fetchFirstHit(slot);
    if (kAov == kAovDepth) {
        return vec3(first.alpha > 0.0 ? first.depth : 0.0);
    }
    return kAov == kAovAlbedo ? first.albedo : first.normal;
}

void main()
{
    uint slot = interleavedInvocation();
    if (slot < samplesOfPass()) {
        storeRadiance(slot, PathRadiance(getAov(slot), 0.0));
    }
    checkLoopBudget(render.canarySteps);
}
