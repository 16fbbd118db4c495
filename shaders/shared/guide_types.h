// What paths are guided by: where light comes from, learned before the picture (access/guide.glsl, host/render/guide.hpp).
#ifndef GLIM_SHARED_GUIDE_TYPES_H
#define GLIM_SHARED_GUIDE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// The guide's texels begin with the roots of k-d trees over points, one for each main direction of the shading normal: +x, -x, +y, -y, +z,
// -z.
GLIM_CONST uint kGuideRoots = 6u;
// Then there is a quadtree of one node, whose directions are uniform over the square: of points that no cell knows of.
GLIM_CONST uint kUniformQuadtree = kGuideRoots;

// A node of these trees. One texel.
struct GuideNode {
    float split;  // points below it go to the first child
    uint axis;    // or kGuideLeaf
    uint child;   // texel of the first child, which the second one follows; of a leaf's cell, or 0: it has none
    uint unused;
};
GLIM_CONST uint kGuideLeaf = 3u;

// What is known of the light that arrives in a leaf. Two texels.
struct GuideCell {
    vec3 center;
    float focus;      // metres from the point to where directions are seen from the centre; 0: infinite
    uint quadtree;    // texel of its root
    float share;      // of directions that are sampled by the guide; the others by the BSDF
    float radiance;   // that the surfaces there send out, relative to the mean of all cells
    float reflected;  // of it, what did not come from lights directly; W/(sr m^2)
};
GLIM_CONST uint kGuideCellTexels = 2u;

// A node of a quadtree over the square of directions (lib/guide.glsl). One texel. Quadrants are numbered x low, x high, and the same again
// for y high.
struct GuideQuad {
    float lowX;     // probability of x low
    vec2 lowY;      // probabilities of y low, given x low or high
    uint children;  // a bit for each quadrant that is divided, and from bit 4 on the texel of the first of these
};

// What learn_guide finds out at a path's vertex.
struct GuideRecord {
    vec3 point;
    float value;       // light that the next ray brought, times what the vertex makes of it and `throughput`; luminance
    uint direction;    // of that ray, and
    uint normal;       // the shading normal, both as lib/octahedral.glsl has them
    float throughput;  // luminance, on arrival; 0: no record
    float direct;      // light of the light sample, times `throughput`; luminance
};
GLIM_CONST uint kGuideRecords = 8u;  // of a path, at most

GLIM_SHARED_END
#endif
