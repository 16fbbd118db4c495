// One thread is one entry of the shadow queue. Adds the light it carries if nothing is in its way.
// Reads the scene, the shadow queue, shadow rays, states. Updates radiance, ray counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_SHADOW_QUEUE
#define READS_ROUNDS
#define READS_SHADOW_RAYS
#define READS_STATES
#define UPDATES_RADIANCE
#define UPDATES_RAY_COUNTS
#include "access/catcher.glsl"
#include "access/path_time.glsl"
#include "access/radiance.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"

void main()
{
    uint entry = interleavedInvocation();
    if (entry == 0u) {
        checkShadowRays();
        countRays(0u, activeShadowRays());
    }
    if (entry < activeShadowRays()) {
        uint slot = shadowQueue[entry];
        beginPath(makeSampleId(slot));
        ShadowRay ray = fetchShadowRay(slot);
        vec3 clear = transmittance(ray, sidesOfRay(slot, pass.bounce + 1u));
        if (isClear(clear)) {
            addRadiance(slot, attenuate(ray.contribution, clear),
                        hasFeature(kFeatureScattering) ? fetchState(slot).bounce : pass.bounce + 1u);
        }
    }
    checkLoopBudget(render.canarySteps);
}
