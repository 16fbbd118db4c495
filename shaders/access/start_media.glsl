// The media around a point at which a ray begins: by a walk from there to infinity. A solid that the walk leaves and has not entered is
// around the point, and the first such is the innermost. host/flatten/start_media.hpp says when a picture needs it.
#ifndef GLIM_ACCESS_START_MEDIA
#define GLIM_ACCESS_START_MEDIA

#include "transparency.glsl"
#include "lib/media.glsl"

uint mediumAt(PlacedPrimitive placed)
{
    MaterialData data = fetchMaterial(getMaterial(placed.ref));
    if (data.principled == 0u) {
        return 0u;
    }
    PrincipledData p = fetchPrincipled(data.principled);
    return p.layers == 0u ? 0u : fetchLayers(p.layers).medium;
}

// In the form of a ray's media (lib/media.glsl). Media beyond its four numbers are counted and forgotten, as is the rest of a walk through
// kMaxPassed surfaces of solids.
uint mediaAround(vec3 point, inout Steps steps)
{
    PathRay ray = PathRay(point, kNoPrimitive, kOutwards, 0u);
    Query query = unrestrictedQuery();
    uint around = 0u, places = 0u, entered = 0u, passed = 0u;
    uint last = 0u;  // the medium of the surface before: a ray through an edge meets two triangles in one place
    bool goesOn = false, forgets = false;
    do {
        PathHit hit = traceClosest(ray, query, steps);
        goesOn = hit.primitiveRef != kNoPrimitiveRef && passed < kMaxPassed;
        if (goesOn) {
            PlacedPrimitive placed = fetchPlacedPrimitive(hit.primitiveRef);
            uint medium = mediumAt(placed);
            medium = hit.t == query.afterT && medium == last ? 0u : medium;
            bool enters = dot(geometricNormal(placed, ray.origin + ray.direction * hit.t), kOutwards) < 0.0;
            bool found = medium != 0u && !enters && !isInMedium(entered, medium);
            forgets = forgets || (medium != 0u && enters && isFull(entered)) || (found && places == kMaxNestedMedia);
            found = found && places < kMaxNestedMedia;
            around |= found ? medium << (places * kMediumBits) : 0u;
            places += found ? 1u : 0u;
            entered = medium == 0u ? entered : mediaBeyond(entered, medium, enters);
            passed += medium == 0u ? 0u : 1u;
            forgets = forgets || passed == kMaxPassed;
            last = medium == 0u ? last : medium;
            query.afterT = hit.t;
            query.afterPrimitive = getPrimitive(placed.ref);
        }
    } while (goesOn);
    if (forgets) {
        reportMediaCap();
    }
    return around;
}

#endif
