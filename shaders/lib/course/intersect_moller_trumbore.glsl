// The ray/triangle test that the course teaches.
#ifndef GLIM_LIB_COURSE_INTERSECT_MOLLER_TRUMBORE
#define GLIM_LIB_COURSE_INTERSECT_MOLLER_TRUMBORE

#include "lib/intersect_triangle.glsl"

// Moller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, for comparison: it leaks at edges.
TriangleHit intersectMollerTrumbore(vec3 origin, vec3 direction, vec3 v0, vec3 v1, vec3 v2, float tMax)
{
    vec3 e1 = v1 - v0;
    vec3 e2 = v2 - v0;
    vec3 p = cross(direction, e2);
    float det = dot(e1, p);
    vec3 s = origin - v0;
    vec3 q = cross(s, e1);
    vec2 weights = vec2(dot(s, p), dot(direction, q));
    vec2 barycentric = weights / det;
    float t = dot(e2, q) / det;
    bool inside = barycentric.x >= 0.0 && barycentric.y >= 0.0 && barycentric.x + barycentric.y <= 1.0;
    return det != 0.0 && inside && t > 0.0 && t <= tMax ? TriangleHit(t, weights, det) : kNoTriangleHit;
}

#endif
