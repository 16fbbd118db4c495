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

// Uses the sampler dimensions of the bounce. uRoulette, in [0, 1), is the random number for roulette.
BsdfSample sampleNextRay(SampleId id, Bsdf bsdf, vec3 wo, uint bounce, out float uRoulette)
{
    vec2 u = unitFloat(samplePair(id, bounceDimension(bounce, kDimensionBsdf), kSobol));
    vec2 lobe = unitFloat(samplePair(id, bounceDimension(bounce, kDimensionLobe), kSobol));
    uRoulette = lobe.y;
    BsdfSample s = sampleBsdf(bsdf, wo, u, lobe.x);
    if (kNotes) {
        noteLobe(sampledLobe(bsdf, lobe.x), s.flags);
    }
    return s;
}

// Roulette's probability that the sampled ray is traced. The including file defines it: path_vertex.glsl, and course/bounce.glsl for the
// course. `throughput` includes the sample's weight.
float continuationOf(BsdfSample s, vec3 throughput, float etaScale, uint bounce);

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

// Samples the BSDF and plays roulette. False if the path ends: ray and state are then of no use. `media`: of the ray that has arrived.
bool bouncePath(SampleId id, SurfaceInteraction si, Bsdf bsdf, vec3 wo, uint media, out PathRay ray, inout PathState state)
{
    float uRoulette;
    BsdfSample s = sampleNextRay(id, bsdf, wo, state.bounce, uRoulette);
    vec3 throughput = state.throughput * s.weight;
    noteBounce(s.weight, throughput);
    float etaScale = state.etaScale * (s.eta * s.eta);
    float continuation = continuationOf(s, throughput, etaScale, state.bounce);
    bool scatters = any(notEqual(throughput, vec3(0.0)));
    if (scatters) {
        noteContinuation(continuation);
    }
    ray = spawnRay(si, s.wi);
    ray.media = mediaOfNextRay(media, si, bsdf, s.wi);
    state = PathState(throughput / continuation, s.pdf, max(0.0, dot(s.wi, bsdf.frame.z)), etaScale, state.bounce + 1u,
                      encodeNormal(bsdf.frame.z));
    return scatters && uRoulette < continuation;
}

#endif
