// The two queries with the course's triangle test, where the render asks for it.
#ifndef GLIM_ACCESS_COURSE_TRAVERSE
#define GLIM_ACCESS_COURSE_TRAVERSE

#include "access/transparency.glsl"
#include "access/course/features.glsl"
#include "lib/course/intersect_moller_trumbore.glsl"

TriangleHit intersectTriangle(TraversalRay traversal, PrimitiveRef ref, float tMax)
{
    return kMollerTrumbore ? intersectMollerTrumbore(traversal.origin, traversal.direction, toFloats(ref.t0), toFloats(ref.t1),
                                                     toFloats(ref.t2), tMax)
                           : intersectWatertight(traversal.origin, traversal.shear, toFloats(ref.t0), toFloats(ref.t1), toFloats(ref.t2),
                                                 tMax, isSliver(ref), hasFeature(kFeatureLargeTriangles));
}

#endif
