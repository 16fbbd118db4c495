// One thread is one ray and one triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/intersect_moller_trumbore.glsl"
#include "lib/intersect_triangle.glsl"

const uint kMiss = 0u;
const uint kHit = 1u;

struct Case {
    vec3 origin, direction, v0, v1, v2;
    float tmax;
    uint verdict;       // kMiss, kHit, or either: rounding may decide
    uint fat;           // neither near an edge nor grazing: Moller and Trumbore's test must agree
    float t;            // expected, as are the barycentrics
    float tTolerance;
    vec2 barycentric;
    float barycentricTolerance;
    uint plain;         // not of the form for slivers
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void expectVerdict(Case c, bool sliver)
{
    Shear shear = makeShear(c.direction, reciprocalDirection(c.direction));
    TriangleHit hit = intersectWatertight(c.origin, shear, c.v0, c.v1, c.v2, c.tmax, sliver, true);
    bool isHit = hit.t > 0.0;
    EXPECT_TRUE(c.verdict > kHit || isHit == (c.verdict == kHit));
    EXPECT_TRUE(isHit || hit.t == -1.0);
    TriangleHit back = intersectWatertight(c.origin, shear, c.v0, c.v2, c.v1, c.tmax, sliver, true);
    EXPECT_TRUE(c.verdict > kHit || (back.t > 0.0) == isHit);
    if (isHit) {
        vec2 b = computeBarycentric(hit);
        float less = uintBitsToFloat(floatBitsToUint(hit.t) - 1u);
        EXPECT_TRUE(hit.t <= c.tmax && min(b.x, b.y) >= 0.0 && b.x + b.y <= 1.0000002);
        EXPECT_TRUE(intersectWatertight(c.origin, shear, c.v0, c.v1, c.v2, hit.t, sliver, true).t == hit.t);
        EXPECT_TRUE(intersectWatertight(c.origin, shear, c.v0, c.v1, c.v2, less, sliver, true).t < 0.0);
    }
    if (isHit && c.verdict == kHit) {
        EXPECT_NEAR(hit.t, c.t, c.tTolerance);
        EXPECT_NEAR_VECTOR(computeBarycentric(hit), c.barycentric, c.barycentricTolerance);
    }
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        expectVerdict(c, false);
        if (c.plain == 0u) {
            expectVerdict(c, true);
        }
        if (c.fat != 0u) {
            TriangleHit other = intersectMollerTrumbore(c.origin, c.direction, c.v0, c.v1, c.v2, c.tmax);
            EXPECT_TRUE((other.t > 0.0) == (c.verdict == kHit));
            EXPECT_TRUE(c.verdict != kHit || abs(other.t - c.t) <= 1e-5 * c.t);
            EXPECT_TRUE(c.verdict != kHit || distance(computeBarycentric(other), c.barycentric) <= 1e-4);
        }
    }
    endTest();
}
