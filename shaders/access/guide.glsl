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
    float share;  // of directions that are sampled by the guide
    float radiance;
    float reflected;
    uint sight;
};

const Guide kNoGuide = Guide(vec3(0.0), 0.0, kUniformQuadtree, 0.0, 1.0, 0.0, 0u);

// What learn_guide wants to know of a vertex.
struct LearnedVertex {
    vec3 point;
    uint normal;      // as in GuideRecord
    vec3 throughput;  // of what the vertex sends out; 0: the path has ended on arrival
    vec3 known;       // light that the guide expects it to send out, besides that of light samples
    vec3 sampled;     // light of its light sample, if nothing is in the way
    uint lights;      // of which that is
    bool isNarrow;    // what it sends out comes from one direction, as that of a mirror
};

// A lobe this narrow, per steradian, is for the guide what a mirror is: light that comes by it belongs to the vertex before.
const float kNarrowPdf = 16.0;

uint guideRootOf(vec3 n)
{
    vec3 a = abs(n);
    uint axis = a.x >= max(a.y, a.z) ? 0u : a.y >= a.z ? 1u : 2u;
    float along = axis == 0u ? n.x : axis == 1u ? n.y : n.z;
    return 2u * axis + (along < 0.0 ? 1u : 0u);
}

bool isAbove(vec3 p, uint axis, float split)
{
    return axis != kGuideNoSplit && (axis == 0u ? p.x : axis == 1u ? p.y : p.z) >= split;
}

// `root`: of the tree.
Guide fetchGuide(vec3 p, uint root)
{
    uint at = root;
    bool isCell = false;
    while (!isCell) {
        uvec4 node = texelFetch(guideTexels, int(at));
        bool upper = isAbove(p, node.w & 3u, uintBitsToFloat(node.x));
        bool above = isAbove(p, node.w >> (upper ? 4u : 2u) & 3u, uintBitsToFloat(upper ? node.z : node.y));
        uint quarter = (upper ? 2u : 0u) + (above ? 1u : 0u);
        at = kGuideBlockTexels * (node.w >> 10u) + 2u * quarter;
        isCell = (node.w >> (6u + quarter) & 1u) != 0u;
    }
    vec4 a = uintBitsToFloat(texelFetch(guideTexels, int(at)));
    uvec4 b = texelFetch(guideTexels, int(at + 1u));
    Guide guide = Guide(p - a.xyz, a.w, b.x, b.x != kUniformQuadtree ? kGuideShare : 0.0, uintBitsToFloat(b.z), uintBitsToFloat(b.w), b.y);
    // A point outside of its cell may be beyond the sphere.
    guide.focus = dot(guide.offset, guide.offset) < 0.8 * guide.focus * guide.focus ? guide.focus : 0.0;
    return guide;
}

Guide fetchGuide(vec3 p, vec3 n)
{
    return fetchGuide(p, guideRootOf(n));
}

// Where a descent has come to in the square of directions.
struct GuidePlace {
    vec2 corner;  // of the quadrant
    vec2 inner;   // place in it, or random numbers that are left, in [0, 1)
    float size, density;
};

// One level: goes to a quadrant and returns its number. `square`: number of the words for what is divided.
uint enterQuadrant(uvec4 quad, uint square, bool samples, inout GuidePlace place)
{
    uint shift = 6u * square;
    float lowX = guideProbability(quad.x >> shift & 63u);
    float split = samples ? lowX : 0.5;
    bool highX = place.inner.x >= split;
    place.inner.x = (place.inner.x - (highX ? split : 0.0)) / (highX ? 1.0 - split : split);
    float lowY = guideProbability((highX ? quad.z : quad.y) >> shift & 63u);
    split = samples ? lowY : 0.5;
    bool highY = place.inner.y >= split;
    place.inner.y = (place.inner.y - (highY ? split : 0.0)) / (highY ? 1.0 - split : split);
    place.inner = min(place.inner, 0.99999994);
    place.density *= 4.0 * (highX ? 1.0 - lowX : lowX) * (highY ? 1.0 - lowY : lowY);
    place.size *= 0.5;
    place.corner += vec2(highX ? place.size : 0.0, highY ? place.size : 0.0);
    return (highX ? 1u : 0u) + (highY ? 2u : 0u);
}

// Descends the guide's quadtree: to the leaf where `at` is in the square of directions or, if it samples, to a leaf by the random numbers `at`.
// Returns the leaf's density over the square. `at`: then a point of the square in both cases. One loop for both, as neighbours on a SIMD
// device want the one and the other.
float descendGuide(Guide guide, bool samples, inout vec2 at)
{
    GuidePlace place = GuidePlace(vec2(0.0), at, 1.0, 1.0);
    uint node = guide.quadtree;
    bool divided = true;
    while (divided) {
        uvec4 quad = texelFetch(guideTexels, int(node));
        uint first = enterQuadrant(quad, 0u, samples, place);
        uint quadrant = 4u * first + enterQuadrant(quad, 1u + first, samples, place);
        divided = (quad.w >> quadrant & 1u) != 0u;
        node = guide.quadtree + (quad.w >> 16u) + bitCount(quad.w & ((1u << quadrant) - 1u));
    }
    at = place.corner + place.size * place.inner;
    return place.density;
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

// Of directions that the guide samples in its share, and a BSDF or a phase function else. Per steradian.
float mixPdfs(Guide guide, float guidePdf, float otherPdf)
{
    return guide.share * guidePdf + (1.0 - guide.share) * otherPdf;
}

// Per steradian.
float pdfGuide(Guide guide, vec3 w)
{
    return sampleGuideOr(guide, false, vec2(0.0), w).pdf;
}

#endif
