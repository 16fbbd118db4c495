// Begins light paths: at lights, towards specular surfaces. host/flatten/caustics.hpp makes what they choose from.
#ifndef GLIM_ACCESS_LIGHT_PATH
#define GLIM_ACCESS_LIGHT_PATH

#include "lib/caustic_target.glsl"
#include "light.glsl"
#include "pass.glsl"

layout(set = 0, binding = kBindCaustics) uniform usamplerBuffer sceneCaustics;

struct LightRay {
    PathRay ray;
    vec3 flux;    // over the density of the ray, W; 0: there is none
    float range;  // of the light, at the first surface; 0: unlimited
    float density;  // of the ray, per area across it and steradian; 0: the light has no extent
};

const LightRay kNoLightRay = LightRay(PathRay(vec3(0.0), kNoPrimitive, vec3(0.0, 0.0, 1.0), 0u), vec3(0.0), 0.0, 0.0);

vec4 fetchTarget(uint target)
{
    return uintBitsToFloat(texelFetch(sceneCaustics, int(target)));
}

// The light that a random word chooses, and its probability.
LightChoice chooseCausticLight(uint word)
{
    uvec4 entry = texelFetch(sceneCaustics, int(kFirstCausticLight + chooseBin(word, render.causticLights)));
    uint low = entry.z, high = entry.w, middle;
    bool going;
    do {
        middle = low + ((high - low) >> 1u);
        entry = texelFetch(sceneCaustics, int(kFirstCausticLight + middle));
        going = searchesOn(entry, word, middle, low, high);
    } while (going);
    return LightChoice(middle, (float(entry.y - entry.x) + 1.0) * (1.0 / 4294967296.0), 0u);
}

// A direction to one of the targets, chosen by importance; and its density per steradian, by any of them. 0: the emitter reaches no target.
vec3 sampleTargets(Emitter emitter, float uTarget, vec2 u, out float pdf)
{
    float sum = 0.0;
    uint i = 0u;
    do {
        sum += makeTargetCone(fetchTarget(i), emitter).importance;
    } while (++i < render.causticTargets);
    float below = 0.0;
    uint chosen = 0u;
    i = 0u;
    do {
        float importance = makeTargetCone(fetchTarget(i), emitter).importance;
        chosen = importance > 0.0 && uTarget * sum >= below ? i : chosen;
        below += importance;
    } while (++i < render.causticTargets);
    vec3 w = sampleTargetCone(makeTargetCone(fetchTarget(chosen), emitter), emitter, u);
    pdf = 0.0;
    i = 0u;
    do {
        TargetCone cone = makeTargetCone(fetchTarget(i), emitter);
        pdf += i == chosen || isInCone(cone, w) ? cone.importance / cone.solidAngle : 0.0;
    } while (++i < render.causticTargets);
    pdf = sum > 0.0 ? pdf / sum : 0.0;
    return w;
}

// From a uniform point of a surface light.
LightRay sampleSurfaceEmission(FlatLight light, vec2 uPoint, float uTarget, vec2 u)
{
    bool sphere = isSphereLight(light), rectangle = isRectangleLight(light);
    vec2 barycentric = rectangle ? uPoint : sampleTriangle(uPoint);
    vec3 n = sphere ? sampleSphere(uPoint) : computeLightNormal(light);
    vec3 p = sphere ? light.position + light.size * n : trianglePoint(light.position, light.edge1, light.edge2, barycentric);
    float area = sphere ? 4.0 * kPi * light.size * light.size : light.size;
    float pdf;
    vec3 w = sampleTargets(Emitter(p, isDoubleSided(light) ? kEmitsFromBoth : kEmitsInFront, n, 0.0, 0.0), uTarget, u, pdf);
    float facing = dot(n, w), cosine = isDoubleSided(light) ? abs(facing) : facing;
    if (!(pdf > 0.0) || !(cosine > 0.0)) {
        return kNoLightRay;
    }
    vec3 radiance = light.intensity;
    if (isUneven(light)) {
        radiance *= emissionFactor(fetchPlacedPrimitive(light.primitiveRef), p, barycentric, cosine);
    }
    vec3 error = sphere ? sphereErrorBound(light.position, light.size) : triangleErrorBound(light.position, light.edge1, light.edge2, hasFeature(kFeatureLargeTriangles));
    uint primitive = rectangle && barycentric.x + barycentric.y > 1.0 ? light.otherPrimitive : light.primitive;
    return LightRay(PathRay(offsetPoint(p, facing > 0.0 ? n : -n, error), primitive, w, 0u), radiance * (area * cosine / pdf), 0.0,
                    pdf / (area * cosine));
}

// Parallel light, through a uniform point of the targets' shadows on a plane across it, from before the whole scene. direction: unit, of
// the rays, and their density per steradian. irradiance: of the plane.
LightRay sampleParallelEmission(vec3 direction, vec3 irradiance, float density, float uTarget, vec2 u)
{
    float sum = 0.0;
    uint i = 0u;
    do {
        vec4 target = fetchTarget(i);
        sum += kPi * target.w * target.w;
    } while (++i < render.causticTargets);
    float below = 0.0;
    uint chosen = 0u;
    i = 0u;
    do {
        float radius = fetchTarget(i).w;
        chosen = uTarget * sum >= below ? i : chosen;
        below += kPi * radius * radius;
    } while (++i < render.causticTargets);
    vec4 target = fetchTarget(chosen);
    vec2 disk = sampleDisk(u) * target.w;
    Frame frame = makeFrame(direction);
    vec3 p = target.xyz + frame.x * disk.x + frame.y * disk.y;
    float covers = 0.0;
    i = 0u;
    do {
        vec4 other = fetchTarget(i);
        vec3 offset = p - other.xyz;
        vec3 across = offset - direction * dot(offset, direction);
        covers += i == chosen || dot(across, across) <= other.w * other.w ? 1.0 : 0.0;
    } while (++i < render.causticTargets);
    vec4 scene = fetchTarget(kSceneSphere);
    vec3 origin = p - direction * (dot(p - scene.xyz, direction) + 1.01 * scene.w);
    return LightRay(PathRay(origin, kNoPrimitive, direction, 0u), irradiance * (sum / covers), 0.0, density * covers / sum);
}

// From a direction of the environment map's bright part. words: which cell, and where in it.
LightRay sampleEnvironmentEmission(uvec2 words, float uTarget, vec2 u)
{
    uint first = kFirstCausticLight + render.causticLights, low = 0u, high = render.brightCells - 1u, middle;
    uvec4 entry;
    bool going;
    do {
        middle = (low + high) >> 1u;
        entry = texelFetch(sceneCaustics, int(first + middle));
        going = searchesOn(entry, words.x, middle, low, high);
    } while (going);
    uint row = entry.z / render.environmentCells.x, column = entry.z - row * render.environmentCells.x;
    vec3 w = directionInCell(row, column, vec2(placeInEntry(entry, words.x), unitFloat(words.y)));
    float pdf = uintBitsToFloat(entry.w);
    return sampleParallelEmission(-w, splitEnvironmentRadiance(w, true) / pdf, pdf, uTarget, u);
}

// Of all targets, together at most.
float computeTargetsSolidAngle(Emitter emitter)
{
    float sum = 0.0;
    uint i = 0u;
    do {
        sum += makeTargetCone(fetchTarget(i), emitter).solidAngle;
    } while (++i < render.causticTargets);
    return sum;
}

// A spot that is narrower than the targets is sampled by its own cone.
LightRay samplePointEmission(FlatLight light, float uTarget, vec2 u)
{
    bool spot = getLightKind(light) == kSpotLight;
    vec3 axis = spot ? light.edge1 : vec3(0.0, 0.0, 1.0);
    Emitter emitter = Emitter(light.position, spot ? kEmitsSpot : kEmitsAround, axis, light.versineInner, light.versineOuter);
    float pdf;
    vec3 w = sampleTargets(emitter, uTarget, u, pdf);
    float outer = light.versineOuter;
    if (spot && outer < 1.0 && 2.0 * kPi * outer < computeTargetsSolidAngle(emitter)) {
        float sin2 = outer * (2.0 - outer);
        w = worldFromFrame(makeFrame(axis), sampleCone(u, sin2));
        pdf = pdf > 0.0 ? pdfCone(sin2) : 0.0;
    }
    float falloff = spot ? spotFalloff(versine(w, axis), light.versineInner, outer) : 1.0;
    if (!(pdf > 0.0) || !(falloff > 0.0)) {
        return kNoLightRay;
    }
    return LightRay(PathRay(light.position, kNoPrimitive, w, 0u), light.intensity * (falloff / pdf), light.size, 0.0);
}

// The flux includes the light's probability. group: the light's.
LightRay sampleEmission(SampleId id, out uint group)
{
    uvec2 which = lightPathPair(id, render.lightPaths, kDimensionEmitter, kSobol);
    uvec2 where = lightPathPair(id, render.lightPaths, kDimensionEmission, kSobol);
    vec2 u = unitFloat(lightPathPair(id, render.lightPaths, kDimensionAim, kSobol));
    LightChoice choice = chooseCausticLight(which.x);
    FlatLight light = fetchLight(choice.light);
    uint kind = getLightKind(light);
    group = lightGroupOf(light.kind);
    float uTarget = unitFloat(which.y);
    LightRay from = kNoLightRay;
    if (hasFeature(kFeatureTriangleLights | kFeatureRectangleLights | kFeatureSphereLights) && kind <= kSphereLight) {
        from = sampleSurfaceEmission(light, unitFloat(where), uTarget, u);
    } else if (hasFeature(kFeatureBrightEnvironment) && kind == kEnvironmentLight) {
        from = sampleEnvironmentEmission(where, uTarget, u);
    } else if (hasFeature(kFeaturePunctualLights)) {
        if (kind == kDirectionalLight) {
            from = sampleParallelEmission(light.edge1, light.intensity, 0.0, uTarget, u);
        } else {
            from = samplePointEmission(light, uTarget, u);
        }
    }
    from.flux /= choice.probability;
    from.density *= choice.probability;
    return from;
}

#endif
