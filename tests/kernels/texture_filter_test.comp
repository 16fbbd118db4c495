// One thread is one texture coordinate and one sRGB code. Results: its texels and linear value.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/texture_filter.glsl"

struct Case {
    float t;
    uint size;
    uint wrap;
    float srgb;
};

struct Result {
    uint first, second;
    float weight;
    uint nearest;
    float linear;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        TexelPair pair = bilinearTexels(c.t, c.size, c.wrap);
        uint nearest = nearestTexel(c.t, c.size, c.wrap);
        EXPECT_TRUE(pair.first < c.size && pair.second < c.size && nearest < c.size);
        EXPECT_TRUE(pair.weight >= 0.0 && pair.weight <= 1.0);
        vec3 linear = linearFromSrgb(vec3(c.srgb, 0.0, 1.0));
        EXPECT_TRUE(linear.y == 0.0 && abs(linear.z - 1.0) < 2e-7 && linear.z <= 1.0);
        results[TEST_THREAD] = Result(pair.first, pair.second, pair.weight, nearest, linear.x);
    }
    endTest();
}
