// One thread is one entry of the shadow queue, filled by course_sample_hemisphere. Adds what its ray meets, if that emits. Brute force
// takes several dispatches: target and tMax of the ray hold the closest hit so far, and the last dispatch adds the light.
// Reads the scene, the shadow queue, shadow rays (brute force also writes them). Updates radiance, ray counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_SHADOW_QUEUE
#define READS_ROUNDS
#define UPDATES_SHADOW_RAYS
#define UPDATES_RADIANCE
#define UPDATES_RAY_COUNTS
#include "access/course/round.glsl"
#include "access/course/radiance.glsl"
#include "access/course/scan.glsl"
#include "access/environment_map.glsl"
#include "access/material.glsl"
#include "access/status.glsl"
#include "lib/course/split_sample.glsl"

vec3 radianceFound(PathRay ray, PathHit hit)
{
    if (hit.primitiveRef == kNoPrimitiveRef) {
        vec3 radiance = hasEnvironmentMap() ? environmentRadiance(ray.direction) : render.environment;
        return hasEnvironment() ? radiance : vec3(0.0);
    }
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    SurfaceMaterial material = makeSurfaceMaterial(si);
    return emittedRadiance(si, material.data);
}

// Without barycentric coordinates, which emission does not depend on.
PathHit scanRefs(uint slot, PathRay ray, ShadowRay soFar)
{
    PathHit hit = scanClosest(ray, PathHit(soFar.target, soFar.tMax, vec2(0.0)), lightRound.firstRef, lightRound.endRef);
    shadowRayWords[3u * slot + 1u].w = hit.primitiveRef;
    shadowRayWords[3u * slot + 2u].w = floatBitsToUint(hit.t);
    return hit;
}

void visit(uint slot)
{
    ShadowRay shadow = fetchShadowRay(slot);
    PathRay ray = PathRay(shadow.origin, shadow.source, shadow.direction, 0u);
    SampleId id = splitSample(makeSampleId(slot), kNoLightIndex, lightRound.lightSample, lightRound.lightSamples);
    Steps uncounted = Steps(0u, 0u);
    PathHit hit = kBruteForce ? scanRefs(slot, ray, shadow) : traceVisible(id, pass.bounce + 1u, ray, uncounted).hit;
    if (lightRound.endRef == course.refCount) {
        addShareOfRadiance(slot, shadow.contribution * radianceFound(ray, hit), pass.bounce + 1u);
    }
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry == 0u && lightRound.firstRef == 0u) {
        checkShadowRays();
        countRays(0u, activeShadowRays());
    }
    if (entry < activeShadowRays()) {
        visit(shadowQueue[entry]);
    }
    checkLoopBudget(render.canarySteps);
}
