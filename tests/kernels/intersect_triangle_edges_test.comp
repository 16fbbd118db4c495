// One thread is one ray at a shared edge or vertex. Result: hits of the watertight test, then of Moller and Trumbore's.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/intersect_moller_trumbore.glsl"
#include "lib/intersect_triangle.glsl"

const uint kMaxRim = 6u;

// Triangles (hub, rim[i], rim[i + 1]) for i < triangles; the last rim point is the first again in a closed fan.
struct Case {
    vec3 origin, direction;
    vec3 hub;
    vec3 rim[kMaxRim];
    uint triangles;
    uint turn;  // which corner of triangle i comes first: bits 2i, 2i + 1; bit 31: wound the other way
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { uvec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Shear shear = makeShear(c.direction, reciprocalDirection(c.direction));
        uvec2 hits = uvec2(0u);
        for (uint i = 0u; i < c.triangles; ++i) {
            vec3 corner[3] = vec3[](c.hub, c.rim[i], c.rim[(i + 1u) % kMaxRim]);
            uint first = (c.turn >> (2u * i)) & 3u;
            vec3 v0 = corner[first % 3u];
            uint back = c.turn >> 31u;
            vec3 v1 = corner[(first + 1u + back) % 3u];
            vec3 v2 = corner[(first + 2u - back) % 3u];
            hits.x += intersectWatertight(c.origin, shear, v0, v1, v2, 1e30, false, true).t > 0.0 ? 1u : 0u;
            hits.y += intersectMollerTrumbore(c.origin, c.direction, v0, v1, v2, 1e30).t > 0.0 ? 1u : 0u;
        }
        EXPECT_TRUE(hits.x >= 1u);
        results[TEST_THREAD] = hits;
    }
    endTest();
}
