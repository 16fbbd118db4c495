// One thread is one normal and one vector.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/frame.glsl"

struct Case {
    vec3 normal;
    vec3 vector;  // of any length
    vec3 unit;    // along it
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        Frame f = makeFrame(c.normal);
        EXPECT_TRUE(f.z == c.normal);
        vec3 lengths = vec3(dot(f.x, f.x), dot(f.y, f.y), dot(f.z, f.z));
        vec3 angles = vec3(dot(f.x, f.y), dot(f.y, f.z), dot(f.z, f.x));
        EXPECT_NEAR_VECTOR(lengths, vec3(1.0), 5e-7);
        EXPECT_NEAR_VECTOR(angles, vec3(0.0), 5e-7);
        EXPECT_NEAR_VECTOR(cross(f.x, f.y), f.z, 1e-6);
        vec3 unit = normalizeSafely(c.vector);
        EXPECT_NEAR(dot(unit, unit), 1.0, 4e-7);
        EXPECT_NEAR_VECTOR(unit, c.unit, 4e-7);
        // Coordinates in the frame come back: nine products and six sums of 2^-24, and the frame's own error.
        vec3 world = worldFromFrame(f, unit);
        EXPECT_NEAR_VECTOR(vec3(dot(world, f.x), dot(world, f.y), dot(world, f.z)), unit, 1e-6);
    }
    endTest();
}
