// Brute force: every primitive against the ray, some references at a time.
#ifndef GLIM_ACCESS_COURSE_SCAN
#define GLIM_ACCESS_COURSE_SCAN

#include "access/course/traverse.glsl"

// The closest hit of `met` (kNoPrimitiveRef: none yet) and references [first, end).
PathHit scanClosest(PathRay ray, PathHit met, uint first, uint end)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    Closest best = makeMiss();
    if (met.primitiveRef != kNoPrimitiveRef) {
        best = Closest(met.primitiveRef, getPrimitive(fetchPrimitiveRef(met.primitiveRef)), TriangleHit(met.t, met.barycentric, 1.0));
    }
    for (uint i = first; i < end; ++i) {
        intersectPrimitive(traversal, i, ray.source, best);
    }
    return makePathHit(best);
}

// True if nothing but `target` among references [first, end) lies between origin and origin + tMax * direction.
bool scanUnoccluded(ShadowRay ray, uint first, uint end)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    bool occluded = false;
    for (uint i = first; i < end && !occluded; ++i) {
        PrimitiveRef ref = fetchPrimitiveRef(i);
        TriangleHit hit = intersectShape(traversal, ref, ray.tMax, getPrimitive(ref) == ray.source);
        occluded = hit.t > 0.0 && getPrimitive(ref) != ray.target;
    }
    return !occluded;
}

#endif
