// One thread is one point of the film of one camera. Result: the ray's direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/camera.glsl"

struct Case {
    FlatCamera camera;
    vec2 position, size;      // pixels
    vec2 film;                // expected, as are these
    vec3 origin, direction;
    float originTolerance;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec3 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec2 film = filmFromPixel(c.position, c.size);
        EXPECT_NEAR_VECTOR(film, c.film, 3e-7);
        EXPECT_TRUE(filmFromPixel(vec2(0.0), c.size) == vec2(-1.0, 1.0) && filmFromPixel(c.size, c.size) == vec2(1.0, -1.0));
        PathRay ray = cameraRay(c.camera, film);
        EXPECT_NEAR_VECTOR(ray.origin, c.origin, c.originTolerance);
        EXPECT_NEAR_VECTOR(ray.direction, c.direction, 6e-7);
        EXPECT_NEAR(dot(ray.direction, ray.direction), 1.0, 5e-7);
        EXPECT_EQUAL(ray.source, kNoPrimitive);
        results[TEST_THREAD] = ray.direction;
    }
    endTest();
}
