// One thread is one point, one triangle and one pair of numbers. Results: the solid angle and the sampled weights of v1 and v2.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/spherical_triangle.glsl"

struct Case {
    vec3 p, v0, e1, e2;
    vec2 u;
    float solidAngle;        // expected
    float tolerance;         // of the solid angle, relative
    vec2 weights;            // expected
    float weightsTolerance;  // 2: not compared
};

struct Result {
    float solidAngle;
    vec2 weights;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SphericalTriangle triangle = makeSphericalTriangle(c.p, c.v0, c.e1, c.e2);
        vec2 weights = sampleSphericalTriangle(triangle, c.u);
        EXPECT_CLOSE(triangle.solidAngle, c.solidAngle, c.tolerance);
        EXPECT_TRUE(weights.x >= 0.0 && weights.y >= 0.0 && weights.x + weights.y <= 1.0000001);
        bool isLarge = triangle.solidAngle >= kSmallestSphericalTriangle && c.weightsTolerance < 2.0;
        EXPECT_NEAR_VECTOR(weights, c.weights, isLarge ? min(c.weightsTolerance, 1e-3) : c.weightsTolerance);
        results[TEST_THREAD] = Result(triangle.solidAngle, weights);
    }
    endTest();
}
