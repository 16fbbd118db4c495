// What paths are guided by: where light comes from, learned before the picture (access/guide.glsl, host/render/guide.hpp).
#ifndef GLIM_SHARED_GUIDE_TYPES_H
#define GLIM_SHARED_GUIDE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// The guide's texels begin with the roots of k-d trees over points, one for each main direction of the shading normal: +x, -x, +y, -y, +z,
// -z. Then there is a quadtree of one node, whose directions are uniform over the square: of points that no cell knows of. Then, if the
// guide is for scatterings in media too, the root of a tree over these.
GLIM_CONST uint kGuideRoots = 6u;
GLIM_CONST uint kUniformQuadtree = kGuideRoots;
GLIM_CONST uint kGuideOfScatterings = 7u;

// A node of these trees: two levels of splits. One texel.
struct GuideNode {
    float split;      // points below it go to the first half
    vec2 halfSplits;  // and those below the half's own to the first quarter of it
    uint children;    // axes of the three splits, two bits each; a bit for each quarter that is a cell, no node; from bit 10 on, the block
                      // of the quarters
};
GLIM_CONST uint kGuideNoSplit = 3u;      // as axis: all points go to the first child
GLIM_CONST uint kGuideBlockTexels = 8u;  // two for each quarter

// What is known of the light that arrives at some points. Two texels.
struct GuideCell {
    vec3 center;
    float focus;      // metres from the point to where directions are seen from the centre; 0: infinite
    uint quadtree;    // texel of its root
    uint sight;       // how well lights are seen from there; 0: it is unknown
    float radiance;   // that the surfaces there send out, relative to the mean of all cells
    float reflected;  // of it, what did not come from lights directly; W/(sr m^2)
};
GLIM_CONST float kGuideShare = 0.7F;  // of directions that are sampled by the guide, if the cell has a quadtree; the others by the BSDF

// What `sight` has for each child of the light tree's root, for infinite lights and for finite ones: three bits, half octaves by which they
// are chosen less often. Its last two bits are octaves by which lights are sampled less often.
GLIM_CONST uint kSightOfInfinite = 8u, kSightOfFinite = 9u, kSightGroups = 10u;
GLIM_CONST uint kSightSteps = 7u, kSampleSteps = 3u;

GLIM_FUNCTION float computeSight(uint sight, uint lights)
{
    uint step = sight >> (3u * lights) & 7u;
    return ((step & 1u) != 0u ? 0.70710678F : 1.0F) / float(1u << (step >> 1u));
}

// Probability that a light is sampled.
GLIM_FUNCTION float lightSampleShare(uint sight) { return 1.0F / float(1u << (sight >> 30u)); }

// A node of a quadtree over the square of directions (lib/guide.glsl): two levels of it, 16 quadrants. One texel. Quadrants are numbered
// x low, x high, and the same again for y high; those of the second level from 4 times that number on. Words have six bits, which
// guideProbability() reads, for the square and then for each of its quadrants.
struct GuideQuad {
    uint lowX;        // of x low
    uint lowYOfLowX;  // of y low, given x low
    uint lowYOfHighX;
    uint children;  // a bit for each quadrant that is divided; from bit 16 on, the place of the first of these after the tree's root
};
GLIM_CONST uint kGuideHalves = 0x20820820u;  // five words of 1/2

// Of a word of six bits, 1 to 63. Exact in float, and fine near 0 and 1, where bright places leave little for others: the smoothstep of
// word / 64.
GLIM_FUNCTION float guideProbability(uint word)
{
    float t = float(word) * 0.015625F;
    return t * t * (3.0F - 2.0F * t);
}

// What learn_guide finds out at a path's vertex.
struct GuideRecord {
    vec3 point;
    float value;       // light that the next ray brought, times what the vertex makes of it and `throughput`; luminance
    uint direction;    // of that ray, and
    uint normal;       // the shading normal, both as lib/octahedral.glsl has them; of a scattering kNoReceiverNormal
    float throughput;  // luminance, on arrival; 0: no record
    uint direct;       // the light sample: lights, and its light times `throughput`; see packDirect() in access/guide_records.glsl
};
// Luminance without its last four bits, which say of which lights the sample is (kSightOfInfinite); the sign: it did not arrive.
GLIM_CONST uint kSampledLights = 15u, kSampleBlocked = 1u << 31u;
GLIM_CONST uint kGuideRecords = 8u;  // of a path, at most

GLIM_SHARED_END
#endif
