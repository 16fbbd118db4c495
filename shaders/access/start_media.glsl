// The media around a point at which a ray begins: by a walk from there to infinity. A solid that the walk leaves and has not entered is
// around the point, and the first such is the innermost. host/flatten/start_media.hpp says when a picture needs it.
#ifndef GLIM_ACCESS_START_MEDIA
#define GLIM_ACCESS_START_MEDIA

#include "transparency.glsl"
#include "lib/media.glsl"

const vec3 kOutwards = vec3(0.36, 0.48, 0.8);  // no axis, no diagonal

uint mediumAt(PlacedRecord placed)
{
    MaterialData data = fetchMaterial(materialOf(placed.record));
    if (data.principled == 0u) {
        return 0u;
    }
    PrincipledData p = fetchPrincipled(data.principled);
    return p.layers == 0u ? 0u : fetchLayers(p.layers).medium;
}

// In the form of a ray's media (lib/media.glsl).
uint mediaAround(vec3 point)
{
    PathRay ray = PathRay(point, kNoPrimitive, kOutwards, 0u);
    Query query = anyHit();
    Steps uncounted = Steps(0u, 0u);
    uint around = 0u, places = 0u, entered = 0u, passed = 0u;
    bool goesOn = false;
    do {
        PathHit hit = traceClosest(ray, query, uncounted);
        goesOn = hit.record != kNoRecord && passed < kMaxPassed;
        if (goesOn) {
            PlacedRecord placed = fetchPlacedRecord(hit.record);
            uint medium = mediumAt(placed);
            vec3 at = ray.origin + ray.direction * hit.t;
            vec3 n = isSphere(placed.record) ? at - floatsOf(placed.record.t0) : placedNormal(placed);
            bool enters = dot(n, kOutwards) < 0.0, matched = isInMedium(entered, medium);
            bool found = medium != 0u && !enters && !matched && places < kMaxNestedMedia;
            around |= found ? medium << (places * kMediumBits) : 0u;
            places += found ? 1u : 0u;
            entered = medium == 0u ? entered : mediaBeyond(entered, medium, enters);
            query.afterT = hit.t;
            query.afterPrimitive = primitiveOf(placed.record);
            ++passed;
        }
    } while (goesOn);
    return around;
}

#endif
