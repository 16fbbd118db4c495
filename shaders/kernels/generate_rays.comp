// One thread is one slot of the pass: a sample of a pixel. Starts its path at the camera.
// Reads the camera. Writes rays, states, radiance; size_dispatch has set the queue to all slots (the next queue holds them).
#version 460
#extension GL_GOOGLE_include_directive : require
#define WRITES_RAYS
#define WRITES_STATES
#define WRITES_RADIANCE
#define WRITES_NEXT_QUEUE
#include "access/paths.glsl"
#include "access/scene.glsl"
#include "access/status.glsl"
#include "lib/camera.glsl"
#include "lib/warp.glsl"

PathRay rayThrough(SampleId id, vec2 film)
{
    return kLens ? lensRay(sceneCamera, film, sampleDisk(unitFloat(samplePair(id, kDimensionLens, kSobol))))
                 : cameraRay(sceneCamera, film);
}

void main()
{
    uint slot = interleavedInvocation();
    if (slot < pass.pixelCount * pass.sampleCount) {
        SampleId id = sampleOfSlot(slot);
        vec2 jitter = unitFloat(samplePair(id, kDimensionPixel, kSobol));
        vec2 corner = vec2(id.pixel % pass.width, id.pixel / pass.width);
        pathRays[slot] = rayThrough(id, filmFromPixel(corner + jitter, vec2(pass.width, pass.height)));
        pathStates[slot] = PathState(vec3(1.0), 0.0, 0.0, 1.0, 0u, 0u);
        pathRadiance[slot] = PathRadiance(vec3(0.0), 0.0);
        nextQueue[slot] = slot;
    }
    checkLoopBudget(pass.canarySteps);
}
