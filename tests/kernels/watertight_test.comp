// One thread is one ray from inside a closed convex mesh.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/traverse.glsl"
#include "shoot_at_edges.glsl"

void main()
{
    PathHit hit = shootRay();
    EXPECT_TRUE(isinf(hit.t) == (hit.primitiveRef == kNoPrimitiveRef));
    endTest();
}
