// One thread is one direction. Results: where it is on the map; the direction of a point of the map; an angle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/lat_long.glsl"

struct Case {
    vec3 w;
    float u, q;
    uint lower;
};

struct Result {
    vec2 at;
    vec3 direction;
    float angle;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec2 at = latLongFromDirection(c.w);
        EXPECT_TRUE(at.x >= 0.0 && at.x <= 1.0 && at.y >= 0.0 && at.y <= 1.0);
        vec3 direction = directionFromLatLong(c.u, c.q, c.lower != 0u);
        EXPECT_NEAR(dot(direction, direction), 1.0, 5e-7);
        EXPECT_EQUAL(directionFromLatLong(c.u, 0.0, c.lower != 0u).y, c.lower != 0u ? -1.0 : 1.0);
        EXPECT_EQUAL(computeAngle(0.0, 0.0), 0.0);
        results[TEST_THREAD] = Result(at, direction, computeAngle(c.w.y, c.w.x));
    }
    endTest();
}
