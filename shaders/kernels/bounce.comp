// One thread is one entry of the active queue. Scatters its path at the surface that it met, plays roulette, and queues the
// next ray. Comes after sample_lights of the same bounce.
// Reads the scene, the queue, hits. Updates rays and states; writes the note; appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define UPDATES_RAYS
#define READS_HITS
#define UPDATES_STATES
#define WRITES_NEXT_QUEUE
#define UPDATES_QUEUE_TAILS
#include "access/notes.glsl"
#include "access/paths.glsl"
#include "access/status.glsl"
#include "lib/frame.glsl"
#include "lib/roulette.glsl"
#include "lib/scatter.glsl"

// The shading normal alone says which side wo is on and what happens, even against the geometry. Where the geometric one
// decides instead, light enters by one normal and the others reflect it totally for ever: a furnace of smooth gems with
// normals 20 degrees off their faces fell to .984. By this rule what passes through a wall soon passes back, and it is 1.
Scatter scatterGlass(Surface surface, FlatMaterial material, vec3 wo, float fate)
{
    bool behind = dot(surface.shading, wo) < 0.0;
    return sampleGlass(material.baseColor, material.ior, surface.front != behind, wo,
                       behind ? -surface.shading : surface.shading, fate);
}

// Elsewhere light never passes: where the shading normal sends it through the wall, a mirror reflects about the geometric
// one and Lambert ends the path.
Scatter scatterMirror(Surface surface, FlatMaterial material, vec3 wo)
{
    Scatter scatter = sampleMirror(material.baseColor, wo, surface.shading);
    return dot(scatter.wi, surface.geometric) > 0.0 ? scatter : sampleMirror(material.baseColor, wo, surface.geometric);
}

Scatter scatterLambert(Surface surface, FlatMaterial material, vec2 u)
{
    Scatter scatter = sampleLambert(material.baseColor, u);
    scatter.wi = worldFromFrame(makeFrame(surface.shading), scatter.wi);
    if (!(dot(scatter.wi, surface.geometric) > 0.0)) {
        scatter.weight = vec3(0.0);
    }
    return scatter;
}

Scatter scatterAt(inout Surface surface, vec3 wo, vec2 u, float fate)
{
    FlatMaterial material = fetchMaterial(surface.material);
    if (kSpecular && material.scattering == kGlass) {
        return scatterGlass(surface, material, wo, fate);
    }
    turnToViewer(surface, wo);
    return kSpecular && material.scattering == kMirror ? scatterMirror(surface, material, wo)
                                                       : scatterLambert(surface, material, u);
}

// The last ray of a path only finds light, and what sampling has found already does not count twice.
bool findsNothing(Scatter scatter)
{
    bool sampled = kDirect == kDirectLights || kDirect == kDirectHemisphere;
    return sampled && scatter.pdf > 0.0 && pass.bounce + 1u == pass.maxBounces;
}

float survivalOf(vec3 throughput, float etaScale)
{
    return kRoulette == kRouletteThroughput ? survivalProbability(throughput, etaScale, pass.bounce)
           : kRoulette == kRouletteFixed    ? survivalFixed(pass.survival, pass.bounce)
                                            : 1.0;
}

void visit(uint slot)
{
    PathHit hit = fetchHit(slot);
    if (hit.record == kNoRecord) {
        return;
    }
    PathRay ray = fetchRay(slot);
    PathState state = fetchState(slot);
    Surface surface = surfaceAt(ray, hit);
    SampleId id = sampleOfSlot(slot);
    vec2 u = unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionScatter), kSobol));
    vec2 fate = unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionFate), kSobol));
    Scatter scatter = scatterAt(surface, -ray.direction, u, fate.x);
    vec3 throughput = state.throughput * scatter.weight;
    noteScatter(scatter.weight, throughput);
    if (all(equal(throughput, vec3(0.0))) || findsNothing(scatter)) {
        return;
    }
    float etaScale = state.etaScale * scatter.etaScale;
    float survival = survivalOf(throughput, etaScale);
    noteSurvival(survival);
    if (!(fate.y < survival)) {
        return;
    }
    pathRays[slot] = PathRay(leavePoint(surface, scatter.wi), hit.record, scatter.wi, 0u);
    pathStates[slot] = PathState(throughput / survival, scatter.pdf, max(0.0, dot(scatter.wi, surface.shading)), etaScale, uvec2(0u));
    nextQueue[atomicAdd(queueTails.next, 1u)] = slot;
}

void main()
{
    uint entry = interleavedInvocation();
    if (pass.bounce < pass.maxBounces && entry < queueSizes.closest) {
        visit(activeQueue[entry]);
    }
    checkLoopBudget(pass.canarySteps);
}
