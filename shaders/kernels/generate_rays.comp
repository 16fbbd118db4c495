// One thread is one slot of the pass: a sample of a pixel. Starts its path at the camera. If paths of the pass before are left, the pass
// has no path.
// Reads the parameters and, if rays begin in different media, the scene. Writes rays, states, radiance, light of groups and, to
// the next queue, all slots. May empty its round.
#version 460
#extension GL_GOOGLE_include_directive : require
#define WRITES_RAYS
#define WRITES_STATES
#define WRITES_RADIANCE
#define WRITES_GROUP_LIGHT
#define WRITES_NEXT_QUEUE
#define UPDATES_ROUNDS
#include "access/light_groups.glsl"
#include "access/path_time.glsl"
#include "access/paths.glsl"
#include "access/start_media.glsl"
#include "access/status.glsl"
#include "access/traverse.glsl"
#include "lib/camera.glsl"
#include "lib/warp.glsl"

// False if the point of the film shows nothing.
bool rayThrough(FlatCamera camera, SampleId id, vec2 film, out PathRay ray)
{
    if (kProjection >= kFisheye) {
        return sphericalRay(camera, kProjection, film, ray);
    }
    vec2 plane = film;
    bool isSeen = kProjection == kCentredFilm || planeFromFilm(camera.projection, kProjection, film, plane);
    ray = kLens ? lensRay(camera, plane, sampleDisk(unitFloat(samplePair(id, kDimensionLens, kSobol)))) : cameraRay(camera, plane);
    return isSeen;
}

void main()
{
    uint slot = interleavedInvocation();
    if (rounds[kLeftRound].paths.count > 0u) {
        if (slot == 0u) {
            rounds[pass.round].paths = Queue(0u, uvec3(0u, 1u, 1u));
        }
    } else if (slot < slotsOfPass()) {
        SampleId id = makeSampleId(slot);
        beginPath(id);
        vec2 jitter = unitFloat(samplePair(id, kDimensionPixel, kSobol));
        vec2 corner = vec2(id.pixel % render.width, id.pixel / render.width);
        PathRay ray;
        bool isSeen = rayThrough(render.camera, id, filmFromPixel(corner + jitter, vec2(render.width, render.height)), ray);
        if (!isSeen) {
            ray = rayOfNothing();
        }
        ray.media = render.camera.media;
        if (hasFeature(kFeatureMedia) && ray.media == kMediaVary) {
            Steps uncounted = Steps(0u, 0u);
            ray.media = mediaAround(ray.origin, uncounted);
        }
        storeRay(slot, ray);
        float throughput = isSeen ? 1.0 : 0.0;  // nor is the environment seen
        storeState(slot, PathState(vec3(throughput), 0.0, 0.0, 1.0, 0u, 0u));
        storeRadiance(slot, PathRadiance(vec3(0.0), 0.0));
        if (hasFeature(kFeatureLightGroups)) {
            clearGroupLight(slot);
        }
        nextQueue[slot] = slot;
    }
    checkLoopBudget(render.canarySteps);
}
