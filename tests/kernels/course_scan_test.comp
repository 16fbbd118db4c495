// One thread is one ray, traced through the tree and by brute force over three pieces of the references: both must agree to the
// bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/course/round.glsl"
#include "expect.glsl"
#include "access/course/scan.glsl"
#include "primitive_met.glsl"

struct Case {
    PathRay ray;
    uint target;
    float tMax;
    uvec2 cuts;  // references [0, x), [x, y) and the others, x <= y
};

struct Result {
    PathHit hit;
    uint unoccluded;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

bool sameBits(PathHit a, PathHit b)
{
    return primitiveMet(a) == primitiveMet(b) && floatBitsToUint(a.t) == floatBitsToUint(b.t) &&
           floatBitsToUint(a.barycentric) == floatBitsToUint(b.barycentric);
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        uint refs = uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels;
        PathHit expected = traceClosest(c.ray);
        PathHit met = scanClosest(c.ray, makePathHit(makeMiss()), 0u, c.cuts.x);
        EXPECT_TRUE(met.primitiveRef < c.cuts.x || sameBits(met, makePathHit(makeMiss())));
        PathHit next = scanClosest(c.ray, met, c.cuts.x, c.cuts.y);
        EXPECT_TRUE(sameBits(next, met) || next.primitiveRef >= c.cuts.x && next.primitiveRef < c.cuts.y && next.t <= met.t);
        PathHit hit = scanClosest(c.ray, next, c.cuts.y, refs);
        EXPECT_EQUAL(primitiveMet(hit), primitiveMet(expected));
        EXPECT_TRUE(sameBits(hit, expected));
        EXPECT_TRUE(sameBits(scanClosest(c.ray, hit, 0u, 0u), hit));
        ShadowRay shadow = ShadowRay(c.ray.origin, c.ray.source, c.ray.direction, c.target, vec3(0.0), c.tMax);
        bool first = scanUnoccluded(shadow, 0u, c.cuts.x);
        bool second = scanUnoccluded(shadow, c.cuts.x, c.cuts.y);
        bool third = scanUnoccluded(shadow, c.cuts.y, refs);
        EXPECT_EQUAL(uint(first && second && third), uint(isUnoccluded(shadow)));
        results[TEST_THREAD] = Result(hit, uint(first && second && third));
    }
    endTest();
}
