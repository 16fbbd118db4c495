// One thread is one crossing of a surface by a path within some media.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/media.glsl"

struct Case {
    uint media, medium;
    uint entered, left;  // expected: the media beyond the surface, from its front and from its back
    uint innermost, full, inside;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        EXPECT_EQUAL(innermost(c.media), c.innermost);
        EXPECT_EQUAL(isFull(c.media) ? 1u : 0u, c.full);
        EXPECT_EQUAL(isInMedium(c.media, c.medium) ? 1u : 0u, c.inside);
        EXPECT_TRUE(mediaBeyond(c.media, c.medium, true) == c.entered);
        EXPECT_TRUE(mediaBeyond(c.media, c.medium, false) == c.left);
        EXPECT_TRUE(leaveMedium(enterMedium(c.media, c.medium), c.medium) == (c.full == 0u ? c.media : c.media & ~(0x7fu << 21u)));
    }
    endTest();
}
