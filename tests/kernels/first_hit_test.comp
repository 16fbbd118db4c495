// One thread is one surface that the camera saw.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/first_hit.glsl"

struct Case {
    vec3 point, ns, baseColor;
    float depth;      // expected
    float tolerance;  // of it
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        SurfaceInteraction si = SurfaceInteraction(c.point, vec3(0.0), -c.ns, c.ns, vec2(0.0), true, 0u, 0u, 0u, 0u, kNoInstance);
        FirstHit hit = makeFirstHit(si, MaterialData(c.baseColor, kLambert, vec3(9.0), 1.5, 0u, 0u, 0.0, 0.0), c.ns);
        EXPECT_NEAR(hit.depth, c.depth, c.tolerance);
        EXPECT_TRUE(hit.albedo == c.baseColor);
        EXPECT_TRUE(hit.normal == c.ns);
        EXPECT_EQUAL(hit.alpha, 1.0);
        FirstHit none = makeNoFirstHit();
        EXPECT_TRUE(none.albedo == vec3(0.0) && none.normal == vec3(0.0) && none.alpha == 0.0);
        EXPECT_TRUE(isinf(none.depth) && none.depth > 0.0);
    }
    endTest();
}
