// One thread is one ray that leaves a triangle. Results: the point with its bound, the ray's origin, a point off a sphere, and
// whether the ray meets the triangle or its neighbour.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/intersect_triangle.glsl"
#include "lib/offset_point.glsl"

struct Case {
    vec3 v0, v1, v2, v3;  // the neighbour is v2, v1, v3
    vec2 barycentric;
    vec3 normal;          // unit, on the side of the ray
    vec3 direction;
    float from, side, next;
    uint large;
};

struct Result {
    vec3 point, bound, origin, onSphere;
    uint self, neighbour;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_EQUAL(nextAlong(c.from, c.side), c.next);
        vec3 e1 = c.v1 - c.v0;
        vec3 e2 = c.v2 - c.v0;
        vec3 point = trianglePoint(c.v0, e1, e2, c.barycentric);
        vec3 bound = triangleErrorBound(c.v0, e1, e2, c.large != 0u);
        vec3 origin = offsetPoint(point, c.normal, bound);
        EXPECT_TRUE(dot(origin - point, c.normal) > 0.0);
        Shear shear = makeShear(c.direction, reciprocalDirection(c.direction));
        uint self = intersectWatertight(origin, shear, c.v0, c.v1, c.v2, 1e30, false, c.large != 0u).t > 0.0 ? 1u : 0u;
        uint neighbour = intersectWatertight(origin, shear, c.v2, c.v1, c.v3, 1e30, false, c.large != 0u).t > 0.0 ? 1u : 0u;
        // The same normal on a sphere about v0 with the radius |e1|.
        vec3 onSphere = offsetPoint(c.v0 + length(e1) * c.normal, c.normal, sphereErrorBound(c.v0, length(e1)));
        results[TEST_THREAD] = Result(point, bound, origin, onSphere, self, neighbour);
    }
    endTest();
}
