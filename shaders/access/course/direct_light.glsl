// Direct light by the course's estimators: the light sample of a round, and the weight of light that a path's own ray has hit.
#ifndef GLIM_ACCESS_COURSE_DIRECT_LIGHT
#define GLIM_ACCESS_COURSE_DIRECT_LIGHT

#include "access/course/round.glsl"
#include "access/direct_light.glsl"
#include "access/notes.glsl"
#include "lib/course/split_sample.glsl"
#include "lib/mis.glsl"

// The MIS weight of light that a ray has hit, if light sampling has the density lightPdf for it. It is 1 for camera rays and after delta
// lobes.
float misWeightOfHit(PathState state, float lightPdf)
{
    if (!(state.pdf > 0.0) || kDirect == kDirectBsdf) {
        return 1.0;
    }
    float weight = kDirect == kDirectMis ? powerHeuristic(state.pdf, lightPdf) : 0.0;
    noteHitLight(lightPdf, weight);
    return weight;
}

uint fetchSight(vec3 p, vec3 receiverNormal) { return 0u; }

float misWeightOfSample(float lightPdf, float bsdfPdf)
{
    float weight = kDirect == kDirectMis && lightPdf > 0.0 ? powerHeuristic(lightPdf, bsdfPdf) : 1.0;
    return kDirect == kDirectLights ? weight / float(lightRound.lightSamples) : weight;
}

// Samples the light that the round names, or a chosen one. A named light is certain: its probability is 1.
bool sampleLightOfRound(SampleId id, SurfaceInteraction si, Bsdf bsdf, vec3 wo, PathState state, out ShadowRay ray)
{
    LightContext context = makeLightContext(si, bsdf);
    LightChoice choice = LightChoice(lightRound.light, 1.0, 0u);
    if (kDirect == kDirectMis) {
        choice = chooseLight(id, context, state.bounce);
    } else {
        id = splitSample(id, lightRound.light, lightRound.lightSample, lightRound.lightSamples);
    }
    noteLight(choice.light);
    LightSample sampled = sampleChosenLight(id, choice, context, state.bounce);
    return makeShadowRay(si, sampled, evalBsdf(bsdf, wo, sampled.wi), state, ray);
}

#endif
