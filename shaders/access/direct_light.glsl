// Direct light at a vertex: by sampling a light, and by what the path's own ray has hit.
#ifndef GLIM_ACCESS_DIRECT_LIGHT
#define GLIM_ACCESS_DIRECT_LIGHT

#include "bsdf.glsl"
#include "lib/media.glsl"
#include "lib/octahedral.glsl"
#include "light.glsl"
#include "notes.glsl"
#include "pass.glsl"

// If a lobe that is not delta transmits, the side is unknown before wi is: p is then the point itself.
LightContext makeLightContext(SurfaceInteraction si, Bsdf bsdf)
{
    return LightContext(transmitsDiffusely(bsdf) ? si.p : offsetRayOrigin(si, si.ng), bsdf.frame.z,
                        decodeReceiverNormal(encodeReceiverNormal(bsdf)), 0u);
}

// What is known of lights at a light context's point. The including file defines it: path_vertex.glsl, and course/direct_light.glsl for the
// course.
uint fetchSight(vec3 p, vec3 receiverNormal);

// The context of the vertex that the path's ray has left.
LightContext previousContext(PathRay ray, PathState state)
{
    vec3 n = decodeReceiverNormal(state.normal);
    return LightContext(ray.origin, n, n, fetchSight(ray.origin, n));
}

// MIS weights. The including file defines them: path_vertex.glsl, and course/direct_light.glsl for the course. The first is of light that
// a ray has hit, if light sampling has the density lightPdf for it; the second is of a light sample, a delta light's if lightPdf is 0.
float misWeightOfHit(PathState state, float lightPdf);
float misWeightOfSample(float lightPdf, float bsdfPdf);

// Whether the light that the ray has hit is a caustic of the kind that light paths find.
bool isCaustic(PathRay ray, PathState state)
{
    return hasFeature(kFeatureCaustics) && !(state.pdf > 0.0) && (ray.media & (kIsDiffuseFirst | kHasScattered)) == kIsDiffuseFirst;
}

// Radiance of the environment that an escaping ray has hit, times its MIS weight.
vec3 weightedEnvironment(PathRay ray, PathState state)
{
    bool scattered = hasFeature(kFeatureScattering) && (ray.media & kHasScattered) != 0u;
    if (state.bounce == 0u && render.hidesEnvironment != 0u && !scattered) {
        return vec3(0.0);
    }
    if (hasFeature(kFeatureBrightEnvironment) && isCaustic(ray, state)) {
        return splitEnvironmentRadiance(ray.direction, false);
    }
    vec3 radiance = hasEnvironmentMap() ? environmentRadiance(ray.direction) : render.environment;
    return radiance * misWeightOfHit(state, pdfEnvironment(previousContext(ray, state), ray.direction, state.cosine));
}

// Radiance that the surface at the end of a ray emits back along it, times its MIS weight.
vec3 weightedEmission(SurfaceInteraction si, MaterialData material, PathRay ray, PathHit hit, PathState state)
{
    vec3 emission = emittedRadiance(si, material);
    if (hasFeature(kFeatureLines) && si.light == kUnsampledLight) {
        return emission;
    }
    if (isCaustic(ray, state)) {
        return vec3(0.0);
    }
    if (all(equal(emission, vec3(0.0))) || !(state.pdf > 0.0)) {
        return emission;
    }
    float pdf = pdfSurfaceLight(previousContext(ray, state), si.light - 1u, hit.t, abs(dot(si.ng, ray.direction)));
    return emission * misWeightOfHit(state, pdf);
}

// Uses the sampler dimensions of the bounce.
LightChoice chooseLight(SampleId id, LightContext context, uint bounce)
{
    return chooseLight(context, samplePair(id, bounceDimension(bounce, kDimensionLight), kSobol));
}

LightSample sampleChosenLight(SampleId id, LightChoice choice, LightContext context, uint bounce)
{
    return sampleLight(fetchLight(choice.light), choice.probability, context,
                       samplePair(id, bounceDimension(bounce, kDimensionPoint), kSobol));
}

// The shadow ray of a light sample, which starts on the side of wi. Its contribution counts if nothing is in the way. False if that is zero.
// f: the BSDF at light.wi.
bool makeShadowRay(SurfaceInteraction si, LightSample light, BsdfEval f, PathState state, out ShadowRay ray)
{
    float weight = misWeightOfSample(light.pdf, f.pdf);
    if (f.pdf > 0.0) {
        noteLightSample(light.pdf, f.pdf, weight);
    }
    vec3 contribution = state.throughput * f.f * light.radiance * weight;
    vec3 origin = offsetRayOrigin(si, light.wi);
    bool infinite = light.tMax > 1.0;
    ray = ShadowRay(origin, si.primitive, infinite ? light.wi : light.target - origin, light.primitive, contribution, light.tMax);
    return any(notEqual(contribution, vec3(0.0)));
}

#endif
