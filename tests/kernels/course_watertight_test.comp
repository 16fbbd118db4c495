// One thread is one ray from inside a closed convex mesh, through the course's traversal.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "access/course/round.glsl"
#include "expect.glsl"
#include "access/course/traverse.glsl"
#include "shoot_at_edges.glsl"

void main()
{
    PathHit hit = shootRay();
    EXPECT_TRUE(isinf(hit.t) == (hit.primitiveRef == kNoPrimitiveRef));
    endTest();
}
