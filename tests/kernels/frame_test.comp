// One thread is one normal, or one vector to normalize.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/frame.glsl"

struct Case {
    vec3 normal;
    vec3 vector;
    vec3 unit;  // along vector
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Frame f = makeFrame(c.normal);
        EXPECT_NEAR(dot(f.x, f.x), 1.0, 5e-7);
        EXPECT_NEAR(dot(f.y, f.y), 1.0, 5e-7);
        EXPECT_NEAR(dot(f.x, f.y), 0.0, 5e-7);
        EXPECT_NEAR(dot(f.x, f.z), 0.0, 5e-7);
        EXPECT_NEAR(dot(f.y, f.z), 0.0, 5e-7);
        EXPECT_NEAR_VECTOR(cross(f.x, f.y), f.z, 1e-6);
        EXPECT_TRUE(f.z == c.normal);
        EXPECT_NEAR_VECTOR(worldFromFrame(f, vec3(0.0, 0.0, 1.0)), c.normal, 0.0);
        EXPECT_NEAR_VECTOR(worldFromFrame(f, vec3(0.6, -0.48, 0.64)), 0.6 * f.x - 0.48 * f.y + 0.64 * f.z, 3e-7);
        EXPECT_NEAR_VECTOR(normalizeSafely(c.vector), c.unit, 4e-7);
    }
    endTest();
}
