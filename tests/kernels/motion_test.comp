// One thread is a motion at one time: where points and vectors of the mesh are then, and back again.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/motion.glsl"

struct MotionCase {
    uint motion;  // as in InstanceData
    float time;
    vec3 point;
    vec3 placed;  // where the host says that it is
    float tolerance;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { MotionCase cases[]; };

void main()
{
    MotionCase c = cases[TEST_THREAD];
    pathTime = c.time;
    Movement m = movementNow(c.motion);
    EXPECT_TRUE(distance(movePoint(m, c.point), c.placed) <= c.tolerance);
    EXPECT_TRUE(distance(movePoint(m, takePointBack(m, c.placed)), c.placed) <= c.tolerance);
    EXPECT_NEAR(length(m.axis0), 1.0, 1e-6);
    EXPECT_NEAR(dot(m.axis0, m.axis1), 0.0, 1e-6);
    EXPECT_NEAR(dot(cross(m.axis0, m.axis1), m.axis2), 1.0, 1e-6);
    endTest();
}
