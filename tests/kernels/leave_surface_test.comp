// One thread is one hit of a triangle and one ray that leaves it, to either side (H7).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/interaction.glsl"
#include "access/traverse.glsl"
#include "lib/hash.glsl"
#include "lib/frame.glsl"
#include "lib/warp.glsl"
#include "primitive_met.glsl"

struct Setup {
    float reach;  // aim within this distance of the origin; 0: anywhere on the triangle
};

struct Tally {
    uint left;           // rays that left a triangle
    uint selfHits;       // that met it again at once, without the rule that they cannot
    uint skippedHits;    // with it, through the whole traversal
    uint otherHits;      // that met another triangle
    uint largestOffset;  // bits of a float: of the triangle's size, after 4 ulp of the point
    uint naiveHits;      // rays from o + t d that met the triangle again beyond t = 1e-4
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Setup setup; };
layout(set = 0, binding = kBindResults, scalar) buffer Results { Tally tally; };

uvec4 randomBits(uint dimension)
{
    return hash4(uvec4(TEST_THREAD, dimension, 0u, render.seed));
}

float largest(vec3 v)
{
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

void leave(PathRay ray, PathHit hit, PrimitiveRef ref, float size)
{
    SurfaceInteraction surface = makeSurfaceInteraction(ray, hit);
    uvec4 bits = randomBits(3u);
    vec3 normal = (bits.z & 1u) != 0u ? surface.ng : -surface.ng;
    vec3 wi = worldFromFrame(makeFrame(normal), sampleCosineHemisphere(unitFloat(bits.xy)));
    vec3 origin = offsetRayOrigin(surface, wi);
    EXPECT_TRUE(dot(origin - surface.p, normal) >= 0.0);
    float offset = largest(origin - surface.p) - 4.8e-7 * largest(surface.p);
    atomicMax(tally.largestOffset, floatBitsToUint(max(0.0, offset / size)));
    bool again = intersectShape(makeTraversalRay(origin, wi), ref, kInfinity, false).t > 0.0;
    PathHit next = traceClosest(PathRay(origin, surface.primitive, wi, 0u));
    vec3 naive = ray.origin + ray.direction * hit.t;
    bool naiveAgain = intersectShape(makeTraversalRay(naive, wi), ref, kInfinity, false).t > 1e-4;
    atomicAdd(tally.naiveHits, naiveAgain ? 1u : 0u);
    atomicAdd(tally.left, 1u);
    atomicAdd(tally.selfHits, again ? 1u : 0u);
    atomicAdd(tally.skippedHits, primitiveMet(next) == surface.primitive ? 1u : 0u);
    atomicAdd(tally.otherHits, next.primitiveRef != kNoPrimitiveRef ? 1u : 0u);
}

void main()
{
    uvec4 bits = randomBits(0u);
    uint index = chooseBin(bits.x, uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels);
    PrimitiveRef ref = fetchPrimitiveRef(index);
    vec3 v0 = toFloats(ref.t0);
    vec3 e1 = toFloats(ref.t1) - v0;
    vec3 e2 = toFloats(ref.t2) - v0;
    float size = max(largest(e1), largest(e2));
    vec2 b = sampleTriangle(unitFloat(bits.yz));
    vec3 near = setup.reach * (1.0 - 2.0 * vec3(unitFloat(randomBits(1u).xy), unitFloat(bits.w)));
    vec3 target = setup.reach > 0.0 ? near : v0 + e1 * b.x + e2 * b.y;
    vec3 direction = sampleSphere(unitFloat(randomBits(2u).xy));
    float lightDistance = setup.reach > 0.0 ? 4.0 * setup.reach : 0.5 * size;
    PathRay ray = PathRay(target - direction * lightDistance, kNoPrimitive, direction, 0u);
    TriangleHit hit = intersectShape(makeTraversalRay(ray.origin, ray.direction), ref, kInfinity, false);
    if (hit.t > 0.0) {
        leave(ray, PathHit(index, hit.t, computeBarycentric(hit)), ref, size);
    }
    endTest();
}
