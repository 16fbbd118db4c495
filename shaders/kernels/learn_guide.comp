// As trace_paths, but writes down what light the paths find, instead of adding it to a film: paths that learn where light comes from. They
// are guided by what others have learned before, whose knowledge also takes the place of light that is reflected more than once.
// Reads the scene, the queue. Updates rays, states, radiance (the numbers of the path's records), records, ray counts. Appends to the next
// queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define UPDATES_RAYS
#define UPDATES_STATES
#define UPDATES_RADIANCE
#define WRITES_NEXT_QUEUE
#define UPDATES_ROUNDS
#define UPDATES_RAY_COUNTS
#include "access/guide_records.glsl"
#include "access/path_time.glsl"
#include "access/path_vertex.glsl"
#include "access/traverse.glsl"

struct Path {
    uint slot;
    SampleId id;
    PathRay ray;
    PathState state;
    PathRadiance light;  // red: number of the open record; green: of the one that awaits its light sample; blue: how many there are
    float opened;        // the number of the record that the last vertex has opened, or 0
};

#define pathSides(path) kFronts
#define connectionSides(path) kFronts
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
    path = Path(slot, makeSampleId(slot), fetchRay(slot), fetchState(slot), fetchRadiance(slot), 0.0);
    beginPath(path.id);
    if (path.light.radiance.b == 0.0) {
        clearRecords(slot);
    }
    return true;
}

VisibleHit tracePathThroughAlpha(Path path, AlphaRay alphaRay, inout Steps steps)
{
    return traceThroughAlpha(path.id, rayNumber(path.state), alphaRay, steps);
}

// Of a light sample.
void addLight(inout Path path, uint group, vec3 contribution, uint pathLength)
{
    bool waits = path.light.radiance.g > 0.0;
    addToRecord(path.slot, waits ? path.light.radiance.g : path.opened > 0.0 ? 0.0 : path.light.radiance.r, contribution);
    addDirect(path.slot, path.opened, contribution);
}

void visitMiss(inout Path path)
{
    if (hasEnvironment()) {
        addToRecord(path.slot, path.light.radiance.r, shadeMiss(path.ray, path.state));
    }
}

// Returns its number; 0 if the path has had all of its records.
float openRecord(inout Path path, LearnedVertex vertex, vec3 wi)
{
    if (path.light.radiance.b >= float(kGuideRecords)) {
        return 0.0;
    }
    float number = path.light.radiance.b += 1.0;
    guideRecords[recordAt(path.slot, number)] =
        GuideRecord(vertex.point, 0.0, encodeNormal(wi), vertex.normal, computeLuminance(vertex.throughput),
                    packDirect(computeLuminance(vertex.sampled), vertex.lights, false));
    return number;
}

// `wi`: the next direction.
void learnVertex(inout Path path, LearnedVertex vertex, vec3 wi)
{
    path.light.radiance.g = path.opened = 0.0;
    if (!vertex.isNarrow) {
        addToRecord(path.slot, path.light.radiance.r, vertex.known);
        path.light.radiance.g = path.light.radiance.r;
        path.light.radiance.r = path.opened = openRecord(path, vertex, wi);
    }
}

bool visitScattering(inout Path path, float t)
{
    LearnedVertex vertex;
    bool goesOn = scatterPath(path.id, t, path.ray, path.state, vertex);
    if (kGuidedScatterings) {
        learnVertex(path, vertex, path.ray.direction);
    }
    return goesOn;
}

bool visitSurface(inout Path path, PathHit hit, inout Work work, inout Steps steps, inout TracedRay traced)
{
    VertexResult vertex = shadeSurface(path.id, path.ray, hit, path.state);
    if (hasEmissiveSurfaces()) {
        addToRecord(path.slot, path.light.radiance.r, vertex.emitted);
    }
    learnVertex(path, vertex.learned, vertex.ray.direction);
    if (vertex.hasShadowRay) {
        traceConnection(path, vertex.shadowRay, vertex.shadowRay.contribution, 0u, work, steps, traced);
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
