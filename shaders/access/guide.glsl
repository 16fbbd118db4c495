// The guide: which directions light comes from, as learned before the picture. Müller, Gross and Novák, "Practical Path Guiding for Efficient
// Light-Transport Simulation", 2017, learn with each sample and have quadtrees over directions, as here; that the directions of a cell are
// those that point at a sphere around its centre is glim's own. Ruppert, Herholz and Lensch, "Robust Fitting of Parallax-Aware Mixtures for
// Path Guiding", 2020, keep distances of lobes for the same end.
#ifndef GLIM_ACCESS_GUIDE
#define GLIM_ACCESS_GUIDE

#include "features.glsl"
#include "lib/guide.glsl"
#include "shared/guide_types.h"

layout(set = 0, binding = kBindGuide) uniform usamplerBuffer guideTexels;

// A cell, as it is seen from a point.
struct Guide {
    vec3 offset;  // from the cell's centre to the point
    float focus;
    uint quadtree;
    float share;
    float radiance;
    float reflected;
};

const Guide kNoGuide = Guide(vec3(0.0), 0.0, kUniformQuadtree, 0.0, 1.0, 0.0);

uint guideRootOf(vec3 n)
{
    vec3 a = abs(n);
    uint axis = a.x >= max(a.y, a.z) ? 0u : a.y >= a.z ? 1u : 2u;
    float along = axis == 0u ? n.x : axis == 1u ? n.y : n.z;
    return 2u * axis + (along < 0.0 ? 1u : 0u);
}

Guide fetchGuide(vec3 p, vec3 n)
{
    uvec4 node = texelFetch(guideTexels, int(guideRootOf(n)));
    while (node.y != kGuideLeaf) {
        float along = node.y == 0u ? p.x : node.y == 1u ? p.y : p.z;
        node = texelFetch(guideTexels, int(node.z + (along < uintBitsToFloat(node.x) ? 0u : 1u)));
    }
    if (node.z == 0u) {
        return kNoGuide;
    }
    vec4 a = uintBitsToFloat(texelFetch(guideTexels, int(node.z)));
    uvec4 b = texelFetch(guideTexels, int(node.z + 1u));
    Guide guide = Guide(p - a.xyz, a.w, b.x, uintBitsToFloat(b.y), uintBitsToFloat(b.z), uintBitsToFloat(b.w));
    // A point outside of its cell may be beyond the sphere.
    guide.focus = dot(guide.offset, guide.offset) < 0.8 * guide.focus * guide.focus ? guide.focus : 0.0;
    return guide;
}

// Descends the guide's quadtree: to the leaf where `at` is in the square of directions or, if it samples, to a leaf by the random numbers `at`.
// Returns the leaf's density over the square. `at`: then a point of the square in both cases. One loop for both, as neighbours on a SIMD
// device want the one and the other.
float descendGuide(Guide guide, bool samples, inout vec2 at)
{
    vec2 corner = vec2(0.0), inner = at;
    float size = 1.0, density = 1.0;
    uint node = guide.quadtree << 4u | 1u, quadrant = 0u;
    while ((node >> quadrant & 1u) != 0u) {
        uint before = bitCount(node & ((1u << quadrant) - 1u));
        uvec4 quad = texelFetch(guideTexels, int((node >> 4u) + before));
        vec3 low = uintBitsToFloat(quad.xyz);
        float split = samples ? low.x : 0.5;
        bool highX = inner.x >= split;
        inner.x = (inner.x - (highX ? split : 0.0)) / (highX ? 1.0 - split : split);
        float lowY = highX ? low.z : low.y;
        split = samples ? lowY : 0.5;
        bool highY = inner.y >= split;
        inner.y = (inner.y - (highY ? split : 0.0)) / (highY ? 1.0 - split : split);
        inner = min(inner, 0.99999994);
        density *= 4.0 * (highX ? 1.0 - low.x : low.x) * (highY ? 1.0 - lowY : lowY);
        size *= 0.5;
        corner += vec2(highX ? size : 0.0, highY ? size : 0.0);
        quadrant = (highX ? 1u : 0u) + (highY ? 2u : 0u);
        node = quad.w;
    }
    at = corner + size * inner;
    return density;
}

// A direction, and the guide's density for it per steradian.
struct GuideSample {
    vec3 w;
    float pdf;
};

// Of w or, if it samples, of a direction by the random numbers u. Rounding may take a sample to a neighbouring leaf, where pdfGuide() would
// have another density, perhaps 1e5 times less: a picture was 10 % too bright. So the leaf that was sampled gives the density.
GuideSample sampleGuideOr(Guide guide, bool samples, vec2 u, vec3 w)
{
    float jacobian = 1.0;
    vec3 seen = guide.focus > 0.0 ? seeFromCenter(guide.offset, guide.focus, w, jacobian) : w;
    vec2 at = samples ? u : squareFromDirection(seen);
    float density = descendGuide(guide, samples, at);
    if (samples) {
        w = seen = directionFromSquare(at);
        if (guide.focus > 0.0) {
            w = seeFromOrigin(guide.offset, guide.focus, seen);
            seeFromCenter(guide.offset, guide.focus, w, jacobian);
        }
    }
    return GuideSample(w, density * pdfOfSquare(seen) * jacobian);
}

// Per steradian.
float pdfGuide(Guide guide, vec3 w)
{
    return sampleGuideOr(guide, false, vec2(0.0), w).pdf;
}

#endif
