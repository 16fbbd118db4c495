// Brute force: every primitive against the ray, some records at a time.
#ifndef GLIM_ACCESS_COURSE_SCAN
#define GLIM_ACCESS_COURSE_SCAN

#include "access/course/traverse.glsl"

// The closest hit of `met` (kNoRecord: none yet) and records [first, end).
PathHit scanClosest(PathRay ray, PathHit met, uint first, uint end)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    Closest best = makeMiss();
    if (met.record != kNoRecord) {
        best = Closest(met.record, primitiveOf(fetchRecord(met.record)), TriangleHit(met.t, met.barycentric, 1.0));
    }
    for (uint i = first; i < end; ++i) {
        meetRecord(traversal, i, ray.source, best);
    }
    return hitOf(best);
}

// True if nothing but `target` among records [first, end) lies between origin and origin + tMax * direction.
bool scanUnoccluded(ShadowRay ray, uint first, uint end)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    bool occluded = false;
    for (uint i = first; i < end && !occluded; ++i) {
        Record record = fetchRecord(i);
        TriangleHit hit = intersectRecord(traversal, record, ray.tMax, primitiveOf(record) == ray.source);
        occluded = hit.t > 0.0 && primitiveOf(record) != ray.target;
    }
    return !occluded;
}

#endif
