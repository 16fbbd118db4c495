// The flattened scene as kernels read it. Scalar layout.
#ifndef GLIM_SHARED_SCENE_TYPES_H
#define GLIM_SHARED_SCENE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// A BVH node is four texels (uvec4, floats by their bits) and holds the boxes of both its children:
//   (lo0.xyz, child0) (hi0.xyz, child1) (lo1.xyz, count0) (hi1.xyz, count1)
// A child with count 0 is the inner node of that index; otherwise it is the leaf of records [child, child + count).
// kEmptyLeaf as count is a leaf of nothing.
GLIM_CONST uint kNodeTexels = 4u;
GLIM_CONST uint kEmptyLeaf = 0xffffffffu;

// A record is three texels, in the order of the leaves:
//   triangle: (v0.xyz, primitive id) (v1.xyz, material) (v2.xyz, emitter + 1 or 0)
//   sphere:   (centre.xyz, primitive id) (radius, 0, 0, material | kSphereBit) (0, 0, 0, emitter + 1 or 0)
// The primitive id is the index in the scene (triangles, then spheres): it breaks ties, so pictures do not depend on the tree.
// Smooth triangles have three texels more, in a buffer of its own: (n0.xyz, 0) (n1.xyz, 0) (n2.xyz, 0), zero where flat.
GLIM_CONST uint kRecordTexels = 3u;
GLIM_CONST uint kSphereBit = 0x80000000u;
GLIM_CONST uint kNoRecord = 0xffffffffu;

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

// A record that emits.
struct FlatEmitter {
    AliasEntry alias;  // among its light's emitters, indices relative to firstEmitter
    uint record;
    uint light;
    float areaPdf;     // of a point on it, per m^2, once its light is chosen; as the alias table implements it
    uvec3 unused;
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
