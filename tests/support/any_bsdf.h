// What the tests of sampling sample, in both languages: one lobe of shaders/lib/bsdf, or a whole material.
#ifndef GLIM_TESTS_ANY_BSDF_H
#define GLIM_TESTS_ANY_BSDF_H
#include "material_case.h"

GLIM_SHARED_BEGIN

GLIM_CONST uint kSamplePrincipled = 0u;
GLIM_CONST uint kSampleGgx = 1u;           // by anisotropy and roughness
GLIM_CONST uint kSampleTransmission = 2u;  // of a solid, by its index, `inside` and roughness
GLIM_CONST uint kSampleSheen = 3u;

GLIM_CONST uint kPointsHashed = 0u;   // independent
GLIM_CONST uint kPointsCorners = 1u;  // each number one of four, in all combinations

struct BsdfCase {
    vec3 wo;  // z above 0
    uint what;
    uint points;
    MaterialCase material;
};

struct SampledDirection {
    vec3 wi;
    float pdf;
    vec3 weight;
    uint flags;
};

// Half of all directions, in cells by longitude from the z axis and latitude towards y, with Gauss and Legendre's nodes in each: (sine,
// cosine, weight). The horizon is where the longitude is a right angle, so that no cell crosses it. If `polar` is 1, the angle from the z
// axis takes the place of the longitude, and the azimuth that of the latitude.
GLIM_CONST uint kCells = 32u;  // along each axis
GLIM_CONST uint kCellNodes = 4u;

struct CellsCase {
    BsdfCase bsdf;
    float side;  // of z: 1 or -1
    uint polar;
    vec2 turn;             // cosine and sine of the angle by which x and y are turned
    vec3 longitudes[128];  // kCells * kCellNodes
    vec3 latitudes[128];
};

GLIM_SHARED_END
#endif
