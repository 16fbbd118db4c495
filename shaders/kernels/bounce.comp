// One thread is one entry of the active queue. Scatters its path at the surface that it met, plays roulette, and queues the
// next ray. Comes after sample_lights of the same bounce.
// Reads the scene, the queue, hits. Updates rays and states; appends to the next queue.
#version 460
#extension GL_GOOGLE_include_directive : require
#define READS_ACTIVE_QUEUE
#define READS_QUEUE_SIZES
#define UPDATES_RAYS
#define READS_HITS
#define UPDATES_STATES
#define WRITES_NEXT_QUEUE
#define UPDATES_QUEUE_TAILS
#include "access/paths.glsl"
#include "access/status.glsl"
#include "access/surface.glsl"
#include "lib/frame.glsl"
#include "lib/roulette.glsl"
#include "lib/scatter.glsl"

// Mirror or glass about `normal`.
Scatter scatterSpecular(FlatMaterial material, bool front, vec3 wo, vec3 normal, float fate)
{
    return material.scattering == kMirror ? sampleMirror(material.baseColor, wo, normal)
                                          : sampleGlass(material.baseColor, material.ior, front, wo, normal, fate);
}

// Which side of the surface wi leaves on must not depend on interpolated normals: where the shading normal sends light
// through a wall, the geometric one decides.
Scatter scatterAt(Surface surface, FlatMaterial material, vec3 wo, vec2 u, float fate)
{
    if (!kSpecular || material.scattering == kLambert) {
        Scatter scatter = sampleLambert(material.baseColor, u);
        scatter.wi = worldFromFrame(makeFrame(surface.shading), scatter.wi);
        if (!(dot(scatter.wi, surface.geometric) > 0.0)) {
            scatter.weight = vec3(0.0);
        }
        return scatter;
    }
    Scatter scatter = scatterSpecular(material, surface.front, wo, surface.shading, fate);
    bool reflected = dot(scatter.wi, surface.shading) > 0.0;
    if (reflected != (dot(scatter.wi, surface.geometric) > 0.0)) {
        scatter = scatterSpecular(material, surface.front, wo, surface.geometric, fate);
    }
    return scatter;
}

void visit(uint slot)
{
    PathHit hit = pathHits[slot];
    if (hit.record == kNoRecord) {
        return;
    }
    PathRay ray = pathRays[slot];
    PathState state = pathStates[slot];
    Surface surface = surfaceAt(ray, hit);
    SampleId id = sampleOfSlot(slot);
    vec2 u = unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionScatter), kSobol));
    vec2 fate = unitFloat(samplePair(id, bounceDimension(pass.bounce, kDimensionFate), kSobol));
    Scatter scatter = scatterAt(surface, fetchMaterial(surface.material), -ray.direction, u, fate.x);
    vec3 throughput = state.throughput * scatter.weight;
    float etaScale = state.etaScale * scatter.etaScale;
    float survival = survivalProbability(throughput, etaScale, pass.bounce);
    if (!(fate.y < survival)) {
        return;
    }
    pathRays[slot] = PathRay(leavePoint(surface, scatter.wi), hit.record, scatter.wi);
    pathStates[slot] = PathState(throughput / survival, scatter.pdf, max(0.0, dot(scatter.wi, surface.shading)), etaScale);
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
