// What a scene needs of the kernels, one bit each: code for the rest is compiled out. host/flatten sets the bits. One specialization
// constant passes them to the kernels (access/features.glsl).
#ifndef GLIM_SHARED_FEATURES_H
#define GLIM_SHARED_FEATURES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

GLIM_CONST uint kFeatureSpheres = 0x1u;
GLIM_CONST uint kFeatureSlivers = 0x2u;  // triangles thinner than kSliverHeight
GLIM_CONST uint kFeatureSmooth = 0x4u;   // triangles with vertex normals
GLIM_CONST uint kFeatureMirror = 0x8u;
GLIM_CONST uint kFeatureDielectric = 0x10u;
GLIM_CONST uint kFeatureTriangleLights = 0x20u;
GLIM_CONST uint kFeatureSphereLights = 0x40u;
GLIM_CONST uint kFeaturePunctualLights = 0x80u;
GLIM_CONST uint kFeatureEnvironment = 0x100u;
GLIM_CONST uint kFeaturePrincipled = 0x200u;  // the glTF material: GGX over a diffuse base
GLIM_CONST uint kFeatureTextures = 0x400u;
GLIM_CONST uint kFeatureNormalMaps = 0x800u;
GLIM_CONST uint kFeatureVertexColors = 0x1000u;
GLIM_CONST uint kFeatureAlpha = 0x2000u;           // primitives that are transparent in places
GLIM_CONST uint kFeatureEnvironmentMap = 0x4000u;  // with kFeatureEnvironment
GLIM_CONST uint kFeatureTextureTransforms = 0x8000u;
GLIM_CONST uint kFeatureWideTextures = 0x10000u;  // of 16 bits per channel
GLIM_CONST uint kFeatureClearcoat = 0x20000u;
GLIM_CONST uint kFeatureSheen = 0x40000u;
GLIM_CONST uint kFeatureAnisotropy = 0x80000u;
GLIM_CONST uint kFeatureIridescence = 0x100000u;
GLIM_CONST uint kFeatureTransmission = 0x200000u;  // by the GGX lobe, of solids and thin walls
GLIM_CONST uint kFeatureDiffuseTransmission = 0x400000u;
GLIM_CONST uint kFeatureMedia = 0x800000u;  // absorption, or solids within each other
GLIM_CONST uint kFeatureDispersion = 0x1000000u;
GLIM_CONST uint kFeatureThinWalls = 0x2000000u;  // smooth ones, which light passes straight; with kFeatureAlpha
GLIM_CONST uint kFeatureUnlit = 0x4000000u;      // with kFeatureAlpha
GLIM_CONST uint kFeatureGlossiness = 0x8000000u;
GLIM_CONST uint kFeatureRectangleLights = 0x10000000u;
GLIM_CONST uint kFeatureLightTree = 0x20000000u;  // several lights, one at least finite: which is chosen depends on the point
GLIM_CONST uint kFeatureCaustics = 0x40000000u;   // traced from lights to specular surfaces
GLIM_CONST uint kFeatureInstances = 0x80000000u;  // that share meshes
GLIM_CONST uint kAllFeatures = 0xffffffffu;       // of any scene

GLIM_SHARED_END
#endif
