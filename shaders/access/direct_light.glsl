// The light that a path finds, by its own ray or by sampling lights, each weighted against the other.
#ifndef GLIM_ACCESS_DIRECT_LIGHT
#define GLIM_ACCESS_DIRECT_LIGHT

#include "lib/mis.glsl"
#include "lib/scatter.glsl"
#include "light.glsl"
#include "notes.glsl"
#include "pass.glsl"

// What light that a ray has found counts if sampling lights has density `other` for it, and what light counts that sampling
// lights has found if the scattered ray has that density. Cameras, mirrors and glass leave it to the ray alone, delta lights
// to the sample.
float weightFound(PathState state, float other)
{
    if (!(state.pdf > 0.0) || kDirect == kDirectBsdf) {
        return 1.0;
    }
    float weight = kDirect == kDirectMis ? weightPower(state.pdf, other) : 0.0;
    noteFound(other, weight);
    return weight;
}

float weightSampled(float pdf, float other)
{
    return kDirect == kDirectMis && pdf > 0.0 ? weightPower(pdf, other) : 1.0;
}

vec3 environmentFound(PathState state)
{
    float other = fetchLight(pass.environmentLight).probability * pdfLambert(state.cosine);
    return pass.environment * weightFound(state, other);
}

vec3 emissionFound(PathRay ray, PathHit hit, PathState state, Surface surface, FlatMaterial material)
{
    vec3 emission = emittedRadiance(surface, material);
    if (all(equal(emission, vec3(0.0))) || !(state.pdf > 0.0)) {
        return emission;
    }
    FlatEmitter emitter = fetchEmitter(surface.emitter - 1u);
    float cosine = abs(dot(surface.geometric, ray.direction));
    float other = pdfSurfaceLight(emitter, fetchLight(emitter.light), ray.origin, hit.t, cosine);
    return emission * weightFound(state, other);
}

// The radiance of one light that the round chooses, seen `from` the point that rays leave the surface from.
LightSample sampleLightOfRound(SampleId id, uint bounce, vec3 from, vec3 normal)
{
    uint chosen = pass.light;
    if (kDirect == kDirectMis) {
        chosen = chooseLight(samplePair(id, bounceDimension(bounce, kDimensionLight), kSobol), pass.lightCount);
    } else {
        id = splitSample(id, pass.light, pass.lightSample, pass.lightSamples);
    }
    noteLight(chosen);
    return sampleLight(chosen, kDirect != kDirectMis, from, normal,
                       samplePair(id, bounceDimension(bounce, kDimensionEmitter), kSobol),
                       unitFloat(samplePair(id, bounceDimension(bounce, kDimensionPoint), kSobol)));
}

// A round of direct light at a surface that the path met `bounce` surfaces after the camera. False if no light can arrive; else the
// shadow ray carries the radiance that the light sends on towards the camera if nothing shadows it.
bool sampleDirectLight(SampleId id, uint bounce, PathState state, Surface surface, FlatMaterial material, out ShadowRay ray)
{
    vec3 origin = leavePoint(surface, surface.geometric);
    LightSample light = sampleLightOfRound(id, bounce, origin, surface.shading);
    float cosine = dot(light.wi, surface.shading);
    if (!(cosine > 0.0 && dot(light.wi, surface.geometric) > 0.0)) {
        return false;
    }
    float weight = weightSampled(light.pdf, pdfLambert(cosine));
    if (kDirect == kDirectLights) {
        weight /= float(pass.lightSamples);
    }
    noteLightSample(light.pdf, pdfLambert(cosine), weight);
    vec3 contribution = state.throughput * evalLambert(material.baseColor, cosine) * light.radiance * (cosine * weight);
    if (all(equal(contribution, vec3(0.0)))) {
        return false;
    }
    bool infinite = light.reach > 1.0;
    ray = ShadowRay(origin, surface.primitive, infinite ? light.wi : light.target - origin, light.primitive, contribution, light.reach);
    return true;
}

#endif
