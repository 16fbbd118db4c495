// The two queries with the course's triangle test, where the render asks for it.
#ifndef GLIM_ACCESS_COURSE_TRAVERSE
#define GLIM_ACCESS_COURSE_TRAVERSE

#include "access/transparency.glsl"
#include "access/course/features.glsl"
#include "lib/course/intersect_moller_trumbore.glsl"

TriangleHit intersectTriangle(TraversalRay traversal, Record record, float tMax)
{
    return kMollerTrumbore ? intersectMollerTrumbore(traversal.origin, traversal.direction, floatsOf(record.t0), floatsOf(record.t1),
                                                     floatsOf(record.t2), tMax)
                           : intersectWatertight(traversal.origin, traversal.shear, floatsOf(record.t0), floatsOf(record.t1), floatsOf(record.t2),
                                                 tMax, isSliver(record), hasFeature(kFeatureLargeTriangles));
}

#endif
