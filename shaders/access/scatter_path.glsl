// Where a path goes on from a surface, if it does.
#ifndef GLIM_ACCESS_SCATTER_PATH
#define GLIM_ACCESS_SCATTER_PATH

#include "lib/frame.glsl"
#include "lib/roulette.glsl"
#include "lib/scatter.glsl"
#include "lib/warp.glsl"
#include "notes.glsl"
#include "pass.glsl"

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
    if (kGlasses && material.scattering == kGlass) {
        return scatterGlass(surface, material, wo, fate);
    }
    turnToViewer(surface, wo);
    return kMirrors && material.scattering == kMirror ? scatterMirror(surface, material, wo)
                                                      : scatterLambert(surface, material, u);
}

// The last ray of a path only finds light, and what sampling has found already does not count twice.
bool findsNothing(Scatter scatter, uint bounce)
{
    bool sampled = kDirect == kDirectLights || kDirect == kDirectHemisphere;
    return sampled && scatter.pdf > 0.0 && bounce + 1u == pass.maxBounces;
}

float survivalOf(vec3 throughput, float etaScale, uint bounce)
{
    return kRoulette == kRouletteThroughput ? survivalProbability(throughput, etaScale, bounce)
           : kRoulette == kRouletteFixed    ? survivalFixed(pass.survival, bounce)
                                            : 1.0;
}

// Scatters a path at the surface that its ray met (not turned to the viewer) and plays roulette. False if it ends there.
bool scatterPath(SampleId id, uint bounce, Surface surface, inout PathRay ray, inout PathState state)
{
    vec2 u = unitFloat(samplePair(id, bounceDimension(bounce, kDimensionScatter), kSobol));
    vec2 fate = unitFloat(samplePair(id, bounceDimension(bounce, kDimensionFate), kSobol));
    Scatter scatter = scatterAt(surface, -ray.direction, u, fate.x);
    vec3 throughput = state.throughput * scatter.weight;
    noteScatter(scatter.weight, throughput);
    if (all(equal(throughput, vec3(0.0))) || findsNothing(scatter, bounce)) {
        return false;
    }
    float etaScale = state.etaScale * scatter.etaScale;
    float survival = survivalOf(throughput, etaScale, bounce);
    noteSurvival(survival);
    if (!(fate.y < survival)) {
        return false;
    }
    ray = PathRay(leavePoint(surface, scatter.wi), surface.primitive, scatter.wi, 0u);
    state = PathState(throughput / survival, scatter.pdf, max(0.0, dot(scatter.wi, surface.shading)), etaScale, bounce + 1u, 0u);
    return true;
}

#endif
