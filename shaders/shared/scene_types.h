// The flattened scene as kernels read it. Scalar layout.
#ifndef GLIM_SHARED_SCENE_TYPES_H
#define GLIM_SHARED_SCENE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// A BVH node is five texels (uvec4, floats by their bits). It holds the boxes of its eight children, quantized to a grid of its own:
//   (origin.xyz, exponents | inner << 24) (first node, first reference, entries 0-3, entries 4-7)
//   (lo.x 0-3, lo.x 4-7, lo.y 0-3, lo.y 4-7) (lo.z 0-3, lo.z 4-7, hi.x 0-3, hi.x 4-7) (hi.y 0-3, hi.y 4-7, hi.z 0-3, hi.z 4-7)
// Planes are one byte per child, in steps of 2^(exponent - 127) from the origin; exponents are one byte per axis. Bit i of `inner` is set
// if child i is a node. Child nodes follow one another from the first node on, in the order of the children; so do the references of leaves
// from the first reference on. An entry is one byte per child. Its lower five bits are a place in the word of hits, its upper three the
// bits to set there: bit kFirstNodeBit + i of an inner child, or a bit for each of a leaf's references, counted from the first. 0: no
// child.
//
// With kFeatureInstances, a node without entries is an instance of a shared mesh, which has a tree of its own:
//   (row 0 of meshFromWorld) (root of the mesh's tree, 0, 0, 0) (row 1) (row 2) (firstRef, firstPrimitive, motion of its InstanceData, 0)
GLIM_CONST uint kNodeTexels = 5u;
GLIM_CONST uint kMaxLeafRefs = 3u;
GLIM_CONST uint kFirstNodeBit = 24u;  // 8 leaves have as many references at most

// Primitive references are in the order of the leaves, three texels each. A primitive may have several, all alike:
//   triangle: (v0.xyz, primitive id) (v1.xyz, material | bits) (v2.xyz, light + 1 or 0)
//   sphere:   (centre.xyz, primitive id) (radius, alpha, 0, material | bits) (colour.rgb, light + 1 or 0)
//   line:     (end.xyz, primitive id) (to the other end, material | bits) (radius, packed colour, light + 1 or 0)
// A line is a sphere that moves from end to end, and has its bit. Colours of lines are four channels of 16 bits each, in steps of 2^-15.
// Without kFeaturePointColors colour and alpha of spheres and lines are 0 and mean nothing.
// The primitive id is the index in the scene (triangles, then spheres). A ray's source and target are primitive ids, and the lower id wins
// a tie, so pictures do not depend on the tree.
//
// What shading reads of the vertices is in two buffers of their own, so that further references of a primitive do not duplicate it. A
// triangle is one texel, by its primitive id: (vertex, vertex, vertex, 0). Vertex i is one texel in each section that the scene has: at i
// its normal (xyz, 0), at firstUv + i its texture coordinates (set 0, set 1), at firstTangent + i its tangent (xyz, sign of the bitangent),
// at firstColor + i its colour (RenderParameters). Flat triangles have the normal 0. Vertex 0 is that of triangles without any attribute.
// Scenes that need none of it have neither buffer.
//
// Shared meshes come last, in a space of their own. Their triangles have the primitive ids after the scene's spheres. A hit of an instance
// has a reference and a primitive id of its own: those of the mesh plus firstRef and firstPrimitive, modulo 2^32. The references of
// instances begin at RenderParameters::firstInstanceRef, in the order of the instances; no buffer has them.
GLIM_CONST uint kPrimitiveRefTexels = 3u;
GLIM_CONST uint kSphereBit = 0x80000000u;
GLIM_CONST uint kSliverBit = 0x40000000u;       // thinner than kSliverHeight; with kSphereBit: a line
GLIM_CONST uint kAlphaBit = 0x20000000u;        // neither opaque all over nor transparent all over
GLIM_CONST uint kSingleSidedBit = 0x10000000u;  // not there for rays from behind
GLIM_CONST uint kObjectBit = 0x08000000u;       // of scenes with catchers: neither a catcher nor a light
GLIM_CONST uint kMaterialMask = 0x07ffffffu;
// Below this ratio of height to longest side, a triangle's edge functions are corrected by the rounding errors of their products.
// Uncorrected, each is off by up to 2^-23 of that side's square, so that above this ratio a hit moves by less than 2^-11 of the side.
GLIM_CONST float kSliverHeight = 9.765625e-4f;
GLIM_CONST uint kNoPrimitiveRef = 0xffffffffu;
GLIM_CONST uint kNoPrimitive = 0xffffffffu;
GLIM_CONST uint kUnsampledLight = 0xffffffffu;  // of lines that emit: in the place of light + 1

// Types of materials (access/bsdf.glsl). The first three have one lobe (lib/bsdf).
GLIM_CONST uint kLambert = 0u;
GLIM_CONST uint kMirror = 1u;
GLIM_CONST uint kDielectric = 2u;
GLIM_CONST uint kPrincipled = 3u;  // everything else that glTF has
GLIM_CONST uint kUnlit = 4u;       // the base colour as the camera sees it; no other ray meets it

// The lobes of kPrincipled (access/principled.glsl).
GLIM_CONST uint kLobeInterface = 0u;
GLIM_CONST uint kLobeDiffuse = 1u;
GLIM_CONST uint kLobeCoat = 2u;
GLIM_CONST uint kLobeSheen = 3u;
GLIM_CONST uint kLobeThrough = 4u;  // diffuse transmission

// Materials, lights and nodes of lights are read as texels too (scene.glsl): on CPUs, loading one word of a storage buffer costs as
// much as loading the four of a texel. So structs are whole texels, and each vec3 shares one with a scalar.
GLIM_CONST uint kMaterialTexels = 3u;
GLIM_CONST uint kPrincipledTexels = 4u;
GLIM_CONST uint kLayersTexels = 6u;
GLIM_CONST uint kMediumTexels = 2u;
GLIM_CONST uint kScatteringTexels = 1u;
GLIM_CONST uint kTextureTexels = 3u;
GLIM_CONST uint kLightTexels = 5u;
GLIM_CONST uint kLightNodeTexels = 3u;

// An instance of a shared mesh. In these terms a point of the mesh's space is linear * p + translation in the scene's.
struct InstanceData {
    vec3 column0;   // of the linear part
    uint beginRef;  // the first of its references
    vec3 column1;
    uint firstRef;  // its references minus those of the mesh
    vec3 column2;
    uint firstPrimitive;  // its primitive ids minus those of the mesh
    vec3 translation;
    uint mirrors;     // 1: the linear part has a negative determinant
    vec3 errorBound;  // of a point of it, from rounding both ways
    uint motion;      // texel of its motion plus 1, or 0; its place above is then that of the frame's time
};
GLIM_CONST uint kInstanceTexels = 5u;
GLIM_CONST uint kNoInstance = 0xffffffffu;

// A motion is a texel (pivot, number of keys) and its keys, two or more. At a key a point p of the mesh's space is at
// rotation * stretch * (p + pivot) + translation in the scene's. A camera's motion has no stretch and no pivot: it rotates the camera of
// the frame's time. Between keys all are linear, but the rotation, which turns evenly. Two keys of the same time are a jump.
struct FlatMotionKey {
    vec3 translation;
    float time;         // 0: the shutter opens; 1: it closes
    vec4 rotation;      // a unit quaternion, x y z w
    vec3 stretch;       // the diagonal of a symmetric matrix
    float angle;        // between this quaternion and the next key's, at most a right angle
    vec3 shear;         // the other entries: yz, xz, xy
    float inverseSine;  // of the angle; 0: too small for that, and rotations are linear
};
GLIM_CONST uint kMotionKeyTexels = 4u;

GLIM_CONST uint kDoubleSided = 1u;  // emits from both sides
GLIM_CONST float kCoverage = -1.0;  // alpha is the share of light that the surface meets
GLIM_CONST float kOpaque = -2.0;    // alpha is 1, whatever textures say
GLIM_CONST uint kThinWall = 2u;     // light passes it straight (access/transparency.glsl): it is smooth and has no medium
GLIM_CONST uint kCatcher = 4u;      // of shadows (access/catcher.glsl)

// Lights in groups (access/light_groups.glsl): where the number of the group is in MaterialData::flags and in FlatLight::kind.
GLIM_CONST uint kLightGroupShift = 16u;
GLIM_CONST uint kMaxLightGroups = 8u;

struct MaterialData {
    vec3 baseColor;
    uint type;          // kLambert ...
    vec3 emission;      // radiance, W/(sr m^2)
    float ior;          // of a solid that transmits
    uint flags;         // kDoubleSided | kThinWall | kCatcher, and the light group of what it emits
    uint principled;    // texel of its PrincipledData, if it has one
    float alpha;        // of primitives with kAlphaBit, before textures
    float alphaCutoff;  // of those: below it they are transparent, else opaque; or kCoverage or kOpaque
};

// The rest of a material. It lies in the buffer of the materials, behind them; behind that the layers, the textures and the media.
struct PrincipledData {
    float metallic;
    float roughness;
    float reflectance;  // at normal incidence, of the index of refraction
    float specular;
    vec3 specularColor;
    float normalScale;
    uint textures;      // bit i: it has one in slot i of texture_slots.h
    uint firstTexture;  // texel of the TextureData of the first of these; the others follow in the order of slots
    uint layers;        // texel of its LayersData, or 0
    uint glossy;        // 1: KHR_materials_pbrSpecularGlossiness; roughness is the glossiness
    uvec4 unused;       // keeps the fingerprints of scenes without textures and layers, by which films are merged
};

// What the extensions add, a texel for each. The factor 0 leaves a layer out.
struct LayersData {
    float clearcoat;
    float clearcoatRoughness;
    float clearcoatNormalScale;
    uint unusedOfClearcoat;
    vec3 sheenColor;
    float sheenRoughness;
    float anisotropy;
    float anisotropyCosine, anisotropySine;  // of its rotation, counter-clockwise from the tangent
    uint unusedOfAnisotropy;
    float iridescence;
    float iridescenceIor;
    float iridescenceThicknessMinimum, iridescenceThicknessMaximum;  // nm
    vec3 diffuseTransmissionColor;
    float diffuseTransmission;
    float transmission;
    uint medium;          // number of what it encloses, from 1 on; 0: a thin wall
    uint scattersThin;    // 1: diffuseTransmission is a share of what is transmitted, else of the diffuse base
    float backscattered;  // then: the share of that light which goes back
};

// What is inside a solid that transmits. Medium 1 is at RenderParameters::firstMedium.
struct MediumData {
    vec3 extinction;  // absorption and scattering, 1/m
    float ior;        // at 587.6 nm
    float spread;     // of the index over wavelengths (lib/dispersion.glsl)
    vec3 unused;
};
// How light is scattered there (kFeatureScattering). That of medium 1 is at RenderParameters::firstScattering.
struct ScatteringData {
    vec3 albedo;       // the share of extinction that scatters
    float anisotropy;  // mean cosine of a deflection
};
GLIM_CONST uint kMaxMedia = 127u;
GLIM_CONST uint kMediumBits = 7u;      // of its number
GLIM_CONST uint kMaxNestedMedia = 4u;  // that a ray remembers (lib/media.glsl)

// How a material's property uses an image.
struct TextureData {
    uint firstTexel;  // of its image, rows from the top; RGBA, a byte each, or two texels RG and BA, two bytes each
    uint size;        // width | height << 16
    uint flags;       // kRepeatS ...
    uint unused;
    // Texture coordinates to those of the image: (dot(rowU.xy, uv) + rowU.z, dot(rowV.xy, uv) + rowV.z). Only with kTransformed.
    vec3 rowU;
    uint unusedU;
    vec3 rowV;
    uint unusedV;
};

GLIM_CONST uint kWrapS = 0u;  // the place of two bits: kClamp, kMirrored or kRepeat
GLIM_CONST uint kWrapT = 2u;
GLIM_CONST uint kClamp = 0u;
GLIM_CONST uint kMirrored = 1u;
GLIM_CONST uint kRepeat = 2u;
GLIM_CONST uint kNearest = 0x10u;   // else bilinear
GLIM_CONST uint kSrgb = 0x20u;      // RGB, not alpha
GLIM_CONST uint kWide = 0x40u;      // 16 bits per channel
GLIM_CONST uint kSecondUv = 0x80u;  // texture coordinates of set 1
GLIM_CONST uint kTransformed = 0x100u;

// Texels of images: as many buffers of 2^kTexelViewBits texels of four bytes as the scene needs. That is 2^kMaxTexelViewBits, or what the
// device can address if that is less.
GLIM_CONST uint kMaxTexelViewBits = 27u;
GLIM_CONST uint kMaxTexelViews = 8u;

// The table of albedos (access/albedo_table.glsl): texel (i, j) is (a, b at column i, a, b at column i + 1) of row j, for the fourth roots
// i / (kAlbedoSize - 1) of the cosine and j / (kAlbedoSize - 1) of alpha. One more row holds their averages over the hemisphere, by alpha.
// Scenes with sheen have another table behind it: texel (i, j) is the sheen's albedo at (i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1).
GLIM_CONST uint kAlbedoSize = 64u;

// Scenes with anisotropy have a third table at kFirstAnisotropicAlbedo. A direction of the cosine z sees along its azimuth a lobe of the
// width `along`, with alpha.x >= along >= alpha.y, and after the stretch by alpha that makes the distribution of microfacets uniform it has
// the length `stretched`. Functions of (z / stretched, alpha.y / along, along / alpha.x, alpha.x) are smooth, also where widths vanish. At
// equal steps of (z / stretched)^(3/4), both ratios and alpha.x^(3/4), the first of these the fastest, texel i is (E, c at i, E, c at
// i + 1): E is the albedo for a reflectance of 1, and c the cosine over `stretched` at which Schlick's weight is its mean over the
// reflected light. Behind it are averages over the hemisphere at equal steps of alpha.x^(1/2) and, faster, of alpha.y / alpha.x: (l, b at
// i, l, b at i + 1), where 1 - a - b is l alpha.x.
GLIM_CONST uint kFirstAnisotropicAlbedo = kAlbedoSize * (2u * kAlbedoSize + 1u);
GLIM_CONST uint kAnisotropicCosines = 32u;
GLIM_CONST uint kAnisotropicRatios = 6u;
GLIM_CONST uint kAnisotropicAlphas = 12u;
GLIM_CONST uint kAnisotropicAverageRatios = 12u;
GLIM_CONST uint kAnisotropicAverageAlphas = 48u;
GLIM_CONST uint kAnisotropicAlbedos = kAnisotropicCosines * kAnisotropicRatios * kAnisotropicRatios * kAnisotropicAlphas;

// Scenes with rough transmission have a fourth table at kFirstGlassAlbedo, of interfaces that reflect and refract. At equal steps of the
// fourth root of the cosine, the fastest, of the square root of alpha, and of |r|^(1/4), r = (eta - 1) / (eta + 1), from kMinGlassRoot to
// kMaxGlassRoot, it holds (t, p, q): the albedo of single scattering is t + F0 p + F90 q for the reflectance F0 + (F90 - F0) w, where w is
// the exact Fresnel reflectance less its value along the normal, scaled to [0, 1]. First eta above 1, then below, where they change more.
// Behind it are their averages over the hemisphere, by alpha and index, and fourth the share of lost light for glassReflects.
GLIM_CONST uint kFirstGlassAlbedo = kFirstAnisotropicAlbedo + kAnisotropicAlbedos + kAnisotropicAverageRatios * kAnisotropicAverageAlphas;
GLIM_CONST uint kGlassCosines = 32u;
GLIM_CONST uint kGlassAlphas = 24u;
GLIM_CONST uint kGlassDenser = 10u;  // indices above 1
GLIM_CONST uint kGlassThinner = 24u;
GLIM_CONST float kMinGlassRoot = 0.22F;  // eta 1.0047
GLIM_CONST float kMaxGlassRoot = 0.9F;   // eta 4.82
GLIM_CONST uint kGlassAlbedos = kGlassCosines * kGlassAlphas * (kGlassDenser + kGlassThinner);

GLIM_CONST uint kTriangleLight = 0u;
GLIM_CONST uint kRectangleLight = 1u;  // two triangles
GLIM_CONST uint kSphereLight = 2u;
GLIM_CONST uint kPointLight = 3u;
GLIM_CONST uint kSpotLight = 4u;
GLIM_CONST uint kDirectionalLight = 5u;
GLIM_CONST uint kEnvironmentLight = 6u;
GLIM_CONST uint kLightKindMask = 0xffu;
GLIM_CONST uint kDoubleSidedLight = 0x100u;
GLIM_CONST uint kUnevenLight = 0x200u;  // its emission changes over the surface

// Each primitive that emits is a light of its own; two triangles that make a rectangle are one. Finite lights come first, in the order of
// the light tree's leaves; infinite ones, the directional lights and the environment, last.
struct FlatLight {
    uint kind;            // kTriangleLight ..., | kDoubleSidedLight | kUnevenLight, and its light group
    uint primitiveRef;    // triangle, sphere: one of its references
    uint primitive;       // triangle, sphere; rectangle: of the half at `position`
    uint otherPrimitive;  // rectangle: of the other half
    vec3 intensity;       // surfaces, constant environment: radiance; point, spot: W/sr; directional: W/m^2
    float probability;    // infinite lights: of choosing this one among them
    vec3 position;        // triangle: vertex 0; rectangle: a corner; sphere: centre; point, spot
    float size;           // triangle, rectangle: area; sphere: radius; point, spot: their range, or 0
    vec3 edge1;           // triangle: to vertex 1; rectangle: a side; spot, directional: unit direction, the way light travels
    float versineInner;   // spot: 1 - cos of the angle up to which it has all its intensity; rectangle: 1 / |edge1|
    vec3 edge2;           // triangle: to vertex 2; rectangle: the other side
    float versineOuter;   // spot: of the angle from which on it has none; rectangle: 1 / |edge2|
};

// A node of the light tree: bounds of the lights below it (lib/light_importance.glsl). Node 0 is the root. The children of a node follow
// one another, in the order of their lights.
//
// From where a node with kClusterNode is small, the way down ends there, and a light is chosen by its power towards the point
// (access/light_cluster.glsl). These powers lie behind the lights: two texels for each finite light, and two more. The first has sums over
// all lights before this one, of power times the positive part of the normal's x, y and z; the second, of -x, -y and -z. They are whole
// numbers, modulo 2^32, in units of which a cluster has less than 2^24 on each side.
struct LightNode {
    vec3 center;  // of a sphere around the lights
    float radius;
    vec3 axis;          // unit, of the cone of their normals or directions
    float power;        // sum of radiance * projected area, or intensity, W/sr
    float cosNormals;   // of the cone's half angle
    float cosEmission;  // of the angle from a normal or a direction at which the last light ends
    uint children;      // the first one | their number << kLightChildBits | kTwoSidedNode | kClusterNode; a leaf has none
    uint firstLight;    // below it; of a leaf: its light
};
GLIM_CONST uint kLightChildBits = 26u;
GLIM_CONST uint kMaxLightChildren = 8u;
GLIM_CONST uint kTwoSidedNode = 0x80000000u;  // each of its lights emits from both sides
GLIM_CONST uint kClusterNode = 0x40000000u;
GLIM_CONST float kUniformShare = 0.1f;  // of the choices between finite lights that ignore importance

// Where light paths are aimed (kFeatureCaustics): kMaxCausticTargets texels, a bounding sphere each (centre, radius); another one around
// the whole scene; then for each light the random words that choose it (first, last, where to search: first entry, last entry); then,
// with kFeatureBrightEnvironment, for each bright cell of the environment map the random words that choose it, its index, and the density
// of its directions per steradian. Without that feature the environment is not among the lights.
GLIM_CONST uint kMaxCausticTargets = 8u;
GLIM_CONST uint kSceneSphere = kMaxCausticTargets;
GLIM_CONST uint kFirstCausticLight = kMaxCausticTargets + 1u;

GLIM_CONST uint kPerspective = 0u;
GLIM_CONST uint kOrthographic = 1u;

GLIM_CONST uint kMediaVary = 0x10000000u;  // above the numbers of the media
// Along this ray the solids around a point are told from others, and which is the innermost. No axis, no diagonal; about a unit vector.
GLIM_CONST vec3 kOutwards = vec3(0.36f, 0.48f, 0.8f);

// How points of the film become points of the image plane (lib/projection.glsl).
GLIM_CONST uint kCentredFilm = 0u;       // they are the same
GLIM_CONST uint kShiftedFilm = 1u;       // the camera's axis does not meet the film's middle
GLIM_CONST uint kRadialTangential = 2u;  // and the lens distorts
GLIM_CONST uint kFisheye = 3u;
GLIM_CONST uint kEquirectangular = 4u;  // all directions

// OpenCV's models, with y up: its p1 has the other sign.
struct FlatProjection {
    uint model;
    vec2 shift;       // from film coordinates to those of the image plane, in which the axis is at 0
    vec2 scale;       // of the image plane: tangents, or radians of a fisheye, per unit
    vec4 radial;      // k1 to k4
    vec2 radial2;     // k5, k6
    vec2 tangential;  // -p1, p2
    float end;        // tangent or angle up to which distortion is monotonic; what is farther from the axis is not seen
};

// For coordinates (x, y) of the image plane, which are those of the film in [-1, 1] unless the projection says otherwise, y up: perspective
// rays leave `position` along forward + x right + y up; orthographic rays leave position + x right + y up along forward. A thin lens moves
// the origin by a point of the disk with radii lensRight and lensUp, and turns the ray so that it meets the pinhole's ray at the depth
// 1 / inverseFocus. A fisheye and an equirectangular camera have unit vectors `right` and `up`, and no lens.
struct FlatCamera {
    vec3 position;
    vec3 right;
    vec3 up;
    vec3 forward;  // unit
    uint kind;
    vec3 lensRight;  // 0: a pinhole
    vec3 lensUp;
    float inverseFocus;
    uint media;  // in which its rays begin, as in PathRay; kMediaVary: those of one begin elsewhere than those of another
    FlatProjection projection;
    uint motion;  // texel of its motion plus 1, or 0; its place above is then that of the frame's time
};

GLIM_SHARED_END
#endif
