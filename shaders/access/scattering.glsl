// Paths in media that scatter: a random walk from surface to surface. A scattering is no surface: no light is sampled there, since the
// boundary is in its way, and the path's bounce stays. What leaves the medium finds lights as from any surface.
#ifndef GLIM_ACCESS_SCATTERING
#define GLIM_ACCESS_SCATTERING

#include "guide.glsl"
#include "lib/media.glsl"
#include "lib/roulette.glsl"
#include "lib/scattering.glsl"
#include "parameters.glsl"
#include "pass.glsl"
#include "scene.glsl"
#include "shared/limits.h"
#include "status.glsl"

bool isScattered(PathHit hit)
{
    return hasFeature(kFeatureScattering) && hit.primitiveRef == kScatteredRef;
}

bool scatters(uint media)
{
    uint medium = innermost(media);
    return hasFeature(kFeatureScattering) && medium != 0u && fetchScattering(render.firstScattering, medium).albedo != vec3(0.0);
}

// Since the last surface.
uint countScatterings(PathState state)
{
    return uint(max(0.0, -state.cosine));
}

// The bounce of a path of the active queue. Without scattering all have met as many surfaces.
uint bounceOf(PathState state)
{
    return hasFeature(kFeatureScattering) ? state.bounce : pass.bounce;
}

// The path's bounce, in a walk mixed with its steps: for numbers that must differ from ray to ray. Below 2^29.
uint rayNumber(PathState state)
{
    return hasFeature(kFeatureScattering) ? (state.bounce + countScatterings(state) * 0x9e3779b9u) & 0x1fffffffu : state.bounce;
}

uvec4 scatteringBits(SampleId id, uint dimension, PathState state)
{
    return hash4(uvec4(id.pixel, id.index, dimension | state.bounce, id.seed ^ (countScatterings(state) + 1u) * 0x9e3779b9u));
}

// A scattering is nowhere closer to the surface ahead than this, so that rounding cannot put it on the other side.
float scatteringMargin(PathRay ray, float t)
{
    vec3 a = abs(ray.origin);
    return 4.7683716e-7 * (max(a.x, max(a.y, a.z)) + t);
}

// Of the medium, at most as much as positions in float resolve: mean free paths are 64 margins long. A body so dense looks the same however
// dense it is, but a walk of shorter steps would not find out of it: a ball of colour .8 lost 6 % with 3 margins, 1.5 % with 16, .5 % with
// 64.
vec3 extinctionAlong(PathRay ray)
{
    return min(fetchMedium(render.firstMedium, innermost(ray.media)).extinction, vec3(1.0 / (64.0 * scatteringMargin(ray, 0.0))));
}

// How far the ray goes unless it meets a surface. Infinite outside of media that scatter.
float sampleFreePath(SampleId id, PathRay ray, PathState state)
{
    if (!scatters(ray.media)) {
        return kInfinity;
    }
    uvec4 bits = scatteringBits(id, kDimensionFreePath, state);
    return sampleFreePath(extinctionAlong(ray)[chooseChannel(state.throughput, unitFloat(bits.y))], unitFloat(bits.x));
}

// How far surfaces are looked for.
float reachOf(PathRay ray, float freePath)
{
    return freePath + scatteringMargin(ray, freePath);
}

// What the ray meets: the surface or, before that, a scattering.
PathHit meetFirst(PathRay ray, PathHit surface, float freePath)
{
    bool reaches = surface.primitiveRef != kNoPrimitiveRef && surface.t <= freePath;
    bool misses = surface.primitiveRef == kNoPrimitiveRef && isinf(freePath);
    if (reaches || misses) {
        return surface;
    }
    float ahead = surface.primitiveRef == kNoPrimitiveRef ? freePath : max(0.0, surface.t - scatteringMargin(ray, freePath));
    return PathHit(kScatteredRef, min(freePath, ahead), vec2(0.0));
}

// The throughput at what the ray has met, if it is in a medium that scatters.
vec3 throughputAt(PathRay ray, PathHit hit, vec3 throughput)
{
    if (!scatters(ray.media)) {
        return throughput;
    }
    vec3 extinction = extinctionAlong(ray);
    if (isScattered(hit)) {
        vec3 albedo = fetchScattering(render.firstScattering, innermost(ray.media)).albedo;
        return scatteredThroughput(throughput, extinction, albedo, hit.t);
    }
    return reachedThroughput(throughput, extinction, hit.primitiveRef == kNoPrimitiveRef ? kInfinity : hit.t);
}

void endCutPath(PathState state)
{
    float left = sumOfChannels(state.throughput) * state.etaScale * (1.0 / 3.0);
    reportScatteringCap(uint(min(left, 1e4) * (1.0 / kCutUnit)));
}

// Since the last surface. A longer walk would multiply as many ratios of densities: in scenes/wax.gltf the guide of all scatterings had
// 2.3 times the noise of this, and missed 7 % of the light (tests/bench/guiding.md).
const uint kMostGuidedScatterings = 4u;

// A direction that phase function and guide have chosen, as evalAndSampleGuided() does.
struct Deflection {
    vec3 w;
    float phasePdf;
    float weight;  // of the throughput
};

Deflection sampleGuidedDeflection(Guide guide, vec3 direction, float g, vec2 u, float uChoice)
{
    bool byGuide = uChoice < guide.share;
    GuideSample guided = sampleGuideOr(guide, byGuide, u, deflect(direction, g, u));
    float phasePdf = pdfOfDeflection(g, dot(direction, guided.w));
    return Deflection(guided.w, phasePdf, phasePdf / mixPdfs(guide, guided.pdf, phasePdf));
}

// Scatters the path after t metres. False if it ends: ray and state are then of no use. Roulette compares with the light that entered, so
// that it ends no path early of which little is absorbed.
bool scatterPath(SampleId id, float t, inout PathRay ray, inout PathState state, out LearnedVertex learned)
{
    float g = fetchScattering(render.firstScattering, innermost(ray.media)).anisotropy;
    uvec4 bits = scatteringBits(id, kDimensionDeflection, state);
    uint count = countScatterings(state) + 1u;
    vec3 p = ray.origin + ray.direction * t;
    learned = LearnedVertex(p, kNoReceiverNormal, vec3(0.0), vec3(0.0), vec3(0.0), 0u, true);
    float radiance = 1.0;
    Deflection next = Deflection(deflect(ray.direction, g, unitFloat(bits.xy)), 1.0, 1.0);
    if (kGuidedScatterings && count <= kMostGuidedScatterings) {
        Guide guide = fetchGuide(p, kGuideOfScatterings);
        guide.share *= 1.0 - abs(g);
        next = sampleGuidedDeflection(guide, ray.direction, g, unitFloat(bits.xy), unitFloat(bits.w));
        radiance = state.bounce > 0u ? guide.radiance : 1.0;
        learned.known = state.throughput * guide.reflected;
        learned.isNarrow = next.phasePdf > kNarrowPdf;
    }
    float continuation = continuationProbability(state.throughput * radiance, state.etaScale, kRouletteBounce);
    continuation = kGuidedScatterings ? max(kLeastGuidedContinuation, continuation) : continuation;
    bool goesOn = unitFloat(bits.z) < continuation;
    learned.throughput = goesOn ? state.throughput / continuation : vec3(0.0);
    ray = PathRay(p, kNoPrimitive, next.w, ray.media | kHasScattered);
    state = PathState(state.throughput * next.weight / continuation, 0.0, -float(count), state.etaScale, state.bounce, kNoReceiverNormal);
    if (goesOn && count == kMaxScatterings) {
        endCutPath(state);
    }
    return goesOn && count < kMaxScatterings;
}

#endif
