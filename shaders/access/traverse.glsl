// The two queries: what a ray hits first, and whether a shadow ray is unoccluded. Triangle tests are watertight.
#ifndef GLIM_ACCESS_TRAVERSE
#define GLIM_ACCESS_TRAVERSE

#include "transparency.glsl"

TriangleHit intersectTriangle(TraversalRay traversal, Record record, float tMax)
{
    return intersectWatertight(traversal.origin, traversal.shear, floatsOf(record.t0), floatsOf(record.t1), floatsOf(record.t2), tMax,
                               isSliver(record), hasFeature(kFeatureLargeTriangles));
}

#endif
