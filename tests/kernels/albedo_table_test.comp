// One thread is one look-up of the albedos. Result: the errors of a + b and of the sheen.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/albedo_table.glsl"

struct Case {
    float cosine, alpha;
    vec2 ab, average;  // expected
    float sheen;       // expected
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec2 results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        AlbedoRow row = albedoRow(c.alpha);
        vec2 ab = fetchAlbedo(row, c.cosine);
        float sheen = fetchSheenAlbedo(row, c.cosine);
        // The error of the table, as albedo_table.glsl states it.
        EXPECT_NEAR(ab.x, c.ab.x, 1.5e-3);
        EXPECT_NEAR(ab.y, c.ab.y, 1.5e-3);
        EXPECT_NEAR_VECTOR(fetchAverageAlbedo(row), c.average, 1.5e-3);
        results[TEST_THREAD] = vec2(abs(ab.x + ab.y - c.ab.x - c.ab.y), abs(sheen - c.sheen));
    }
    endTest();
}
