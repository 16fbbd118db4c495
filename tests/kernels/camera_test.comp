// One thread is one ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/camera.glsl"

struct Case {
    FlatCamera camera;
    vec2 position;
    vec2 size;
    vec3 origin;
    vec3 direction;
    float tolerance;  // of the direction, radians
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        PathRay ray = cameraRay(c.camera, filmFromPixel(c.position, c.size));
        EXPECT_NEAR_VECTOR(ray.origin, c.origin, 3e-7 * (1.0 + length(c.origin)));
        EXPECT_NEAR_VECTOR(ray.direction, c.direction, c.tolerance);
        EXPECT_NEAR(length(ray.direction), 1.0, 3e-7);
        EXPECT_TRUE(ray.source == kNoRecord);
    }
    endTest();
}
