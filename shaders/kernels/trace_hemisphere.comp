// One thread is one entry of the shadow queue, filled by sample_hemisphere. Adds what its ray meets, if that shines. Brute force
// takes several dispatches: the ray notes what it met so far, and the last dispatch adds the light.
// Reads the scene, the shadow queue, shadow rays (brute force also writes them). Updates radiance.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_SHADOW_QUEUE
#define READS_QUEUE_SIZES
#define UPDATES_SHADOW_RAYS
#define UPDATES_RADIANCE
#include "access/radiance.glsl"
#include "access/scan.glsl"
#include "access/status.glsl"
#include "access/surface.glsl"

vec3 radianceFound(PathRay ray, PathHit hit)
{
    if (hit.record == kNoRecord) {
        return kEnvironment ? pass.environment : vec3(0.0);
    }
    Surface surface = surfaceAt(ray, hit);
    return emittedRadiance(surface, fetchMaterial(surface.material));
}

// Without barycentric coordinates, which emission does not depend on.
PathHit scanRecords(uint slot, PathRay ray, ShadowRay soFar)
{
    PathHit hit = scanClosest(ray, PathHit(soFar.target, soFar.reach, vec2(0.0)), pass.firstRecord, pass.endRecord);
    pathShadowRays[slot].target = hit.record;
    pathShadowRays[slot].reach = hit.t;
    return hit;
}

void visit(uint slot)
{
    ShadowRay shadow = fetchShadowRay(slot);
    PathRay ray = PathRay(shadow.origin, shadow.source, shadow.direction, 0u);
    PathHit hit = kBruteForce ? scanRecords(slot, ray, shadow) : traceClosest(ray);
    if (pass.endRecord == pass.recordCount) {
        addRadiance(slot, shadow.contribution * radianceFound(ray, hit), pass.bounce + 1u, pass.lightSamples);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry < queueSizes.shadow) {
        visit(shadowQueue[entry]);
    }
    checkLoopBudget(pass.canarySteps);
}
