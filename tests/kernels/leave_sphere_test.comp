// One thread is one hit of a sphere, from outside or inside, and one ray that leaves it to either side.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "expect.glsl"
#include "access/interaction.glsl"
#include "access/traverse.glsl"
#include "lib/hash.glsl"
#include "lib/frame.glsl"
#include "lib/warp.glsl"

uvec4 randomBits(uint dimension)
{
    return hash4(uvec4(TEST_THREAD, dimension, 0u, render.seed));
}


void main()
{
    uvec4 bits = randomBits(0u);
    uint index = chooseBin(bits.x, uint(textureSize(scenePrimitiveRefs)) / kPrimitiveRefTexels);
    PrimitiveRef ref = fetchPrimitiveRef(index);
    vec3 center = toFloats(ref.t0);
    float radius = uintBitsToFloat(ref.t1.x);
    bool inside = (bits.y & 1u) != 0u;
    vec3 n = sampleSphere(unitFloat(bits.zw));
    vec3 side = inside ? -n : n;
    vec3 towards = -worldFromFrame(makeFrame(side), sampleCosineHemisphere(unitFloat(randomBits(1u).xy)));
    // Starts well within the sphere's half of the way, or one radius outside.
    vec3 origin = center + radius * n - towards * (radius * (inside ? max(0.01, -dot(towards, side)) : 1.0));
    PathRay ray = PathRay(origin, kNoPrimitive, towards, 0u);
    PathHit hit = traceClosest(ray);
    if (dot(towards, side) < -0.02) {
        EXPECT_EQUAL(hit.primitiveRef, index);
        SurfaceInteraction surface = makeSurfaceInteraction(ray, hit);
        EXPECT_EQUAL(uint(surface.front), uint(!inside));
        EXPECT_CLOSE(length(surface.p - center), radius, 1e-6);
        uvec4 more = randomBits(2u);
        bool inwards = (more.z & 1u) != 0u;
        vec3 outwards = normalize(surface.p - center);
        vec3 wi = worldFromFrame(makeFrame(inwards ? -outwards : outwards), sampleCosineHemisphere(unitFloat(more.xy)));
        vec3 start = offsetRayOrigin(surface, wi);
        PathHit next = traceClosest(PathRay(start, getPrimitive(ref), wi, 0u));
        float cosine = dot(wi, outwards);
        if (!inwards && cosine > 1e-5) {  // 0 once in 1e7, on the rim of the hemisphere
            EXPECT_TRUE(next.primitiveRef != index);
        }
        if (inwards && cosine < -0.02) {
            EXPECT_EQUAL(next.primitiveRef, index);
            // The start is off the sphere by up to twice the bound, which moves both roots by that over the cosine.
            EXPECT_NEAR(next.t, -2.0 * radius * cosine, 4.0 * length(surface.errorBound) / -cosine);
        }
    }
    endTest();
}
