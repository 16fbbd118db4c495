// One thread takes paths of the active queue, one after the other, and traces each to its end. This is the persistent schedule, which
// replaces trace_closest, shade_surface and trace_shadow. Paths that exceed the kernel's limits go into the next queue unfinished.
// Reads the scene, the queue. Updates rays, states, radiance, light of groups, ray counts. Writes first hits; appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define UPDATES_RAYS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define UPDATES_GROUP_LIGHT
#define WRITES_FIRST_HITS
#define WRITES_NEXT_QUEUE
#define UPDATES_ROUNDS
#define UPDATES_RAY_COUNTS
#include "access/catcher.glsl"
#include "access/path_time.glsl"
#include "access/path_vertex.glsl"
#include "access/radiance.glsl"
#include "access/traverse.glsl"

struct Path {
    uint slot;
    SampleId id;
    PathRay ray;
    PathState state;
    PathRadiance light;
};

#define pathSides(path) sidesOfRay((path).slot, (path).state.bounce)
#define connectionSides(path) sidesOfRay((path).slot, (path).state.bounce + 1u)
const bool kSeenByCamera = false;
const FeatureMask kDimmingFeatures = kFeatureThinWalls;
const bool kScatters = true;

#include "access/path_loop.glsl"

uint fetchEntry(uint entry)
{
    return activeQueue[entry];
}

bool takePath(uint slot, out Path path, inout Work work)
{
    path = Path(slot, makeSampleId(slot), fetchRay(slot), fetchState(slot), fetchRadiance(slot));
    beginPath(path.id);
    return true;
}

VisibleHit tracePathThroughAlpha(Path path, AlphaRay alphaRay, inout Steps steps)
{
    return traceThroughAlpha(path.id, rayNumber(path.state), alphaRay, steps);
}

void addLight(inout Path path, uint group, vec3 contribution, uint pathLength)
{
    if (hasFeature(kFeatureLightGroups)) {
        addToGroup(path.slot, group, contribution, pathLength);
    }
    if (isLengthInRange(pathLength)) {
        path.light = addLight(path.light, contribution, pathLength, render.clampIndirect);
    }
}

void visitMiss(inout Path path)
{
    if (path.state.bounce == 0u) {
        storeFirstHit(path.slot, makeNoFirstHit());
    }
    if (hasEnvironment()) {
        addLight(path, environmentGroup(), shadeMiss(path.ray, path.state), path.state.bounce);
    }
}

bool visitScattering(inout Path path, float t)
{
    LearnedVertex learned;
    return scatterPath(path.id, t, path.ray, path.state, learned);
}

// Adds light in the order in which the wavefront does.
bool visitSurface(inout Path path, PathHit hit, inout Work work, inout Steps steps, inout TracedRay traced)
{
    VertexResult vertex = shadeSurface(path.id, path.ray, hit, path.state);
    if (path.state.bounce == 0u) {
        storeFirstHit(path.slot, vertex.firstHit);
    }
    if (hasFeature(kFeatureCatcher) && endsAtObject(path.slot, path.state.bounce, vertex.firstHit)) {
        return false;
    }
    if (hasEmissiveSurfaces()) {
        addLight(path, vertex.emittedGroup, vertex.emitted, path.state.bounce);
    }
    if (vertex.hasShadowRay) {
        traceConnection(path, vertex.shadowRay, vertex.shadowRay.contribution, vertex.shadowGroup, work, steps, traced);
    }
    path.ray = vertex.ray;
    path.state = vertex.state;
    return vertex.hasNextRay;
}

void endPath(Path path)
{
    storeRadiance(path.slot, path.light);
}

void main()
{
    traceQueue();
}
