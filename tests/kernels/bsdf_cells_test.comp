// One thread is one cell of directions of one case. Result: the integrals of the density and of the BSDF times |cos| over it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "any_bsdf.glsl"

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { CellsCase cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { vec4 results[]; };

void main()
{
    if (isTestThread()) {
        uint at = TEST_THREAD / (kCells * kCells), cell = TEST_THREAD % (kCells * kCells);
        BsdfCase c = cases[at].bsdf;
        Principled p = makePrincipled(c.material, c.wo);
        vec4 sum = vec4(0.0);
        for (uint i = 0u; i < kCellNodes * kCellNodes; ++i) {
            vec3 longitude = cases[at].longitudes[cell / kCells * kCellNodes + i / kCellNodes];
            vec3 latitude = cases[at].latitudes[cell % kCells * kCellNodes + i % kCellNodes];
            bool polar = cases[at].polar != 0u;
            vec2 xy = polar ? longitude.x * latitude.yx : vec2(latitude.y * longitude.x, latitude.x), turn = cases[at].turn;
            float z = polar ? longitude.y : latitude.y * longitude.y, area = polar ? longitude.x : latitude.y;
            vec3 wi = vec3(xy.x * turn.x - xy.y * turn.y, xy.x * turn.y + xy.y * turn.x, cases[at].side * z);
            BsdfEval e = evalAny(c, p, wi);
            sum += vec4(e.pdf, e.f) * (area * latitude.z * longitude.z);
        }
        EXPECT_TRUE(all(greaterThanEqual(sum, vec4(0.0))));
        results[TEST_THREAD] = sum;
    }
    endTest();
}
