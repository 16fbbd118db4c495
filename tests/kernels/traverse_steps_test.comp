// One thread is one ray through the real traversal, whose node and primitive tests are counted, as it counts them itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/scene.glsl"
#include "lib/intersect_node.glsl"
#include "shared/path_types.h"

uint nodeTests = 0u;
uint refFetches = 0u;
#define intersectChildren(head, content, a, b, c, origin, reciprocal, ahead, tMax) \
    (++nodeTests, intersectChildren(head, content, a, b, c, origin, reciprocal, ahead, tMax))
#define fetchPrimitiveRef(ref) (++refFetches, fetchPrimitiveRef(ref))
#include "access/traverse.glsl"

struct Result {
    PathHit hit;
    uint nodes;
    uint primitives;
    uint shadowNodes;
    uint unoccluded;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { PathRay rays[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        PathRay ray = rays[TEST_THREAD];
        Steps steps = Steps(0u, 0u);
        PathHit hit = traceClosest(ray, unrestrictedQuery(), steps);
        uint nodes = nodeTests;
        uint primitives = refFetches;
        Steps shadow = Steps(0u, 0u);
        bool metAlpha;
        ShadowRay shadowRay = ShadowRay(ray.origin, ray.source, ray.direction, kNoPrimitive, vec3(0.0), kInfinity);
        bool unoccluded = isUnoccluded(shadowRay, kFronts, shadow, metAlpha);
        bool spent = isLoopBudgetSpent(render.canarySteps);  // then no count is reliable
        EXPECT_TRUE(spent || steps.nodes == nodes);
        EXPECT_TRUE(spent || steps.primitives == primitives);
        EXPECT_TRUE(spent || shadow.nodes == nodeTests - nodes);
        EXPECT_TRUE(spent || shadow.primitives == refFetches - primitives);
        EXPECT_TRUE(nodes > 0u && nodeTests > nodes);
        results[TEST_THREAD] = Result(hit, nodes, primitives, nodeTests - nodes, uint(unoccluded));
    }
    endTest();
}
