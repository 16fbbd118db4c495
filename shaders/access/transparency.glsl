// Surfaces that are transparent in places, and smooth thin walls, which light passes straight. Closest hits are accepted by a number that
// depends on (pixel, sample, bounce, primitive) alone; shadow rays multiply what each surface lets through, in the order along the ray. So
// neither depends on the tree, on the schedule or on how primitives were split.
#ifndef GLIM_ACCESS_TRANSPARENCY
#define GLIM_ACCESS_TRANSPARENCY

#include "bvh_traversal.glsl"
#include "shared/luminance.h"
#include "material.glsl"
#include "pass.glsl"
#include "status.glsl"

// Surfaces that a ray passes; the next one counts as opaque, and the ray is counted.
const uint kMaxPassed = 256u;

vec3 geometricNormal(PlacedPrimitive placed, vec3 point)
{
    return isSphere(placed.ref) ? normalizeSafely(point - sphereCenter(placed.ref, point)) : placedNormal(placed);
}

// What the interface of a smooth thin wall transmits straight, per channel: 1 - F, by the geometric normal.
vec3 straightFresnel(PlacedPrimitive placed, PrincipledData p, vec3 direction, vec3 point)
{
    vec3 n = geometricNormal(placed, point);
    vec3 f0 = min(p.reflectance * p.specularColor, vec3(1.0)) * p.specular;
    return 1.0 - f0 - (p.specular - f0) * schlickWeight(abs(dot(n, direction)));
}

// A surface on the way of a ray.
struct Crossing {
    float alpha;   // coverage
    vec3 through;  // what goes on behind it: 1 - alpha, and what the covered part transmits straight
};

// seesUnlit: the ray is the camera's. direction: unit.
Crossing computeCrossing(PlacedPrimitive placed, PathRay ray, vec3 direction, PathHit hit, bool seesUnlit)
{
    vec3 point = ray.origin + ray.direction * hit.t;
    MaterialData data = fetchMaterial(getMaterial(placed.ref));
    if (isUnlit(data) && !seesUnlit) {
        return Crossing(0.0, vec3(1.0));
    }
    float alpha = data.alpha;
    vec3 straight = vec3(0.0);
    if (hasFeature(kFeaturePrincipled) && data.principled != 0u) {
        PrincipledData p = fetchPrincipled(data.principled);
        bool thin = hasFeature(kFeatureThinWalls) && passesStraight(data);
        vec4 uv = textureCoordinates(placed, point, hit.barycentric), color = vertexColor(placed, hit.barycentric);
        ThreeTexels texels = sampleTextures(uvec3(textureIn(p, kSlotBaseColor), thin ? textureIn(p, kSlotTransmission) : 0u, 0u), uv);
        alpha *= color.a * texels.x.a;
        if (thin) {
            straight = data.baseColor * color.rgb * texels.x.rgb * (fetchLayers(p.layers).transmission * texels.y.r * (1.0 - p.metallic)) *
                       straightFresnel(placed, p, direction, point);
        }
    }
    alpha = computeCoverage(data, alpha);
    Crossing crossing = Crossing(alpha, vec3(1.0 - alpha));
    if (hasFeature(kFeatureThinWalls)) {
        crossing.through += alpha * straight;
    }
    return crossing;
}

// Whether the ray goes on behind the surface, as by IgnoreHit of an any-hit shader. `weight` multiplies its throughput in either case. The
// two sides of a sphere draw for themselves.
bool ignoresHit(SampleId id, uint bounce, PrimitiveRef ref, PathRay ray, PathHit hit, Crossing crossing, out vec3 weight)
{
    vec3 point = ray.origin + ray.direction * hit.t;
    bool leaves = isSphere(ref) && dot(point - sphereCenter(ref, point), ray.direction) > 0.0;
    uint bits = hash4(uvec4(id.pixel, id.index, kDimensionAlpha | bounce << 1u | uint(leaves),
                            id.seed ^ getPrimitive(ref) * 0x9e3779b9u)).x;
    if (!hasFeature(kFeatureThinWalls)) {
        weight = vec3(1.0);
        return unitFloat(bits) >= crossing.alpha;
    }
    float probability = computeLuminance(crossing.through);
    bool passes = !(unitFloat(bits) < 1.0 - probability);
    weight = passes ? crossing.through / probability : vec3(crossing.alpha / (1.0 - probability));
    return passes;
}

struct VisibleHit {
    PathHit hit;
    vec3 weight;  // of what the ray carries
};

// A ray that goes on through surfaces with alpha.
struct AlphaRay {
    PathRay ray;
    vec3 direction;  // unit
    Query query;
    bool isShadow;  // each surface dims it; else each stops it or lets it pass
    bool fromCamera;  // of shadow rays: it sees unlit surfaces
};

AlphaRay makeAlphaRay(PathRay ray)
{
    return AlphaRay(ray, ray.direction, unrestrictedQuery(), false, false);
}

// Only surfaces with alpha are looked for. `sides`: of single-sided ones.
AlphaRay makeAlphaRay(ShadowRay ray, uint sides)
{
    return AlphaRay(PathRay(ray.origin, ray.source, ray.direction, 0u), normalizeSafely(ray.direction),
                    Query(ray.tMax, 0.0, kNoPrimitive, ray.target, true, sides), true, false);
}

// The first hit that the ray does not pass, or of a shadow ray what all of them let through. Both in one function, so that trace_paths has
// one copy of the traversal. `id`, `bounce`: unused for shadow rays.
VisibleHit traceThroughAlpha(SampleId id, uint bounce, AlphaRay alphaRay, inout Steps steps)
{
    if (!hasFeature(kFeatureAlpha)) {
        return VisibleHit(traceClosest(alphaRay.ray, alphaRay.query, steps), vec3(1.0));
    }
    PathHit hit;
    vec3 weight = vec3(1.0);
    uint passed = 0u;
    bool passes = false;
    do {
        hit = traceClosest(alphaRay.ray, alphaRay.query, steps);
        passes = false;
        if (hit.primitiveRef != kNoPrimitiveRef) {
            PlacedPrimitive placed = fetchPlacedPrimitive(hit.primitiveRef);
            PrimitiveRef ref = placed.ref;
            if (hasAlpha(ref)) {
                bool fromCamera = alphaRay.fromCamera || (!alphaRay.isShadow && bounce == 0u);
                Crossing crossing = computeCrossing(placed, alphaRay.ray, alphaRay.direction, hit, fromCamera);
                vec3 factor = crossing.through;
                passes = any(greaterThan(weight * factor, vec3(0.0)));
                if (!alphaRay.isShadow) {
                    passes = ignoresHit(id, bounce, ref, alphaRay.ray, hit, crossing, factor);
                }
                weight *= factor;
            }
            alphaRay.query.afterT = hit.t;
            alphaRay.query.afterPrimitive = getPrimitive(ref);
        }
        ++passed;
    } while (passes && passed <= kMaxPassed);
    if (passes) {
        reportTransparencyCap();
        weight = alphaRay.isShadow ? vec3(0.0) : weight;
    }
    return VisibleHit(hit, weight);
}

VisibleHit traceVisible(SampleId id, uint bounce, PathRay ray, uint sides, inout Steps steps)
{
    AlphaRay alphaRay = makeAlphaRay(ray);
    alphaRay.query.sides = sides;
    return traceThroughAlpha(id, bounce, alphaRay, steps);
}

VisibleHit traceVisible(SampleId id, uint bounce, PathRay ray, inout Steps steps)
{
    return traceVisible(id, bounce, ray, kFronts, steps);
}

// What the shadow ray's way lets through, per channel, in [0, 1].
vec3 transmittance(ShadowRay ray, uint sides)
{
    Steps uncounted = Steps(0u, 0u);
    bool metAlpha;
    vec3 clear = vec3(isUnoccluded(ray, sides, uncounted, metAlpha) ? 1.0 : 0.0);
    if (hasFeature(kFeatureAlpha) && metAlpha && clear.x > 0.0) {
        clear = traceThroughAlpha(SampleId(0u, 0u, 0u), 0u, makeAlphaRay(ray, sides), uncounted).weight;
    }
    return clear;
}

vec3 transmittance(ShadowRay ray)
{
    return transmittance(ray, kFronts);
}

bool isClear(vec3 clear)
{
    return hasFeature(kFeatureThinWalls) ? any(greaterThan(clear, vec3(0.0))) : clear.x > 0.0;
}

// What is left of a contribution; without alpha, the same bits.
vec3 attenuate(vec3 contribution, vec3 clear)
{
    return hasFeature(kFeatureAlpha) ? contribution * clear : contribution;
}

#endif
