// Points on surfaces with bounds on their error, and ray origins that cannot meet the surface again.
#ifndef GLIM_LIB_OFFSET_POINT
#define GLIM_LIB_OFFSET_POINT

#include "finite.glsl"

// The edges are summed first, so that only the last sum rounds at the size of v0. triangleErrorBound relies on that.
vec3 trianglePoint(vec3 v0, vec3 e1, vec3 e2, vec2 barycentric)
{
    return v0 + (e1 * barycentric.x + e2 * barycentric.y);
}

// Bounds the rounding of trianglePoint, and along the normal that of a later test of a coplanar triangle of this size: NVIDIA, "Solving
// Self-Intersection Artifacts in DirectX Raytracing", 2023 (optix-toolkit, SelfIntersectionAvoidance): 2^-24 |v0| + 3 * 2^-24 of the
// largest extent, as that test mixes the axes. The test of `large` triangles does not (computeDepths): each axis counts by its own extent,
// as for the point. That has u = 2^-24 of |v0 + s| for the last sum and, for s = e1 b1 + e2 b2, one each for the edges, the products and
// the sum: together u (|v0| + 4 max(|e1|, |e2|)), and 6 u of it are allowed for.
vec3 triangleErrorBound(vec3 v0, vec3 e1, vec3 e2, bool large)
{
    vec3 extent = abs(e1) + abs(e2) + abs(e1 - e2);
    extent = large ? extent : vec3(max(extent.x, max(extent.y, extent.z)));
    return 5.9604645e-8 * abs(v0) + 1.7881394e-7 * extent;
}

// Whether a hit at distance t is so near for the triangle's size that barycentric weights, which know the place to some 2^-23 of that size,
// say less of it than the ray does.
bool isNearby(float t, vec3 e1, vec3 e2)
{
    vec3 extent = max(abs(e1), abs(e2));
    return max(extent.x, max(extent.y, extent.z)) > 16.0 * t;
}

// `point` of a plane with the unit normal n, moved within the plane to where `near` lies, which is close to it. The way is short, so that
// beside the rounding of `point`, only that of the sum counts: twice triangleErrorBound holds both.
vec3 moveWithinPlane(vec3 point, vec3 near, vec3 n)
{
    vec3 way = near - point;
    return point + (way - n * dot(n, way));
}

// Bounds the rounding of a point projected onto a sphere: that of the centre and of four operations on the radius.
vec3 sphereErrorBound(vec3 center, float radius)
{
    return 5.9604645e-8 * abs(center) + vec3(2.3841858e-7 * radius);
}

// What a line has more: the place on its axis rounds by its length, and so does the test whether a point is outside (intersectCapsule).
// Neighbours in a strip share the ball between them, so that a ray that leaves one must start outside of the other.
vec3 lineErrorBound(vec3 axis, float radius)
{
    return vec3(4.7683716e-7 * (length(axis) + radius));
}

// The next float above x if `side` is positive, below x if it is negative.
float nextAlong(float x, float side)
{
    int bits = floatBitsToInt(x);
    float next = intBitsToFloat((side > 0.0) == (x > 0.0) ? bits + 1 : bits - 1);
    float smallest = side > 0.0 ? kSmallestNormal : -kSmallestNormal;
    return side == 0.0 ? x : x == 0.0 ? smallest : next;
}

// Moves `point` off the surface along the unit geometric normal n (on the side wanted), far enough to clear the error box,
// rounded away from the surface (pbrt-v4, section 6.8.6).
vec3 offsetPoint(vec3 point, vec3 n, vec3 errorBound)
{
    vec3 moved = point + n * dot(abs(n), errorBound);
    return vec3(nextAlong(moved.x, n.x), nextAlong(moved.y, n.y), nextAlong(moved.z, n.z));
}

#endif
