// Surfaces that are transparent in places. Closest hits are accepted with probability alpha, by a number that depends on (pixel, sample,
// bounce, primitive) alone; shadow rays multiply what each surface lets through, in the order along the ray. So neither depends on the
// tree, on the schedule or on how primitives were split.
#ifndef GLIM_ACCESS_TRANSPARENCY
#define GLIM_ACCESS_TRANSPARENCY

#include "bvh_traversal.glsl"
#include "material.glsl"
#include "pass.glsl"
#include "status.glsl"

// Surfaces that a ray passes; the next one counts as opaque, and the ray is counted.
const uint kMaxPassed = 256u;

float alphaOf(Record record, PathRay ray, PathHit hit)
{
    return alphaOf(record, ray.origin + ray.direction * hit.t, hit.barycentric);
}

// The two sides of a sphere draw for themselves.
bool isPassed(SampleId id, uint bounce, Record record, PathRay ray, PathHit hit)
{
    bool leaves = isSphere(record) && dot(ray.origin + ray.direction * hit.t - floatsOf(record.t0), ray.direction) > 0.0;
    uint bits = hash4(uvec4(id.pixel, id.index, kDimensionAlpha | bounce << 1u | uint(leaves), id.seed ^ primitiveOf(record) * 0x9e3779b9u)).x;
    return unitFloat(bits) >= alphaOf(record, ray, hit);
}

// The closest hit that the ray does not pass.
PathHit traceVisible(SampleId id, uint bounce, PathRay ray, inout Steps steps)
{
    Query query = anyHit();
    if (!hasFeature(kFeatureAlpha)) {
        return traceClosest(ray, query, steps);
    }
    PathHit hit;
    uint passed = 0u;
    bool passes = false;
    do {
        hit = traceClosest(ray, query, steps);
        passes = false;
        if (hit.record != kNoRecord) {
            Record record = fetchRecord(hit.record);
            passes = hasAlpha(record) && isPassed(id, bounce, record, ray, hit);
            query.afterT = hit.t;
            query.afterPrimitive = primitiveOf(record);
        }
        ++passed;
    } while (passes && passed <= kMaxPassed);
    if (passes) {
        reportTransparencyCap();
    }
    return hit;
}

// What the shadow ray's way lets through, in [0, 1].
float transmittance(ShadowRay shadow, inout Steps steps)
{
    bool metAlpha;
    float clear = isUnoccluded(shadow, steps, metAlpha) ? 1.0 : 0.0;
    if (!hasFeature(kFeatureAlpha)) {
        return clear;
    }
    PathRay ray = PathRay(shadow.origin, shadow.source, shadow.direction, 0u);
    Query query = Query(shadow.tMax, 0.0, kNoPrimitive, shadow.target, true);
    uint passed = 0u;
    bool going = metAlpha && clear > 0.0;
    if (going) {
        do {
        PathHit hit = traceClosest(ray, query, steps);
        going = hit.record != kNoRecord;
        if (going) {
            Record record = fetchRecord(hit.record);
            clear *= 1.0 - alphaOf(record, ray, hit);
            query.afterT = hit.t;
            query.afterPrimitive = primitiveOf(record);
            going = clear > 0.0;
        }
        ++passed;
        } while (going && passed <= kMaxPassed);
    }
    if (going) {
        reportTransparencyCap();
        clear = 0.0;
    }
    return clear;
}

// What is left of a contribution; without alpha its bits.
vec3 attenuated(vec3 contribution, float clear)
{
    return hasFeature(kFeatureAlpha) ? contribution * clear : contribution;
}

float transmittance(ShadowRay shadow)
{
    Steps uncounted = Steps(0u, 0u);
    return transmittance(shadow, uncounted);
}

#endif
