// One thread takes light paths of the pass, one after the other, and traces each to its end. A path begins at a light and meets a specular
// surface first. Then it sends light to the camera from every surface that is not specular. These are the caustics that camera paths leave
// out. Slot i of the pass is light path firstPixel + i, counted from that of sample firstSample on. Paths that exceed the kernel's limits
// go into the next queue unfinished. Reads the scene; the queue unless it is the pass's first dispatch. Updates rays, states, radiance (the
// paths' flux), splats, ray counts. Appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define UPDATES_RAYS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define WRITES_NEXT_QUEUE
#define UPDATES_ROUNDS
#define UPDATES_RAY_COUNTS
#include "access/light_path.glsl"
#include "access/light_traversal.glsl"
#include "access/light_vertex.glsl"
#include "access/path_time.glsl"
#include "access/splats.glsl"
#include "access/start_media.glsl"

struct Path {
    uint slot;
    SampleId id;
    PathRay ray;
    PathState state;
    PathRadiance light;  // the path's flux
    float range;
    float cameraRatio;  // of the light on its way to the camera, as in LightVertex
};

#define pathSides(path) (kFronts | kBacks)
#define connectionSides(path) kBacks
const bool kSeenByCamera = true;
const FeatureMask kDimmingFeatures = kFeatureThinWalls | kFeatureSingleSided;
const bool kScatters = false;

#include "access/path_loop.glsl"

SampleId makeLightPathId(uint slot)
{
    uint number = pass.firstPixel + slot, sampleNumber = number / render.lightPaths;
    return lightPathId(render.seed, number - sampleNumber * render.lightPaths, pass.firstSample + sampleNumber);
}

// In the queue, beside the slot: the path has not begun.
const uint kUnbegun = 0x80000000u;

uint fetchEntry(uint entry)
{
    return pass.bounce == 0u ? entry | kUnbegun : activeQueue[entry];
}

bool takePath(uint entry, out Path path, inout Work work)
{
    uint slot = entry & ~kUnbegun;
    SampleId id = makeLightPathId(slot);
    beginLightPath(id);
    if ((entry & kUnbegun) == 0u) {
        path = Path(slot, id, fetchRay(slot), fetchState(slot), fetchRadiance(slot), 0.0, 0.0);
    } else {
        uint group;
        LightRay light = sampleEmission(id, group);
        if (hasFeature(kFeatureLightsInMedia) && any(notEqual(light.flux, vec3(0.0)))) {
            Steps steps = Steps(0u, 0u);
            light.ray.media = mediaAround(light.ray.origin, steps);
            work.steps += steps.nodes + steps.primitives;
        }
        path = Path(slot, id, light.ray, PathState(vec3(1.0), light.density, 0.0, 1.0, 0u, group), PathRadiance(light.flux, 0.0),
                    light.range, 0.0);
    }
    return any(notEqual(path.light.radiance, vec3(0.0)));
}

VisibleHit tracePathThroughAlpha(Path path, AlphaRay alphaRay, inout Steps steps)
{
    return traceLightThroughAlpha(path.id, path.state.bounce + 1u, alphaRay, steps);  // no ray of it is the camera's
}

void addLight(inout Path path, uint pixel, vec3 contribution, uint pathLength)
{
    addSplat(pixel, path.id.index, contribution, pathLength, path.state.normal, path.cameraRatio);
}

void visitMiss(inout Path path) {}

bool visitScattering(inout Path path, float t) { return false; }

bool visitSurface(inout Path path, PathHit hit, inout Work work, inout Steps steps, inout TracedRay traced)
{
    if (path.state.bounce == 0u) {
        path.light.radiance *= rangeFalloff(hit.t * hit.t, path.range);
    }
    LightVertex vertex = shadeLightVertex(path.id, path.ray, hit, path.state);
    path.cameraRatio = vertex.cameraRatio;
    if (vertex.hasSplat) {
        traceConnection(path, vertex.cameraRay, path.light.radiance * vertex.cameraRay.contribution, vertex.pixel, work, steps, traced);
    }
    path.ray = vertex.ray;
    path.state = vertex.state;
    return vertex.hasNextRay;
}

void endPath(Path path) {}

void main()
{
    traceQueue();
}
