// What a scene needs of the kernels, one bit each: code for the rest is compiled out. host/flatten sets the bits. Two specialization
// constants pass them to the kernels (access/features.glsl), since a constant has 32 bits.
#ifndef GLIM_SHARED_FEATURES_H
#define GLIM_SHARED_FEATURES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// clang-format off
// FEATURE(name, bit, what `inspect` calls it): kFeatureSpheres ...
#define GLIM_FEATURES(FEATURE) \
    FEATURE(Spheres, 0, "spheres") \
    FEATURE(Slivers, 1, "slivers") /* triangles thinner than kSliverHeight */ \
    FEATURE(Smooth, 2, "smooth normals") /* triangles with vertex normals */ \
    FEATURE(Mirror, 3, "mirrors") \
    FEATURE(Dielectric, 4, "glass") \
    FEATURE(TriangleLights, 5, "triangle lights") \
    FEATURE(SphereLights, 6, "sphere lights") \
    FEATURE(PunctualLights, 7, "punctual lights") \
    FEATURE(Environment, 8, "environment") \
    FEATURE(Principled, 9, "glTF materials") /* the glTF material: GGX over a diffuse base */ \
    FEATURE(Textures, 10, "textures") \
    FEATURE(NormalMaps, 11, "normal maps") \
    FEATURE(VertexColors, 12, "vertex colours") \
    FEATURE(Alpha, 13, "alpha") /* primitives that are transparent in places */ \
    FEATURE(EnvironmentMap, 14, "environment map") /* with Environment */ \
    FEATURE(TextureTransforms, 15, "texture transforms") \
    FEATURE(WideTextures, 16, "16-bit textures") \
    FEATURE(Clearcoat, 17, "clearcoat") \
    FEATURE(Sheen, 18, "sheen") \
    FEATURE(Anisotropy, 19, "anisotropy") \
    FEATURE(Iridescence, 20, "iridescence") \
    FEATURE(Transmission, 21, "transmission") /* by the GGX lobe, of solids and thin walls */ \
    FEATURE(DiffuseTransmission, 22, "diffuse transmission") \
    FEATURE(Media, 23, "volumes") /* attenuation, or solids within each other */ \
    FEATURE(Dispersion, 24, "dispersion") \
    FEATURE(ThinWalls, 25, "thin walls") /* smooth ones, which light passes straight; with Alpha */ \
    FEATURE(Unlit, 26, "unlit materials") /* with Alpha */ \
    FEATURE(Glossiness, 27, "specular-glossiness") \
    FEATURE(RectangleLights, 28, "rectangle lights") \
    FEATURE(LightTree, 29, "several lights") /* one at least finite: which is chosen depends on the point */ \
    FEATURE(Caustics, 30, "caustics") /* traced from lights to specular surfaces */ \
    FEATURE(Instances, 31, "instances") /* that share meshes */ \
    FEATURE(LightsInMedia, 32, "lights in volumes") /* with Media */ \
    FEATURE(SingleSided, 33, "single-sided surfaces") /* not there for rays from behind */ \
    FEATURE(LargeTriangles, 34, "large triangles") /* beside small or close things */ \
    FEATURE(PointColors, 35, "coloured points") /* spheres and lines with colours of their own */ \
    FEATURE(Lines, 36, "lines") /* with Spheres */ \
    FEATURE(Scattering, 37, "scattering volumes") /* with Media */ \
    FEATURE(Catcher, 38, "shadow catchers") \
    FEATURE(Motion, 39, "moving nodes") /* while the shutter is open; with Instances */ \
    FEATURE(LightGroups, 40, "light groups") \
    FEATURE(LightClusters, 41, "clusters of lights") /* lamps of many triangles; with LightTree */ \
    FEATURE(RoughTransmission, 42, "rough transmission") /* with Transmission */ \
    FEATURE(BrightEnvironment, 43, "caustics of the environment") /* of its map's bright part; with Caustics and EnvironmentMap */
// clang-format on

#ifdef __cplusplus
using FeatureMask = std::uint64_t;
#define GLIM_FEATURE(name, bit, text) inline constexpr FeatureMask kFeature##name = FeatureMask{1} << bit;
#else
#define FeatureMask uvec2  // the lower and the upper half
#define GLIM_FEATURE(name, bit, text) \
    const FeatureMask kFeature##name = bit < 32 ? FeatureMask(1u << (bit & 31), 0u) : FeatureMask(0u, 1u << (bit & 31));
#endif
GLIM_FEATURES(GLIM_FEATURE)
#undef GLIM_FEATURE

// Layers of kPrincipled.
GLIM_CONST FeatureMask kLayerFeatures =
    kFeatureClearcoat | kFeatureSheen | kFeatureAnisotropy | kFeatureIridescence | kFeatureTransmission | kFeatureDiffuseTransmission;
// Surfaces that emit.
GLIM_CONST FeatureMask kEmissiveSurfaces =
    kFeatureTriangleLights | kFeatureRectangleLights | kFeatureSphereLights | kFeatureUnlit | kFeatureLines;

#ifdef __cplusplus
inline constexpr FeatureMask kAllFeatures = ~FeatureMask{0};  // of any scene

struct Feature {
    FeatureMask bit;
    const char* name;
};
inline constexpr Feature kFeatures[] = {
#define GLIM_FEATURE(name, bit, text) {kFeature##name, text},
    GLIM_FEATURES(GLIM_FEATURE)
#undef GLIM_FEATURE
};
#endif

GLIM_SHARED_END
#endif
