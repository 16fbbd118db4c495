// One thread connects one point to one camera.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/camera.glsl"

struct Case {
    FlatCamera camera;
    vec2 film, disk;  // expected, and given
    vec3 p;
    vec3 wo;       // expected, as is this
    float weight;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        uint model = c.camera.projection.model;
        CameraConnection connection = connectToCamera(c.camera, model, c.p, c.disk);
        EXPECT_NEAR_VECTOR(connection.film, c.film, 2e-5);
        EXPECT_NEAR_VECTOR(connection.wo, c.wo, 2e-5);
        EXPECT_NEAR(connection.weight, c.weight, 2e-4 * c.weight);
        vec2 plane = connection.film;
        EXPECT_TRUE(model == kCentredFilm || model >= kFisheye || planeFromFilm(c.camera.projection, model, connection.film, plane));
        PathRay ray = lensRay(c.camera, plane, c.disk);
        EXPECT_TRUE(model < kFisheye || sphericalRay(c.camera, model, connection.film, ray));
        EXPECT_NEAR_VECTOR(connection.origin, ray.origin, 2e-4);
        EXPECT_NEAR_VECTOR(connection.wo, -ray.direction, 2e-5);
        vec2 size = vec2(640.0, 480.0);
        EXPECT_NEAR_VECTOR(filmFromPixel(pixelFromFilm(c.film, size), size), c.film, 1e-6);
        vec3 behind = 2.0 * c.camera.position - c.p;
        EXPECT_TRUE(model >= kFisheye || connectToCamera(c.camera, model, behind, c.disk).weight == 0.0);
    }
    endTest();
}
