// One thread is a path at a surface that its ray has met: where it goes on.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/path_vertex.glsl"

struct Case {
    SurfaceInteraction si;
    PathRay ray;
    PathState state;
};

struct Result {
    uint alive;
    PathRay ray;
    PathState state;
};

layout(set = 0, binding = kBindCases, scalar) readonly buffer Cases { Case cases[]; };
layout(set = 0, binding = kBindResults, scalar) writeonly buffer Results { Result results[]; };

void main()
{
    if (isTestThread()) {
        Case c = cases[TEST_THREAD];
        vec3 wo = -c.ray.direction;
        SurfaceMaterial material = makeSurfaceMaterial(c.si);
        Bsdf bsdf = makeBsdf(c.si, material, wo);
        PathState before = c.state;
        bool alive = bouncePath(SampleId(render.seed, TEST_THREAD, 0u), c.si, bsdf, wo, 0u, c.ray, c.state);
        EXPECT_TRUE(!alive || c.state.bounce == before.bounce + 1u);
        EXPECT_TRUE(!alive || distance(decodeNormal(c.state.normal), bsdf.frame.z) < 7e-5);
        // The sampled direction can be evaluated, with the same density, unless it is of a delta lobe.
        BounceNumbers u = sampleBounceNumbers(SampleId(render.seed, TEST_THREAD, 0u), before.bounce);
        BsdfSample s = sampleBsdf(bsdf, wo, u.direction, u.lobe);
        BsdfEval f = evalBsdf(bsdf, wo, s.wi);
        // Together they give the same.
        vec3 elsewhere = normalize(bsdf.frame.z + 0.5 * bsdf.frame.x);
        BsdfPair pair = evalAndSampleBsdf(bsdf, wo, elsewhere, u.direction, u.lobe);
        EXPECT_TRUE(pair.next == s && pair.light == evalBsdf(bsdf, wo, elsewhere));
        bool delta = (s.flags & kBsdfDelta) != 0u;
        bool absorbed = s.weight == vec3(0.0);  // a microfacet sent the ray below the surface
        EXPECT_TRUE(delta != hasNonDelta(bsdf) && (absorbed || delta == (s.pdf == 0.0)));
        EXPECT_TRUE(!delta || f.pdf == 0.0 && f.f == vec3(0.0));
        // Rounding of wi changes a cosine of .01 by 6e-6 of it.
        bool grazing = dot(s.wi, bsdf.ng) < 1e-5 || dot(s.wi, bsdf.frame.z) < 1e-2;
        EXPECT_TRUE(delta || grazing || abs(f.pdf - s.pdf) <= 1e-5 * s.pdf);
        EXPECT_TRUE(delta || grazing || distance(f.f / s.pdf, s.weight) <= 2e-5 * length(s.weight));
        results[TEST_THREAD] = Result(uint(alive), c.ray, c.state);
    }
    endTest();
}
