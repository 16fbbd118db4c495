// The next ray of a path: sampled from the BSDF, then spawned if roulette lets it. Conditions select values rather than branch, as in
// path_vertex.glsl.
#ifndef GLIM_ACCESS_NEXT_RAY
#define GLIM_ACCESS_NEXT_RAY

#include "bsdf.glsl"
#include "lib/media.glsl"
#include "lib/octahedral.glsl"
#include "notes.glsl"
#include "pass.glsl"
#include "status.glsl"

// A bounce's random numbers, in [0, 1).
struct BounceNumbers {
    vec2 direction;
    float lobe, roulette;
};

BounceNumbers sampleBounceNumbers(SampleId id, uint bounce)
{
    vec2 direction = unitFloat(samplePair(id, bounceDimension(bounce, kDimensionBsdf), kSobol));
    vec2 lobe = unitFloat(samplePair(id, bounceDimension(bounce, kDimensionLobe), kSobol));
    return BounceNumbers(direction, lobe.x, lobe.y);
}

// Roulette's probability that the sampled ray is traced. The including file defines it: path_vertex.glsl, and course/bounce.glsl for the
// course. `throughput` includes the sample's weight.
float computeContinuation(BsdfSample s, vec3 throughput, float etaScale, uint bounce);

// The media that a ray which leaves the surface is in.
uint mediaOfNextRay(uint media, SurfaceInteraction si, Bsdf bsdf, vec3 wi)
{
    bool crosses = bsdf.medium != 0u && dot(wi, si.ng) < 0.0;
    uint after = crosses ? mediaBeyond(media, bsdf.medium, si.front) : media;
    if (hasFeature(kFeatureMedia) && crosses && si.front && isFull(media)) {
        reportMediaCap();
    }
    return hasFeature(kFeatureMedia) ? after : 0u;
}

// Spawns the sampled ray if roulette lets it. False if the path ends: ray and state are then of no use. `media`: of the ray that has arrived.
bool continuePath(BsdfSample s, BounceNumbers u, SurfaceInteraction si, Bsdf bsdf, uint media, out PathRay ray, inout PathState state)
{
    if (kNotes) {
        noteLobe(sampledLobe(bsdf, u.lobe), s.flags);
    }
    vec3 throughput = state.throughput * s.weight;
    noteBounce(s.weight, throughput);
    float etaScale = state.etaScale * (s.eta * s.eta);
    float continuation = computeContinuation(s, throughput, etaScale, state.bounce);
    bool scatters = any(notEqual(throughput, vec3(0.0)));
    if (scatters) {
        noteContinuation(continuation);
    }
    ray = spawnRay(si, s.wi);
    ray.media = mediaOfNextRay(media, si, bsdf, s.wi);
    if (hasFeature(kFeatureCaustics)) {
        bool diffuse = state.bounce == 0u ? (s.flags & kBsdfDelta) == 0u : (media & kIsDiffuseFirst) != 0u;
        ray.media |= diffuse ? kIsDiffuseFirst : 0u;
    }
    state = PathState(throughput / continuation, s.pdf, max(0.0, dot(s.wi, bsdf.frame.z)), etaScale, state.bounce + 1u,
                      encodeReceiverNormal(bsdf));
    return scatters && u.roulette < continuation;
}

// Samples the BSDF, and continues the path.
bool bouncePath(SampleId id, SurfaceInteraction si, Bsdf bsdf, vec3 wo, uint media, out PathRay ray, inout PathState state)
{
    BounceNumbers u = sampleBounceNumbers(id, state.bounce);
    return continuePath(sampleBsdf(bsdf, wo, u.direction, u.lobe), u, si, bsdf, media, ray, state);
}

#endif
