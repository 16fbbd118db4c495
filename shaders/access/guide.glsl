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

const Guide kNoGuide = Guide(vec3(0.0), 0.0, 0u, 0.0, 1.0, 0.0);

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

// A unit direction. `pdf`, per steradian, is pdfGuide() but for directions that rounding takes to a neighbouring leaf: those would be weighted
// by its density, which may be 1e5 times less, and a picture was 10 % too bright.
vec3 sampleGuide(Guide guide, vec2 u, out float pdf)
{
    vec2 corner = vec2(0.0);
    float size = 1.0;
    uint node = guide.quadtree | kGuideQuadNode;
    while ((node & kGuideQuadNode) != 0u) {
        int at = int(node & ~kGuideQuadNode);
        vec4 low = uintBitsToFloat(texelFetch(guideTexels, at));
        uvec4 quadrants = texelFetch(guideTexels, at + 1);
        bool highX = u.x >= low.x;
        u.x = highX ? (u.x - low.x) / (1.0 - low.x) : u.x / low.x;
        float lowY = highX ? low.z : low.y;
        bool highY = u.y >= lowY;
        u.y = highY ? (u.y - lowY) / (1.0 - lowY) : u.y / lowY;
        u = min(u, 0.99999994);
        size *= 0.5;
        corner += vec2(highX ? size : 0.0, highY ? size : 0.0);
        node = highY ? (highX ? quadrants.w : quadrants.z) : (highX ? quadrants.y : quadrants.x);
    }
    vec3 seen = directionFromSquare(corner + size * u), w = seen;
    float jacobian = 1.0;
    if (guide.focus > 0.0) {
        w = seeFromOrigin(guide.offset, guide.focus, seen);
        seeFromCenter(guide.offset, guide.focus, w, jacobian);
    }
    pdf = uintBitsToFloat(node) * pdfOfSquare(seen) * jacobian;
    return w;
}

// Per steradian.
float pdfGuide(Guide guide, vec3 w)
{
    float jacobian = 1.0;
    if (guide.focus > 0.0) {
        w = seeFromCenter(guide.offset, guide.focus, w, jacobian);
    }
    vec2 square = squareFromDirection(w);
    uint node = guide.quadtree | kGuideQuadNode;
    while ((node & kGuideQuadNode) != 0u) {
        uvec4 quadrants = texelFetch(guideTexels, int((node & ~kGuideQuadNode) + 1u));
        bvec2 high = greaterThanEqual(square, vec2(0.5));
        square = 2.0 * square - vec2(high);
        node = high.y ? (high.x ? quadrants.w : quadrants.z) : (high.x ? quadrants.y : quadrants.x);
    }
    return uintBitsToFloat(node) * pdfOfSquare(w) * jacobian;
}

#endif
