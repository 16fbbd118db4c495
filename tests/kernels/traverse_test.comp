// One thread is one ray, traced through the tree and against every record in turn: both must agree to the bit.
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

PathHit tryAll(PathRay ray, uint records)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    PathHit best = PathHit(kNoRecord, kInfinity, vec2(0.0));
    uint bestId = 0xffffffffu;
    for (uint i = 0u; i < records; ++i) {
        Record record = fetchRecord(i);
        TriangleHit hit = intersectRecord(traversal, record, kInfinity, primitiveOf(record) == ray.source);
        if (hit.t > 0.0 && (hit.t < best.t || (hit.t == best.t && primitiveOf(record) < bestId))) {
            best = PathHit(i, hit.t, barycentricOf(hit));
            bestId = primitiveOf(record);
        }
    }
    return best;
}

bool isUnoccludedByAny(ShadowRay ray, uint records)
{
    TraversalRay traversal = makeTraversalRay(ray.origin, ray.direction);
    bool free = true;
    for (uint i = 0u; i < records; ++i) {
        Record record = fetchRecord(i);
        TriangleHit hit = intersectRecord(traversal, record, ray.tMax, primitiveOf(record) == ray.source);
        free = free && (primitiveOf(record) == ray.target || !(hit.t > 0.0));
    }
    return free;
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        uint records = uint(textureSize(sceneRecords)) / kRecordTexels;
        PathHit hit = traceClosest(c.ray);
        PathHit expected = tryAll(c.ray, records);
        EXPECT_EQUAL(primitiveMet(hit), primitiveMet(expected));
        EXPECT_EQUAL(floatBitsToUint(hit.t), floatBitsToUint(expected.t));
        EXPECT_TRUE(hit.barycentric == expected.barycentric);
        ShadowRay shadow = ShadowRay(c.ray.origin, c.ray.source, c.ray.direction, c.target, vec3(0.0), c.tMax);
        bool unoccluded = isUnoccluded(shadow);
        EXPECT_EQUAL(uint(unoccluded), uint(isUnoccludedByAny(shadow, records)));
        results[TEST_THREAD] = Result(hit, uint(unoccluded));
    }
    endTest();
}
