// One thread writes notes, as the only path of a pass does.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/notes.glsl"

void main()
{
    if (TEST_THREAD == 0u) {
        vec3 ng = vec3(4.0, 5.0, 6.0);
        noteSurface(SurfaceInteraction(vec3(1.0, 2.0, 3.0), vec3(0.0), ng, vec3(0.0), vec2(0.0), true, 0u, 0u, 0u), vec3(7.0, 8.0, 9.0));
        noteHitLight(10.0, 11.0);
        noteLight(12u);
        noteLightSample(13.0, 14.0, 15.0);
        noteBounce(vec3(16.0, 17.0, 18.0), vec3(19.0, 20.0, 21.0));
        noteContinuation(22.0);
        EXPECT_TRUE(!kNotes || pass.pixelCount == 1u);
    }
    endTest();
}
