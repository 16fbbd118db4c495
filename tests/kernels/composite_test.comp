// One thread is one pixel with a shadow catcher.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "shared/composite.h"

struct Case {
    PixelMoments shown;
    CatcherMoments catcher;
    vec3 mean;  // of the composite, by the host
    float alpha;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        PixelMoments pixel = compositePixel(c.shown, c.catcher);
        EXPECT_NEAR_VECTOR(pixel.mean, c.mean, 1e-6 * length(c.shown.mean));
        EXPECT_NEAR(pixel.alpha, c.alpha, 1e-6);
        EXPECT_EQUAL(pixel.count, c.shown.count);
        EXPECT_NEAR_VECTOR(pixel.albedo, c.shown.albedo, 0.0);
    }
    endTest();
}
