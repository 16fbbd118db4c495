// One thread is one entry of the shadow queue. Adds the light it carries if nothing is in its way. Brute force takes several
// dispatches: an occluded ray gets tMax 0, and the last dispatch adds the light of the others.
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
#include "access/status.glsl"

bool isUnoccludedSoFar(uint slot, ShadowRay ray)
{
    bool unoccluded = ray.tMax > 0.0 && scanUnoccluded(ray, lightRound.firstRef, lightRound.endRef);
    if (!unoccluded) {
        shadowRayWords[3u * slot + 2u].w = 0u;
    }
    return unoccluded;
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry == 0u && lightRound.firstRef == 0u) {
        checkShadowRays();
        countRays(0u, activeShadowRays());
    }
    if (entry < activeShadowRays()) {
        uint slot = shadowQueue[entry];
        ShadowRay ray = fetchShadowRay(slot);
        vec3 clear = kBruteForce ? vec3(isUnoccludedSoFar(slot, ray) ? 1.0 : 0.0) : transmittance(ray);
        if (isClear(clear) && lightRound.endRef == course.refCount) {
            addShareOfRadiance(slot, attenuate(ray.contribution, clear), pass.bounce + 1u);
        }
    }
    checkLoopBudget(render.canarySteps);
}
