// Chooses and samples lights, and says with which probability it would have.
#ifndef GLIM_ACCESS_LIGHT
#define GLIM_ACCESS_LIGHT

#include "lib/alias.glsl"
#include "lib/cone.glsl"
#include "lib/frame.glsl"
#include "lib/hash.glsl"
#include "lib/infinity.glsl"
#include "lib/punctual.glsl"
#include "lib/warp.glsl"
#include "surface.glsl"

// Light that could arrive at a point.
struct LightSample {
    vec3 wi;           // unit, towards the light
    vec3 radiance;     // radiance / pdf of wi per steradian, the light's probability included; 0: none
    float pdf;         // per steradian, the light's probability included; 0: delta, nothing else can find it
    vec3 target;       // a point that shadow rays aim at, clear of the light's surface
    uint primitive;    // the light's surface, or kNoPrimitive
    float reach;       // 1: the light is at `target`; infinity: it is infinitely far
};

const LightSample kNoLight = LightSample(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), kNoPrimitive, 1.0);

uint chooseLight(uvec2 bits, uint lightCount)
{
    uint bin = chooseBin(bits.x, lightCount);
    AliasEntry entry = fetchLight(bin).alias;
    return chooseAlias(bin, entry.threshold, entry.other, bits.y);
}

// Cone or, from within or on the surface, area: true and sin^2 of the half angle for the cone. `from` relative to the centre.
bool seesCone(vec3 from, float radius, out float sin2)
{
    float distance2 = dot(from, from);
    sin2 = radius * radius / distance2;
    return sin2 < 1.0;
}

// Density per steradian of a direction towards a point of `light` at distance `t`, met under `cosine` by `emitter`, seen
// `from`; the light's probability included.
float pdfSurfaceLight(FlatEmitter emitter, FlatLight light, vec3 from, float t, float cosine)
{
    float sin2;
    if (kSphereLights && light.kind == kSphereLight && seesCone(from - light.position, light.radius, sin2)) {
        return light.probability * pdfCone(sin2);
    }
    return light.probability * emitter.areaPdf * t * t / cosine;
}

LightSample sampleTriangleLight(FlatLight light, vec3 from, uvec2 choice, vec2 u)
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
    vec3 towards = point - from;
    float distance_ = length(towards);
    float facing = -dot(n, towards) / distance_;
    float cosine = light.doubleSided != 0u ? abs(facing) : facing;
    if (!(cosine > 0.0)) {
        return kNoLight;
    }
    float pdf = pdfSurfaceLight(emitter, light, from, distance_, cosine);
    vec3 target = offsetPoint(point, facing > 0.0 ? n : -n, triangleErrorBound(v0, e1, e2));
    return LightSample(towards / distance_, light.intensity / pdf, pdf, target, emitter.primitive, 1.0);
}

// From outside: uniform in the cone.
LightSample sampleSphereCone(FlatLight light, uint primitive, vec3 outward, float sin2, vec2 u)
{
    vec3 local = sampleCone(u, sin2);
    // The point of the sphere under the sampled direction (pbrt-v4, section 6.2.4): the angle at the centre. Only shadow rays
    // aim at it: next to the surface it is the receiver itself, and wi must not come from their difference.
    float sinLocal2 = dot(local.xy, local.xy);
    float across = sinLocal2 / sqrt(sin2) + local.z * sqrt(max(0.0, 1.0 - sinLocal2 / sin2));
    float sinCenter = sqrt(max(0.0, (1.0 - across) * (1.0 + across)));
    float planar = sqrt(sinLocal2);
    vec2 azimuth = planar > 0.0 ? local.xy / planar : vec2(0.0);
    Frame frame = makeFrame(outward / length(outward));
    vec3 n = worldFromFrame(frame, vec3(azimuth * sinCenter, across));
    float pdf = light.probability * pdfCone(sin2);
    vec3 target = offsetPoint(light.position + light.radius * n, n, sphereErrorBound(light.position, light.radius));
    return LightSample(worldFromFrame(frame, vec3(local.xy, -local.z)), light.intensity / pdf, pdf, target, primitive, 1.0);
}

// From within a sphere that emits inwards too: uniform over its area.
LightSample sampleSphereArea(FlatLight light, FlatEmitter emitter, vec3 from, vec2 u)
{
    vec3 n = sampleSphere(u);
    vec3 point = light.position + light.radius * n;
    vec3 towards = point - from;
    float distance_ = length(towards);
    float cosine = dot(n, towards) / distance_;
    if (!(cosine > 0.0)) {
        return kNoLight;
    }
    float pdf = pdfSurfaceLight(emitter, light, from, distance_, cosine);
    vec3 target = offsetPoint(point, -n, sphereErrorBound(light.position, light.radius));
    return LightSample(towards / distance_, light.intensity / pdf, pdf, target, emitter.primitive, 1.0);
}

LightSample sampleSphereLight(FlatLight light, vec3 from, vec2 u)
{
    FlatEmitter emitter = fetchEmitter(light.firstEmitter);
    vec3 outward = from - light.position;
    float sin2;
    if (seesCone(outward, light.radius, sin2)) {
        return sampleSphereCone(light, emitter.primitive, outward, sin2, u);
    }
    return light.doubleSided != 0u ? sampleSphereArea(light, emitter, from, u) : kNoLight;
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
    float falloff =
        light.kind == kSpotLight ? spotFalloff(-dot(wi, light.direction), light.cosInner, light.cosOuter) : 1.0;
    return LightSample(wi, light.intensity * falloff / distance2 / light.probability, 0.0, light.position, kNoPrimitive, 1.0);
}

// A constant environment is sampled by the cosine about the shading normal: against Lambert its variance is nil.
LightSample sampleEnvironment(FlatLight light, vec3 from, vec3 normal, vec2 u)
{
    vec3 local = sampleCosineHemisphere(u);
    float pdf = light.probability * pdfCosineHemisphere(local.z);
    if (!(pdf > 0.0)) {
        return kNoLight;
    }
    vec3 wi = worldFromFrame(makeFrame(normal), local);
    return LightSample(wi, light.intensity / pdf, pdf, from + wi, kNoPrimitive, kInfinity);
}

// `from`: the point that rays leave the receiver from, not on it: the wall of a sphere light sees it from within only by that.
// `certain`: every light is sampled, so that its probability is 1.
LightSample sampleLight(uint index, bool certain, vec3 from, vec3 normal, uvec2 choice, vec2 u)
{
    FlatLight light = fetchLight(index);
    if (certain) {
        light.probability = 1.0;
    }
    if (kTriangleLights && light.kind == kTriangleLight) {
        return sampleTriangleLight(light, from, choice, u);
    }
    if (kSphereLights && light.kind == kSphereLight) {
        return sampleSphereLight(light, from, u);
    }
    if (kEnvironment && light.kind == kEnvironmentLight) {
        return sampleEnvironment(light, from, normal, u);
    }
    if (kPunctualLights && light.kind >= kPointLight && light.kind <= kDirectionalLight) {
        return samplePunctualLight(light, from);
    }
    return kNoLight;
}

#endif
