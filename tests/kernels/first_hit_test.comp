// One thread is one surface that the camera saw.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/first_hit.glsl"

struct Case {
    vec3 point, shading, baseColor;
    float depth;      // expected
    float tolerance;  // of it
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Surface surface = Surface(c.point, vec3(0.0), -c.shading, c.shading, true, 0u, 0u, 0u);
        FirstHit hit = firstHitOf(surface, FlatMaterial(c.baseColor, kLambert, vec3(9.0), 1.5, 0u, uvec3(0u)));
        EXPECT_NEAR(hit.depth, c.depth, c.tolerance);
        EXPECT_TRUE(hit.albedo == c.baseColor);
        EXPECT_TRUE(hit.normal == c.shading);
        EXPECT_EQUAL(hit.alpha, 1.0);
        FirstHit none = makeNoFirstHit();
        EXPECT_TRUE(none.albedo == vec3(0.0) && none.normal == vec3(0.0) && none.alpha == 0.0);
        EXPECT_TRUE(isinf(none.depth) && none.depth > 0.0);
    }
    endTest();
}
