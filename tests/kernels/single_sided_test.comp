// One thread is one segment. What the ray along it meets is compared with every reference in turn, whose side is that of its normal; and
// the shadow ray along it with the one of a light path, which goes the other way.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/interaction.glsl"
#include "access/traverse.glsl"

struct Case {
    vec3 from, to;
};

struct Result {
    float t;                   // infinity: the ray meets nothing
    uint fromBehind;           // of what it meets
    uint forwards, backwards;  // whether the way is free, by either shadow ray
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

float closestOfAll(PathRay ray)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    uint refs = uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels;
    float best = kInfinity;
    for (uint i = 0u; i < refs; ++i) {
        PrimitiveRef ref = fetchPrimitiveRef(i);
        TriangleHit hit = intersectShape(traversal, ref, kInfinity, false, kFronts | kBacks);
        if (hit.t > 0.0) {
            vec3 n = geometricNormal(PlacedPrimitive(ref, 0u, kNoInstance), ray.origin + hit.t * ray.direction);
            best = isSingleSided(ref) && dot(n, ray.direction) >= 0.0 ? best : min(best, hit.t);
        }
    }
    return best;
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        PathRay ray = PathRay(c.from, kNoPrimitive, c.to - c.from, 0u);
        PathHit hit = traceClosest(ray);
        uint fromBehind = 0u;
        if (hit.primitiveRef != kNoPrimitiveRef) {
            SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
            fromBehind = si.front ? 0u : 1u;
        }
        float expected = hit.t;
        if (render.instanceCount == 0u) {
            expected = closestOfAll(ray);
        }
        EXPECT_EQUAL(floatBitsToUint(hit.t), floatBitsToUint(expected));
        Steps steps = Steps(0u, 0u);
        bool metAlpha;
        bool forwards = isUnoccluded(ShadowRay(c.from, kNoPrimitive, c.to - c.from, kNoPrimitive, vec3(0.0), 1.0), kFronts, steps, metAlpha);
        bool backwards = isUnoccluded(ShadowRay(c.to, kNoPrimitive, c.from - c.to, kNoPrimitive, vec3(0.0), 1.0), kBacks, steps, metAlpha);
        EXPECT_TRUE(forwards == !(hit.t <= 1.0));
        results[TEST_THREAD] = Result(hit.t, fromBehind, uint(forwards), uint(backwards));
    }
    endTest();
}
