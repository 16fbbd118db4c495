// One thread is one sample of one case: pass.sampleCount threads for each. The first kLightCells of them also integrate over one cell each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "lib/hash.glsl"
#include "template_light.glsl"

// The light in cells of equal area: rings and sectors. Its rim is a rim of cells, so that no cell has a step in its density.
const uint kRings = 32u, kSectors = 64u, kLightCells = kRings * kSectors;
const uint kNodes = 8u;  // along each side of a cell

struct Case {
    vec3 p;         // the point that is lit; above it is +z
    TemplateLight light;
};

struct Result {
    vec3 point;      // on the light, from its centre, in a frame about its normal and in units of its radius
    float received;  // of radiance 1, by this sample alone
    float density;   // its integral over the cell of this thread
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

// At a radius in units of the light's.
vec3 pointAt(TemplateLight light, float radius, float turn)
{
    Frame frame = makeFrame(light.normal);
    vec2 disk = light.radius * radius * sampleCircle(turn);
    return light.center + frame.x * disk.x + frame.y * disk.y;
}

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD / pass.sampleCount];
        TemplateLightSample s = sampleTemplateLight(c.light, c.p, unitFloat(hash4(uvec4(TEST_THREAD, 0u, 0u, render.seed)).xy));
        EXPECT_NEAR(dot(s.wi, s.wi), 1.0, 2e-6);
        EXPECT_TRUE(s.pdf > 0.0);
        vec3 across = (c.p + s.far * s.wi - c.light.center) / c.light.radius;
        // At the rim rounding decides whether a direction meets the light.
        EXPECT_TRUE(dot(across, across) > 0.999 || isNear(pdfTemplateLight(c.light, c.p, s.wi), s.pdf, 1e-4 * s.pdf));

        uint cell = TEST_THREAD % pass.sampleCount;
        float sum = 0.0;
        for (uint i = 0u; cell < kLightCells && i < kNodes * kNodes; ++i) {
            vec2 inCell = (vec2(i / kNodes, i % kNodes) + 0.5) / float(kNodes);
            vec2 square = (vec2(cell / kSectors, cell % kSectors) + inCell) / vec2(kRings, kSectors);
            vec3 d = pointAt(c.light, sqrt(square.x), square.y) - c.p;
            float solidAngle = -dot(c.light.normal, d) / (dot(d, d) * length(d));  // per unit area
            sum += pdfTemplateLight(c.light, c.p, d / length(d)) * solidAngle;
        }
        sum *= kPi * c.light.radius * c.light.radius / float(kLightCells * kNodes * kNodes);
        vec3 beside = pointAt(c.light, 1.01, float(cell) / float(pass.sampleCount)) - c.p;
        EXPECT_EQUAL(pdfTemplateLight(c.light, c.p, beside / length(beside)), 0.0);
        EXPECT_EQUAL(pdfTemplateLight(c.light, c.p, -s.wi), 0.0);
        results[TEST_THREAD] = Result(frameFromWorld(makeFrame(c.light.normal), across), max(s.wi.z, 0.0) / s.pdf, sum);
    }
    endTest();
}
