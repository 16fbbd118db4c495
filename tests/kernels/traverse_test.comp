// One thread is one ray, traced through the tree and against every reference in turn: both must agree to the bit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/traverse.glsl"
#include "primitive_met.glsl"

struct Case {
    PathRay ray;
    uint target;
    float tMax;
};

struct Result {
    PathHit hit;
    uint unoccluded;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

PathHit tryAll(PathRay ray, uint refs)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    PathHit best = PathHit(kNoPrimitiveRef, kInfinity, vec2(0.0));
    uint bestId = 0xffffffffu;
    for (uint i = 0u; i < refs; ++i) {
        PrimitiveRef ref = fetchPrimitiveRef(i);
        TriangleHit hit = intersectShape(traversal, ref, kInfinity, getPrimitive(ref) == ray.source);
        if (hit.t > 0.0 && (hit.t < best.t || (hit.t == best.t && getPrimitive(ref) < bestId))) {
            best = PathHit(i, hit.t, computeBarycentric(hit));
            bestId = getPrimitive(ref);
        }
    }
    return best;
}

bool isUnoccludedByAny(ShadowRay ray, uint refs)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    bool free = true;
    for (uint i = 0u; i < refs; ++i) {
        PrimitiveRef ref = fetchPrimitiveRef(i);
        TriangleHit hit = intersectShape(traversal, ref, ray.tMax, getPrimitive(ref) == ray.source);
        free = free && (getPrimitive(ref) == ray.target || !(hit.t > 0.0));
    }
    return free;
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        uint refs = uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels;
        PathHit hit = traceClosest(c.ray);
        PathHit expected = tryAll(c.ray, refs);
        EXPECT_EQUAL(primitiveMet(hit), primitiveMet(expected));
        EXPECT_EQUAL(floatBitsToUint(hit.t), floatBitsToUint(expected.t));
        EXPECT_TRUE(hit.barycentric == expected.barycentric);
        ShadowRay shadow = ShadowRay(c.ray.origin, c.ray.source, c.ray.direction, c.target, vec3(0.0), c.tMax);
        bool unoccluded = isUnoccluded(shadow);
        EXPECT_EQUAL(uint(unoccluded), uint(isUnoccludedByAny(shadow, refs)));
        results[TEST_THREAD] = Result(hit, uint(unoccluded));
    }
    endTest();
}
