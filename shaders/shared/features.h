// What a scene needs of the kernels, one bit each: code for the rest is compiled out. host/flatten sets the bits. Two specialization
// constants pass them to the kernels (access/features.glsl), since a constant has 32 bits.
#ifndef GLIM_SHARED_FEATURES_H
#define GLIM_SHARED_FEATURES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

#ifdef __cplusplus
using FeatureMask = std::uint64_t;
#define GLIM_FEATURE(name, bit) inline constexpr FeatureMask name = FeatureMask{1} << bit
#else
#define FeatureMask uvec2  // the lower and the upper half
#define GLIM_FEATURE(name, bit) const FeatureMask name = bit < 32 ? FeatureMask(1u << (bit & 31), 0u) : FeatureMask(0u, 1u << (bit & 31))
#endif

GLIM_FEATURE(kFeatureSpheres, 0);
GLIM_FEATURE(kFeatureSlivers, 1);  // triangles thinner than kSliverHeight
GLIM_FEATURE(kFeatureSmooth, 2);   // triangles with vertex normals
GLIM_FEATURE(kFeatureMirror, 3);
GLIM_FEATURE(kFeatureDielectric, 4);
GLIM_FEATURE(kFeatureTriangleLights, 5);
GLIM_FEATURE(kFeatureSphereLights, 6);
GLIM_FEATURE(kFeaturePunctualLights, 7);
GLIM_FEATURE(kFeatureEnvironment, 8);
GLIM_FEATURE(kFeaturePrincipled, 9);  // the glTF material: GGX over a diffuse base
GLIM_FEATURE(kFeatureTextures, 10);
GLIM_FEATURE(kFeatureNormalMaps, 11);
GLIM_FEATURE(kFeatureVertexColors, 12);
GLIM_FEATURE(kFeatureAlpha, 13);           // primitives that are transparent in places
GLIM_FEATURE(kFeatureEnvironmentMap, 14);  // with kFeatureEnvironment
GLIM_FEATURE(kFeatureTextureTransforms, 15);
GLIM_FEATURE(kFeatureWideTextures, 16);  // of 16 bits per channel
GLIM_FEATURE(kFeatureClearcoat, 17);
GLIM_FEATURE(kFeatureSheen, 18);
GLIM_FEATURE(kFeatureAnisotropy, 19);
GLIM_FEATURE(kFeatureIridescence, 20);
GLIM_FEATURE(kFeatureTransmission, 21);  // by the GGX lobe, of solids and thin walls
GLIM_FEATURE(kFeatureDiffuseTransmission, 22);
GLIM_FEATURE(kFeatureMedia, 23);  // absorption, or solids within each other
GLIM_FEATURE(kFeatureDispersion, 24);
GLIM_FEATURE(kFeatureThinWalls, 25);  // smooth ones, which light passes straight; with kFeatureAlpha
GLIM_FEATURE(kFeatureUnlit, 26);      // with kFeatureAlpha
GLIM_FEATURE(kFeatureGlossiness, 27);
GLIM_FEATURE(kFeatureRectangleLights, 28);
GLIM_FEATURE(kFeatureLightTree, 29);       // several lights, one at least finite: which is chosen depends on the point
GLIM_FEATURE(kFeatureCaustics, 30);        // traced from lights to specular surfaces
GLIM_FEATURE(kFeatureInstances, 31);       // that share meshes
GLIM_FEATURE(kFeatureLampsInMedia, 32);    // with kFeatureMedia: lamps may lie in solids
GLIM_FEATURE(kFeatureSingleSided, 33);     // surfaces that are not there for rays from behind
GLIM_FEATURE(kFeatureLargeTriangles, 34);  // beside small or close things

#ifdef __cplusplus
inline constexpr FeatureMask kAllFeatures = ~FeatureMask{0};  // of any scene
#endif

GLIM_SHARED_END
#endif
