// One thread is one point, one rectangle and one pair of numbers. Results: the solid angle and the sampled share.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/spherical_rectangle.glsl"

struct Case {
    vec3 p, corner, x, y;
    vec2 size, u;
    float solidAngle;  // expected
    float tolerance;   // of the solid angle, relative
    vec2 share;        // expected
    float shareTolerance;  // 2: not compared
};

struct Result {
    float solidAngle;
    vec2 share;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SphericalRectangle rectangle = makeSphericalRectangle(c.p, c.corner, c.x, c.y, c.size.x, c.size.y);
        vec2 share = sampleSphericalRectangle(rectangle, c.u);
        EXPECT_CLOSE(rectangle.solidAngle, c.solidAngle, c.tolerance);
        EXPECT_TRUE(all(greaterThanEqual(share, vec2(0.0))) && all(lessThanEqual(share, vec2(1.0))));
        bool isLarge = rectangle.solidAngle >= kSmallestSphericalRectangle && c.shareTolerance < 2.0;
        EXPECT_NEAR_VECTOR(share, c.share, isLarge ? min(c.shareTolerance, 1e-3) : c.shareTolerance);
        results[TEST_THREAD] = Result(rectangle.solidAngle, share);
    }
    endTest();
}
