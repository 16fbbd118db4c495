// The flattened scene as kernels read it. Scalar layout.
#ifndef GLIM_SHARED_SCENE_TYPES_H
#define GLIM_SHARED_SCENE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// A BVH node is five texels (uvec4, floats by their bits). It holds the boxes of its eight children, quantized to a grid of its own:
//   (origin.xyz, exponents | inner << 24) (first node, first record, entries 0-3, entries 4-7)
//   (lo.x 0-3, lo.x 4-7, lo.y 0-3, lo.y 4-7) (lo.z 0-3, lo.z 4-7, hi.x 0-3, hi.x 4-7) (hi.y 0-3, hi.y 4-7, hi.z 0-3, hi.z 4-7)
// Planes are one byte per child, in steps of 2^(exponent - 127) from the origin; exponents are one byte per axis. Bit i of `inner` is set
// if child i is a node. Child nodes follow one another from the first node on, in the order of the children; so do the records of leaves
// from the first record on. An entry is one byte per child. Its lower five bits are a place in the word of hits, its upper three the bits
// to set there: bit kFirstNodeBit + i of an inner child, or a bit for each of a leaf's records, counted from the first. 0: no child.
GLIM_CONST uint kNodeTexels = 5u;
GLIM_CONST uint kMaxLeafRecords = 3u;
GLIM_CONST uint kFirstNodeBit = 24u;  // 8 leaves have as many records at most

// Records are in the order of the leaves, three texels each. A primitive may have several, all alike:
//   triangle: (v0.xyz, primitive id) (v1.xyz, material, | kSliverBit) (v2.xyz, emitter + 1 or 0)
//   sphere:   (centre.xyz, primitive id) (radius, 0, 0, material | kSphereBit) (0, 0, 0, emitter + 1 or 0)
// The primitive id is the index in the scene (triangles, then spheres). A ray's source and target are primitive ids, and the lower id wins
// a tie, so pictures do not depend on the tree.
//
// Vertex normals are in two buffers of their own, so that further records of a primitive do not duplicate them. A triangle is one texel, by
// its primitive id: (vertex, vertex, vertex, 0). A vertex is one texel: (normal.xyz, 0). Vertex 0 has the normal 0; flat triangles consist
// of it. Scenes without any vertex normals have neither.
GLIM_CONST uint kRecordTexels = 3u;
GLIM_CONST uint kSphereBit = 0x80000000u;
GLIM_CONST uint kSliverBit = 0x40000000u;  // thinner than kSliverHeight
GLIM_CONST uint kMaterialMask = 0x3fffffffu;
// Below this ratio of height to longest side, a triangle's edge functions are corrected by the rounding errors of their products.
// Uncorrected, each is off by up to 2^-23 of that side's square, so that above this ratio a hit moves by less than 2^-11 of the side.
GLIM_CONST float kSliverHeight = 9.765625e-4f;
GLIM_CONST uint kNoRecord = 0xffffffffu;
GLIM_CONST uint kNoPrimitive = 0xffffffffu;

// Lobes of a material (lib/bsdf).
GLIM_CONST uint kLambert = 0u;
GLIM_CONST uint kMirror = 1u;
GLIM_CONST uint kDielectric = 2u;

// Materials, lights and emitters are read as texels too (scene.glsl): on llvmpipe, loading one word of a storage buffer costs as much as
// loading the four of a texel. So structs are whole texels, and each vec3 shares one with a scalar.
GLIM_CONST uint kMaterialTexels = 3u;
GLIM_CONST uint kLightTexels = 5u;
GLIM_CONST uint kEmitterTexels = 2u;

struct MaterialData {
    vec3 baseColor;
    uint lobe;      // kLambert, kMirror, kDielectric
    vec3 emission;  // radiance, W/(sr m^2)
    float ior;
    uint doubleSided;  // 1: emits from both sides
    uvec3 unused;
};

GLIM_CONST uint kTriangleLight = 0u;  // all triangles of one instance of an emissive mesh, chosen by area
GLIM_CONST uint kSphereLight = 1u;
GLIM_CONST uint kPointLight = 2u;
GLIM_CONST uint kSpotLight = 3u;
GLIM_CONST uint kDirectionalLight = 4u;
GLIM_CONST uint kEnvironmentLight = 5u;

// One entry of an alias table (Walker 1977; Vose 1991). The bin is kept if the second random number is below the threshold (of 2^32);
// otherwise it is replaced by `other`.
struct AliasEntry {
    uint threshold;
    uint other;
};

struct FlatLight {
    uint kind;
    uint firstEmitter;  // triangles and sphere: its emitters [firstEmitter, firstEmitter + emitterCount)
    uint emitterCount;
    float probability;  // of choosing this light, as the alias table implements it
    vec3 position;      // sphere: centre; point, spot
    float radius;       // sphere
    vec3 direction;     // spot, directional: unit, the way light travels
    float cosInner;     // spot
    vec3 intensity;     // surfaces, environment: radiance; point, spot: W/sr; directional: W/m^2
    float cosOuter;     // spot
    AliasEntry alias;
    uint doubleSided;
    uint unused;
};

// A primitive that emits.
struct FlatEmitter {
    AliasEntry alias;  // among its light's emitters, indices relative to firstEmitter
    uint record;       // one of its records
    uint light;
    float areaPdf;  // of a point on it, per m^2, once its light is chosen; as the alias table implements it
    uint primitive;
    uvec2 unused;
};

GLIM_CONST uint kPerspective = 0u;
GLIM_CONST uint kOrthographic = 1u;

// For film coordinates (x, y) in [-1, 1], y up: perspective rays leave `position` along forward + x right + y up;
// orthographic rays leave position + x right + y up along forward. A thin lens moves the origin by a point of the disk with
// radii lensRight and lensUp, and turns the ray so that it meets the pinhole's ray at the depth 1 / inverseFocus.
struct FlatCamera {
    vec3 position;
    vec3 right;
    vec3 up;
    vec3 forward;  // unit
    uint kind;
    vec3 lensRight;  // 0: a pinhole
    vec3 lensUp;
    float inverseFocus;
};

GLIM_SHARED_END
#endif
