// The two queries with the course's triangle test, where the render asks for it.
#ifndef GLIM_ACCESS_COURSE_TRAVERSE
#define GLIM_ACCESS_COURSE_TRAVERSE

#include "access/bvh_walk.glsl"
#include "access/course/features.glsl"
#include "lib/intersect_moller_trumbore.glsl"

TriangleHit intersectTriangle(Walk walk, Record record, float tMax)
{
    return kMollerTrumbore ? intersectMollerTrumbore(walk.origin, walk.direction, floatsOf(record.t0), floatsOf(record.t1),
                                                     floatsOf(record.t2), tMax)
                           : intersectWatertight(walk.origin, walk.shear, floatsOf(record.t0), floatsOf(record.t1), floatsOf(record.t2),
                                                 tMax, isSliver(record));
}

#endif
