// One thread is one slot of the pass: a pixel. Its ray passes through the pixel's centre and the middle of the lens.
// Reads the parameters. Writes rays, states and, to the next queue, all slots.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WRITES_RAYS
#define WRITES_STATES
#define WRITES_NEXT_QUEUE
#include "access/features.glsl"
#include "access/path_time.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/camera.glsl"

void main()
{
    uint slot = interleavedInvocation();
    if (slot < pass.pixelCount) {
        SampleId id = makeSampleId(slot);
        uint pixel = id.pixel;
        beginPath(id);
        vec2 center = vec2(pixel % render.width, pixel / render.width) + 0.5;
        vec2 film = filmFromPixel(center, vec2(render.width, render.height)), plane = film;
        PathRay ray;
        bool isSeen;
        if (kProjection >= kFisheye) {
            isSeen = sphericalRay(render.camera, kProjection, film, ray);
        } else {
            isSeen = kProjection == kCentredFilm || planeFromFilm(render.camera.projection, kProjection, film, plane);
            ray = cameraRay(render.camera, plane);
        }
        if (!isSeen) {
            ray = rayOfNothing();
        }
        storeRay(slot, ray);
        storeState(slot, PathState(vec3(1.0), 0.0, 0.0, 1.0, 0u, 0u));
        nextQueue[slot] = slot;
    }
    checkLoopBudget(render.canarySteps);
}
