// One thread is one point of the unit square. Results: where it goes.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/course/uniform_hemisphere.glsl"

struct Case {
    vec2 u;
    vec2 disk;  // the expected point
};

struct Result {
    vec3 hemisphere, sphere, uniformHemisphere;
    vec2 triangle, circle;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec2 disk = sampleDisk(c.u);
        EXPECT_NEAR_VECTOR(disk, c.disk, 3e-7);
        vec3 w = sampleCosineHemisphere(c.u);
        EXPECT_NEAR_VECTOR(w.xy, c.disk, 3e-7);
        EXPECT_NEAR(dot(w, w), 1.0, 5e-7);
        EXPECT_TRUE(w.z >= 0.0);
        EXPECT_NEAR(pdfCosineHemisphere(w.z), w.z / 3.14159265, 1e-7);
        EXPECT_EQUAL(pdfCosineHemisphere(-w.z), 0.0);
        vec3 s = sampleSphere(c.u);
        EXPECT_NEAR(dot(s, s), 1.0, 5e-7);
        EXPECT_NEAR(s.z, 1.0 - 2.0 * c.u.x, 1e-7);
        vec3 h = sampleUniformHemisphere(c.u);
        EXPECT_NEAR(dot(h, h), 1.0, 5e-7);
        EXPECT_TRUE(h.z > 0.0);
        EXPECT_CLOSE(pdfUniformHemisphere(), 0.159154943, 2e-7);
        vec2 b = sampleTriangle(c.u);
        EXPECT_TRUE(b.x >= 0.0 && b.y >= 0.0 && b.x + b.y <= 1.0);
        results[TEST_THREAD] = Result(w, s, h, b, sampleCircle(c.u.y));
    }
    endTest();
}
