// What a light path meets next. Single-sided surfaces are there as they are for a path from the camera, which takes the same way in the
// other direction.
#ifndef GLIM_ACCESS_LIGHT_TRAVERSAL
#define GLIM_ACCESS_LIGHT_TRAVERSAL

#include "transparency.glsl"

// The last of so many candidates replaces those before it: each is chosen as often as the others.
bool isChosen(SampleId id, uint bounce, uint primitive, uint candidates)
{
    uint bits = hash4(uvec4(id.pixel, id.index, kDimensionAlpha | bounce << 1u, id.seed ^ primitive * 0x9e3779b9u)).y;
    return unitFloat(bits) * float(candidates) < 1.0;
}

// As traceThroughAlpha(). Light ends at the back of a single-sided surface, since a path from the camera, which meets the front there, does
// not go on. Light that comes to the front scatters, and goes on as well, since a path from the camera that comes from behind passes. Where
// it scatters at several surfaces, one is chosen; `weight` makes up for the others.
VisibleHit traceLightThroughAlpha(SampleId id, uint bounce, AlphaRay alphaRay, inout Steps steps)
{
    VisibleHit chosen = VisibleHit(makePathHit(makeMiss()), vec3(1.0));
    vec3 weight = vec3(1.0);
    uint candidates = 0u;
    bool goesOn = false;
    do {
        VisibleHit met = traceThroughAlpha(id, bounce, alphaRay, steps);
        goesOn = false;
        if (!hasFeature(kFeatureSingleSided) || alphaRay.isShadow) {
            chosen = met;
        } else if (met.hit.primitiveRef != kNoPrimitiveRef) {
            PlacedPrimitive placed = fetchPlacedPrimitive(met.hit.primitiveRef);
            vec3 point = alphaRay.ray.origin + alphaRay.ray.direction * met.hit.t;
            bool single = isSingleSided(placed.ref);
            bool front = dot(geometricNormal(placed, point), alphaRay.direction) < 0.0;
            weight *= met.weight;
            if (front || !single) {
                ++candidates;
                if (isChosen(id, bounce, getPrimitive(placed.ref), candidates)) {
                    chosen = VisibleHit(met.hit, weight);
                }
            }
            goesOn = single && front;
            alphaRay.query.afterT = met.hit.t;
            alphaRay.query.afterPrimitive = getPrimitive(placed.ref);
        }
    } while (goesOn && candidates <= kMaxPassed);
    if (goesOn) {
        reportTransparencyCap();
    }
    if (candidates > 1u) {
        chosen.weight *= float(candidates);
    }
    return chosen;
}

#endif
