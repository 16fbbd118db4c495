// One thread is one point of the film and one of the lens. Result: the ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/camera.glsl"

struct Case {
    FlatCamera camera;
    vec2 film, disk;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { PathRay results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        PathRay pinhole = cameraRay(c.camera, c.film);
        PathRay middle = lensRay(c.camera, c.film, vec2(0.0));
        EXPECT_TRUE(floatBitsToUint(middle.origin) == floatBitsToUint(pinhole.origin));
        EXPECT_TRUE(floatBitsToUint(middle.direction) == floatBitsToUint(pinhole.direction));
        PathRay ray = lensRay(c.camera, c.film, c.disk);
        EXPECT_NEAR(dot(ray.direction, ray.direction), 1.0, 5e-7);
        EXPECT_EQUAL(ray.source, kNoPrimitive);
        EXPECT_EQUAL(middle.source, kNoPrimitive);
        results[TEST_THREAD] = ray;
    }
    endTest();
}
