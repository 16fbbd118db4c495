// One thread is one entry of the shadow queue. Adds the light it carries if nothing is in its way.
// Reads the scene, the shadow queue, shadow rays, states. Updates radiance, light of groups, ray counts.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_SHADOW_QUEUE
#define READS_ROUNDS
#define READS_SHADOW_RAYS
#define READS_STATES
#define UPDATES_RADIANCE
#define UPDATES_GROUP_LIGHT
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
            vec3 light = attenuate(ray.contribution, clear);
            uint pathLength = hasFeature(kFeatureScattering) ? fetchState(slot).bounce : pass.bounce + 1u;
            addRadiance(slot, light, pathLength);
            if (hasFeature(kFeatureLightGroups)) {
                addToGroup(slot, fetchShadowGroup(slot), light, pathLength);
            }
        }
    }
    checkLoopBudget(render.canarySteps);
}
