// The flattened scene as kernels read it. Scalar layout.
#ifndef GLIM_SHARED_SCENE_TYPES_H
#define GLIM_SHARED_SCENE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// A BVH node is five texels (uvec4, floats by their bits) and holds the boxes of its eight children on a grid of its own:
//   (origin.xyz, exponents | inner << 24) (first node, first record, entries 0-3, entries 4-7)
//   (lo.x 0-3, lo.x 4-7, lo.y 0-3, lo.y 4-7) (lo.z 0-3, lo.z 4-7, hi.x 0-3, hi.x 4-7) (hi.y 0-3, hi.y 4-7, hi.z 0-3, hi.z 4-7)
// Planes, one byte per child, are steps of 2^(exponent - 127) from the origin; exponents are a byte per axis. Bit i of `inner`: child
// i is a node. These follow one another from the first node on, in the order of the children; so do the records of leaves from the
// first record on. An entry's lower five bits are the place in a word of hits, and its upper three what to set there: bit
// kFirstNodeBit + i of an inner child, or a bit for each of a leaf's records, counted from the first. 0: no child.
GLIM_CONST uint kNodeTexels = 5u;
GLIM_CONST uint kMaxLeafRecords = 3u;
GLIM_CONST uint kFirstNodeBit = 24u;  // 8 leaves have as many records at most

// A record is three texels, in the order of the leaves; a primitive may have several, all alike:
//   triangle: (v0.xyz, primitive id) (v1.xyz, material, | kSliverBit) (v2.xyz, emitter + 1 or 0)
//   sphere:   (centre.xyz, primitive id) (radius, 0, 0, material | kSphereBit) (0, 0, 0, emitter + 1 or 0)
// The primitive id is the index in the scene (triangles, then spheres): rays name by it what they leave and where they end, and it breaks
// ties, so pictures do not depend on the tree.
// Smooth triangles have three texels more, in a buffer of its own: (n0.xyz, 0) (n1.xyz, 0) (n2.xyz, 0), zero where flat.
GLIM_CONST uint kRecordTexels = 3u;
GLIM_CONST uint kSphereBit = 0x80000000u;
GLIM_CONST uint kSliverBit = 0x40000000u;  // thinner than kSliverHeight
GLIM_CONST uint kMaterialMask = 0x3fffffffu;
// Height over longest side below which a triangle's edge functions are computed with the rounding errors of their products. Without
// these each is off by up to 2^-23 of that side's square, so that above this height a hit moves by less than 2^-11 of the side.
GLIM_CONST float kSliverHeight = 9.765625e-4f;
GLIM_CONST uint kNoRecord = 0xffffffffu;
GLIM_CONST uint kNoPrimitive = 0xffffffffu;

GLIM_CONST uint kLambert = 0u;
GLIM_CONST uint kMirror = 1u;
GLIM_CONST uint kGlass = 2u;

// Materials, lights and emitters are read as texels too (scene.glsl): a storage buffer's load costs llvmpipe as much for one
// word as a texel's four. Hence their sizes in whole texels and vec3s that share one with a scalar.
GLIM_CONST uint kMaterialTexels = 3u;
GLIM_CONST uint kLightTexels = 5u;
GLIM_CONST uint kEmitterTexels = 2u;

struct FlatMaterial {
    vec3 baseColor;
    uint scattering;   // kLambert, kMirror, kGlass
    vec3 emission;     // radiance, W/(sr m^2)
    float ior;
    uint doubleSided;  // 1: emits from both sides
    uvec3 unused;
};

GLIM_CONST uint kTriangleLight = 0u;  // all emissive triangles of one primitive, chosen by area
GLIM_CONST uint kSphereLight = 1u;
GLIM_CONST uint kPointLight = 2u;
GLIM_CONST uint kSpotLight = 3u;
GLIM_CONST uint kDirectionalLight = 4u;
GLIM_CONST uint kEnvironmentLight = 5u;

// One entry of an alias table (Walker 1977; Vose 1991): a bin keeps itself where the second number is below the threshold
// of 2^32, and is `other` elsewhere.
struct AliasEntry {
    uint threshold;
    uint other;
};

struct FlatLight {
    uint kind;
    uint firstEmitter;   // triangles and sphere: its emitters [firstEmitter, firstEmitter + emitterCount)
    uint emitterCount;
    float probability;   // with which the alias table as implemented chooses this light
    vec3 position;       // sphere: centre; point, spot
    float radius;        // sphere
    vec3 direction;      // spot, directional: unit, the way light travels
    float cosInner;      // spot
    vec3 intensity;      // radiance of surfaces and environment; W/sr of point and spot; W/m^2 of directional
    float cosOuter;      // spot
    AliasEntry alias;
    uint doubleSided;
    uint unused;
};

// A primitive that emits.
struct FlatEmitter {
    AliasEntry alias;  // among its light's emitters, indices relative to firstEmitter
    uint record;       // one of its records
    uint light;
    float areaPdf;     // of a point on it, per m^2, once its light is chosen; as the alias table implements it
    uint primitive;
    uvec2 unused;
};

GLIM_CONST uint kPerspective = 0u;
GLIM_CONST uint kOrthographic = 1u;

// For film coordinates (x, y) in [-1, 1], y up: perspective rays leave `position` along forward + x right + y up;
// orthographic rays leave position + x right + y up along forward. A thin lens moves the origin by a point of the disk with
// radii lensRight and lensUp, and turns the ray so that it meets the pinhole's one at the depth 1 / inverseFocus.
struct FlatCamera {
    vec3 position;
    vec3 right;
    vec3 up;
    vec3 forward;    // unit
    uint kind;
    vec3 lensRight;  // 0: a pinhole
    vec3 lensUp;
    float inverseFocus;
};

GLIM_SHARED_END
#endif
