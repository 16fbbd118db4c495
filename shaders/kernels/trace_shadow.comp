// One thread is one entry of the shadow queue. Adds the light it carries if nothing is in its way. Brute force takes several
// dispatches: rays in the shadow get no reach, and the last dispatch adds the light of the others.
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

bool isUnoccludedSoFar(uint slot, ShadowRay ray)
{
    bool clear = ray.reach > 0.0 && scanUnoccluded(ray, pass.firstRecord, pass.endRecord);
    if (!clear) {
        pathShadowRays[slot].reach = 0.0;
    }
    return clear;
}

void main()
{
    uint entry = interleavedInvocation();
    if (entry < queueSizes.shadow) {
        uint slot = shadowQueue[entry];
        ShadowRay ray = fetchShadowRay(slot);
        bool clear = kBruteForce ? isUnoccludedSoFar(slot, ray) : isUnoccluded(ray);
        if (clear && pass.endRecord == pass.recordCount) {
            addRadiance(slot, ray.contribution, pass.bounce + 1u, pass.lightSamples);
        }
    }
    checkLoopBudget(pass.canarySteps);
}
