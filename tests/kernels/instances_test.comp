// One thread is one ray from inside a closed convex mesh, of which every instance is one: at an edge, at a vertex, or anywhere. What it hits
// is left outwards again. Another ray comes from outside and grazes a vertex: if it meets a triangle there, the tree must find one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/interaction.glsl"
#include "access/traverse.glsl"
#include "lib/hash.glsl"
#include "lib/warp.glsl"

struct Tally {
    uint rays[3];
    uint misses[3];
    uint astray[3];        // hits of another instance, or not where the ray was aimed
    uint grazing;          // rays from outside that meet the triangle
    uint lost;             // of which the tree has found nothing
    uint again;            // rays that left outwards and met the instance again
    uint largestOffset;    // bits of a float: how far the ray that leaves starts from the hit, in bounds of its error
    uint wrongSide;        // geometric normals that do not face the inside
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { float tolerance; };  // of the distance, in sizes of the instance
layout(set = 0, binding = kBindResults, scalar) buffer Results { Tally tally; };

uvec4 randomBits(uint dimension)
{
    return hash4(uvec4(TEST_THREAD, dimension, 0u, render.seed));
}

float largest(vec3 v)
{
    return max(abs(v.x), max(abs(v.y), abs(v.z)));
}

void leave(PathRay ray, PathHit hit, uint index)
{
    SurfaceInteraction si = makeSurfaceInteraction(ray, hit);
    atomicAdd(tally.wrongSide, si.front ? 1u : 0u);
    vec3 wi = worldFromFrame(makeFrame(-si.ng), sampleCosineHemisphere(unitFloat(randomBits(2u).xy)));
    PathRay next = spawnRay(si, wi);
    EXPECT_EQUAL(next.source, si.primitive);
    float bounds = largest((next.origin - si.p) / (si.errorBound + 1.2e-7 * abs(si.p)));
    atomicMax(tally.largestOffset, floatBitsToUint(bounds));
    PathHit met = traceClosest(next);
    bool again = met.primitiveRef != kNoPrimitiveRef && fetchPlacedPrimitive(met.primitiveRef).instance == index;
    ShadowRay shadow = ShadowRay(next.origin, next.source, wi, kNoPrimitive, vec3(1.0), kInfinity);
    EXPECT_TRUE(isUnoccluded(shadow) == (met.primitiveRef == kNoPrimitiveRef));
    atomicAdd(tally.again, again ? 1u : 0u);
}

// The ray in the space of the instance's mesh.
TraversalRay enter(vec3 origin, vec3 direction, InstanceData instance)
{
    uint node = 0u;  // the instances' nodes are among the first
    for (uint i = 0u; i < 32u; ++i) {
        uvec4 content = texelFetch(sceneNodes, int(i * kNodeTexels + 1u));
        bool found = (content.z | content.w) == 0u && texelFetch(sceneNodes, int(i * kNodeTexels + 4u)).x == instance.firstRef;
        node = found ? i : node;
    }
    EXPECT_TRUE(node != 0u);
    TraversalRay traversal;
    InstanceOffsets offsets;
    NodeGroup group = NodeGroup(0u, kEntersInstance);
    changeSpace(origin, direction, node, group, traversal, offsets);
    EXPECT_EQUAL(offsets.primitive, instance.firstPrimitive);
    return traversal;
}

// From 3 away, along the mesh at the reference's first vertex.
void graze(PrimitiveRef ref, InstanceData instance)
{
    vec3 v0 = toFloats(ref.t0);
    uvec4 bits = randomBits(3u);
    Frame frame = makeFrame(normalizeSafely(v0));
    float angle = 6.2831853 * unitFloat(bits.x);
    vec3 beside = frame.x * cos(angle) + frame.y * sin(angle);
    vec3 origin = placePoint(instance, v0 + 3.0 * beside);
    vec3 direction = placePoint(instance, v0) - origin;
    if (intersectShape(enter(origin, direction, instance), ref, kInfinity, false).t > 0.0) {
        atomicAdd(tally.grazing, 1u);
        atomicAdd(tally.lost, traceClosest(PathRay(origin, kNoPrimitive, direction, 0u)).primitiveRef == kNoPrimitiveRef ? 1u : 0u);
    }
}

void main()
{
    uint kind = TEST_THREAD % 3u;
    pathTime = unitFloat(randomBits(4u).x);
    uvec4 a = randomBits(0u), b = randomBits(1u);
    uint index = chooseBin(a.w, render.instanceCount);
    InstanceData instance = fetchInstance(index);
    PrimitiveRef ref = fetchPrimitiveRef(chooseBin(a.x, uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels));
    vec3 v0 = toFloats(ref.t0), v1 = toFloats(ref.t1), v2 = toFloats(ref.t2);
    graze(ref, instance);
    vec2 inside = sampleTriangle(unitFloat(a.yz));
    vec3 aim = kind == 0u ? v0 + (v1 - v0) * (0.05 + 0.9 * unitFloat(a.y)) : kind == 1u ? v0 : v0 + (v1 - v0) * inside.x + (v2 - v0) * inside.y;
    vec3 origin = placePoint(instance, 0.3 * (1.0 - 2.0 * vec3(unitFloat(b.xy), unitFloat(b.z))));
    vec3 target = placePoint(instance, aim);
    vec3 direction = (b.w & 1u) != 0u ? normalizeSafely(target - origin) : target - origin;
    PathRay ray = PathRay(origin, kNoPrimitive, direction, 0u);
    PathHit hit = traceClosest(ray);
    EXPECT_TRUE(isinf(hit.t) == (hit.primitiveRef == kNoPrimitiveRef));
    atomicAdd(tally.rays[kind], 1u);
    if (hit.primitiveRef == kNoPrimitiveRef) {
        atomicAdd(tally.misses[kind], 1u);
    } else {
        float size = largest(abs(instance.column0) + abs(instance.column1) + abs(instance.column2));
        bool there = abs(hit.t * length(direction) - length(target - origin)) <= tolerance * size;
        atomicAdd(tally.astray[kind], there && fetchPlacedPrimitive(hit.primitiveRef).instance == index ? 0u : 1u);
        leave(ray, hit, index);
    }
    endTest();
}
