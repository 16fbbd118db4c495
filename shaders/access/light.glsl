// Selects and samples lights, and evaluates the density of light that a ray has hit. A new kind of light adds its branches here.
#ifndef GLIM_ACCESS_LIGHT
#define GLIM_ACCESS_LIGHT

#include "lib/alias.glsl"
#include "lib/cone.glsl"
#include "lib/frame.glsl"
#include "lib/hash.glsl"
#include "lib/infinity.glsl"
#include "lib/punctual.glsl"
#include "lib/warp.glsl"
#include "environment_map.glsl"
#include "material.glsl"

// The point that light arrives at: where lights are sampled, or the origin of a ray that has hit a light by chance.
struct LightContext {
    vec3 p;   // origin of shadow rays on ng's side: only by this offset is a point on a sphere light's wall inside the light
    vec3 ng;  // unit, on the side that lights are sampled for; for a chance hit a copy of ns
    vec3 ns;  // unit; for a chance hit PathState's, rounded: code that selects lights by it must round it in both cases
};

// Light that could arrive at a point.
struct LightSample {
    vec3 wi;           // unit, towards the light
    vec3 radiance;     // radiance / pdf of wi per steradian, the light's probability included; 0: none
    float pdf;         // per steradian, the light's probability included; 0: a delta light, which no ray hits
    vec3 target;       // a point that shadow rays aim at, clear of the light's surface
    uint primitive;    // the light's surface, or kNoPrimitive
    float tMax;        // 1: the light is at `target`; infinity: it is infinitely far
};

const LightSample kNoLight = LightSample(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), kNoPrimitive, 1.0);

// Chooses a light by power.
uint selectLight(uvec2 bits, uint lightCount)
{
    uint bin = chooseBin(bits.x, lightCount);
    AliasEntry entry = fetchLight(bin).alias;
    return chooseAlias(bin, entry.threshold, entry.other, bits.y);
}

// Whether a sphere light is sampled by its cone, with sin^2 of the half angle; from within or on the surface it is sampled by area. `from`
// is relative to the centre.
bool seesCone(vec3 from, float radius, out float sin2)
{
    float distance2 = dot(from, from);
    sin2 = radius * radius / distance2;
    return sin2 < 1.0;
}

// Density per steradian of a direction towards a point of `light` at distance t, which it meets at |cos| `cosine`; the light's
// probability included. `areaPdf`: FlatEmitter's.
float pdfSurfaceLight(FlatLight light, float areaPdf, LightContext context, float t, float cosine)
{
    float sin2;
    if (hasFeature(kFeatureSphereLights) && light.kind == kSphereLight && seesCone(context.p - light.position, light.radius, sin2)) {
        return light.probability * pdfCone(sin2);
    }
    return light.probability * areaPdf * t * t / cosine;
}

// Density per steradian with which selecting and sampling lights would have found the emitter that a ray has hit at distance t and
// |cos| `cosine`.
float pdfEmitter(LightContext context, uint emitter, float t, float cosine)
{
    FlatEmitter data = fetchEmitter(emitter);
    return pdfSurfaceLight(fetchLight(data.light), data.areaPdf, context, t, cosine);
}

// The same of the environment in the direction wi. cosine: against the normal that lights were sampled for.
float pdfEnvironment(vec3 wi, float cosine)
{
    return fetchLight(render.environmentLight).probability * (hasEnvironmentMap() ? pdfEnvironmentMap(wi) : pdfCosineHemisphere(cosine));
}

// Whether its emission changes over the surface, by a texture, coverage or a coat.
#define isUneven(light) (hasFeature(kFeatureTextures | kFeatureAlpha | kFeatureClearcoat) && (light).uneven != 0u)

// A sampled point of an emitter.
struct EmitterPoint {
    uint record;
    vec3 p;
    vec2 barycentric;
    float cosine;  // of the direction that its light leaves in
};

// The samplers of surface lights give the light's own intensity as radiance, not divided by the pdf (sampleSurfaceLight).
LightSample sampleTriangleLight(FlatLight light, LightContext context, uvec2 choice, vec2 u, out EmitterPoint at)
{
    uint bin = chooseBin(choice.x, light.emitterCount);
    AliasEntry entry = fetchEmitter(light.firstEmitter + bin).alias;
    bin = chooseAlias(bin, entry.threshold, entry.other, choice.y);
    FlatEmitter emitter = fetchEmitter(light.firstEmitter + bin);
    Record record = fetchRecord(emitter.record);
    vec3 v0 = floatsOf(record.t0);
    vec3 e1 = floatsOf(record.t1) - v0;
    vec3 e2 = floatsOf(record.t2) - v0;
    vec2 barycentric = sampleTriangle(u);
    vec3 point = trianglePoint(v0, e1, e2, barycentric);
    vec3 n = triangleNormal(v0, floatsOf(record.t1), floatsOf(record.t2));
    vec3 towards = point - context.p;
    float distance_ = length(towards);
    float facing = -dot(n, towards) / distance_;
    float cosine = light.doubleSided != 0u ? abs(facing) : facing;
    float pdf = pdfSurfaceLight(light, emitter.areaPdf, context, distance_, cosine);
    vec3 target = offsetPoint(point, facing > 0.0 ? n : -n, triangleErrorBound(v0, e1, e2));
    bool faces = cosine > 0.0;
    at = EmitterPoint(emitter.record, point, barycentric, cosine);
    return LightSample(faces ? towards / distance_ : vec3(0.0), light.intensity, faces ? pdf : 0.0, target, emitter.primitive, 1.0);
}

// From outside: uniform in the cone.
LightSample sampleSphereCone(FlatLight light, FlatEmitter emitter, vec3 outward, float sin2, vec2 u, out EmitterPoint at)
{
    vec3 local = sampleCone(u, sin2);
    // The point of the sphere in the sampled direction, by its angle at the centre (pbrt-v4, section 6.2.4). Only shadow rays aim at it. wi
    // must not be computed from it: next to the surface, the point is the receiver itself.
    float sinLocal2 = dot(local.xy, local.xy);
    float across = sinLocal2 / sqrt(sin2) + local.z * sqrt(max(0.0, 1.0 - sinLocal2 / sin2));
    float sinCenter = sqrt(max(0.0, (1.0 - across) * (1.0 + across)));
    float planar = sqrt(sinLocal2);
    vec2 azimuth = planar > 0.0 ? local.xy / planar : vec2(0.0);
    Frame frame = makeFrame(outward / length(outward));
    vec3 n = worldFromFrame(frame, vec3(azimuth * sinCenter, across));
    float pdf = light.probability * pdfCone(sin2);
    vec3 point = light.position + light.radius * n;
    vec3 target = offsetPoint(point, n, sphereErrorBound(light.position, light.radius));
    vec3 wi = worldFromFrame(frame, vec3(local.xy, -local.z));
    at = EmitterPoint(emitter.record, point, vec2(0.0), abs(dot(n, wi)));
    return LightSample(wi, light.intensity, pdf, target, emitter.primitive, 1.0);
}

// From within a sphere that emits inwards too: uniform over its area.
LightSample sampleSphereArea(FlatLight light, FlatEmitter emitter, LightContext context, vec2 u, out EmitterPoint at)
{
    vec3 n = sampleSphere(u);
    vec3 point = light.position + light.radius * n;
    vec3 towards = point - context.p;
    float distance_ = length(towards);
    float cosine = dot(n, towards) / distance_;
    if (!(cosine > 0.0)) {
        return kNoLight;
    }
    float pdf = pdfSurfaceLight(light, emitter.areaPdf, context, distance_, cosine);
    vec3 target = offsetPoint(point, -n, sphereErrorBound(light.position, light.radius));
    at = EmitterPoint(emitter.record, point, vec2(0.0), cosine);
    return LightSample(towards / distance_, light.intensity, pdf, target, emitter.primitive, 1.0);
}

LightSample sampleSphereLight(FlatLight light, LightContext context, vec2 u, out EmitterPoint at)
{
    FlatEmitter emitter = fetchEmitter(light.firstEmitter);
    vec3 outward = context.p - light.position;
    float sin2;
    if (seesCone(outward, light.radius, sin2)) {
        return sampleSphereCone(light, emitter, outward, sin2, u, at);
    }
    return light.doubleSided != 0u ? sampleSphereArea(light, emitter, context, u, at) : kNoLight;
}

LightSample sampleSurfaceLight(FlatLight light, LightContext context, uvec2 choice, vec2 u)
{
    EmitterPoint at;
    LightSample s = kNoLight;
    if (hasFeature(kFeatureSphereLights) && light.kind == kSphereLight) {
        s = sampleSphereLight(light, context, u, at);
    } else if (hasFeature(kFeatureTriangleLights)) {
        s = sampleTriangleLight(light, context, choice, u, at);
    }
    if (isUneven(light) && s.pdf > 0.0) {
        s.radiance *= emissionFactor(fetchRecord(at.record), at.p, at.barycentric, at.cosine);
    }
    s.radiance = s.pdf > 0.0 ? s.radiance / s.pdf : vec3(0.0);
    return s;
}

LightSample samplePunctualLight(FlatLight light, vec3 from)
{
    if (light.kind == kDirectionalLight) {
        return LightSample(-light.direction, light.intensity / light.probability, 0.0, from - light.direction, kNoPrimitive,
                           kInfinity);
    }
    vec3 towards = light.position - from;
    float distance2 = dot(towards, towards);
    if (!(distance2 > 0.0)) {
        return kNoLight;
    }
    vec3 wi = towards / sqrt(distance2);
    float falloff = rangeFalloff(distance2, light.radius);
    if (light.kind == kSpotLight) {
        falloff *= spotFalloff(-dot(wi, light.direction), light.cosInner, light.cosOuter);
    }
    return LightSample(wi, light.intensity * falloff / distance2 / light.probability, 0.0, light.position, kNoPrimitive, 1.0);
}

// A constant environment is sampled by the cosine about the shading normal: on an open diffuse surface it has no variance.
LightSample sampleEnvironment(FlatLight light, LightContext context, vec2 u)
{
    vec3 local = sampleCosineHemisphere(u);
    float pdf = light.probability * pdfCosineHemisphere(local.z);
    if (!(pdf > 0.0)) {
        return kNoLight;
    }
    vec3 wi = worldFromFrame(makeFrame(context.ns), local);
    return LightSample(wi, light.intensity / pdf, pdf, context.p + wi, kNoPrimitive, kInfinity);
}

LightSample sampleEnvironmentMap(FlatLight light, LightContext context, uvec2 choice)
{
    float pdf;
    vec3 wi = sampleEnvironmentMap(choice, pdf);
    pdf *= light.probability;
    return LightSample(wi, environmentRadiance(wi) / pdf, pdf, context.p + wi, kNoPrimitive, kInfinity);
}

// The density includes `light.probability`. choice: two words of random bits, u in [0, 1)^2.
LightSample sampleLight(FlatLight light, LightContext context, uvec2 choice, vec2 u)
{
    if (hasFeature(kFeatureTriangleLights | kFeatureSphereLights) && (light.kind == kTriangleLight || light.kind == kSphereLight)) {
        return sampleSurfaceLight(light, context, choice, u);
    }
    if (hasEnvironment() && light.kind == kEnvironmentLight) {
        if (hasEnvironmentMap()) {
            return sampleEnvironmentMap(light, context, choice);
        }
        return sampleEnvironment(light, context, u);
    }
    if (hasFeature(kFeaturePunctualLights) && light.kind >= kPointLight && light.kind <= kDirectionalLight) {
        return samplePunctualLight(light, context.p);
    }
    return kNoLight;
}

#endif
