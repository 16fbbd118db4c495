// The two queries: what a ray hits first, and whether a shadow ray is unoccluded. Triangle tests are watertight.
#ifndef GLIM_ACCESS_TRAVERSE
#define GLIM_ACCESS_TRAVERSE

#include "transparency.glsl"

TriangleHit intersectTriangle(TraversalRay traversal, PrimitiveRef ref, float tMax)
{
    return intersectWatertight(traversal.origin, traversal.shear, toFloats(ref.t0), toFloats(ref.t1), toFloats(ref.t2), tMax,
                               isSliver(ref), hasFeature(kFeatureLargeTriangles));
}

#endif
