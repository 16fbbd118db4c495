// What the scene needs and what the render is asked for, as specialization constants: the rest is compiled away.
#ifndef GLIM_ACCESS_FEATURES
#define GLIM_ACCESS_FEATURES

#include "shared/bindings.h"
#include "shared/features.h"
#include "shared/limits.h"
#include "shared/scene_types.h"

layout(constant_id = kSpecFeatures) const uint kLowerFeatures = 0xffffffffu;
layout(constant_id = kSpecUpperFeatures) const uint kUpperFeatures = 0xffffffffu;

// Whether the scene needs the feature of shared/features.h, or one of several. This and what is built on it are macros, so that the host
// finds the constant where it decides a branch (host/gpu/specialize.hpp).
#define hasFeature(feature) ((kLowerFeatures & (feature).x | kUpperFeatures & (feature).y) != 0u)

// Whether materials have a LayersData.
#define hasLayers() hasFeature(kLayerFeatures | kFeatureMedia)

// Light that a ray may hit by chance.
#define hasEnvironment() hasFeature(kFeatureEnvironment)
#define hasEmissiveSurfaces() hasFeature(kEmissiveSurfaces)

const FeatureMask kFiniteLights = kFeatureTriangleLights | kFeatureRectangleLights | kFeatureSphereLights | kFeaturePunctualLights;
const FeatureMask kInfiniteLights = kFeatureEnvironment | kFeaturePunctualLights;

layout(constant_id = kSpecStackLevels) const uint kStackLevels = kMaxStackLevels;
layout(constant_id = kSpecTexelViews) const uint kTexelViews = kMaxTexelViews;
layout(constant_id = kSpecTexelViewBits) const uint kTexelViewBits = kMaxTexelViewBits;
layout(constant_id = kSpecPathsPerThread) const uint kPathsPerThread = 16u;
layout(constant_id = kSpecSharedStack) const bool kSharedStack = false;
layout(constant_id = kSpecSobol) const bool kSobol = true;
layout(constant_id = kSpecLens) const bool kLens = false;
layout(constant_id = kSpecMovingCamera) const bool kMovingCamera = false;
layout(constant_id = kSpecProjection) const uint kProjection = kCentredFilm;
layout(constant_id = kSpecChosen) const bool kChosen = false;
layout(constant_id = kSpecAov) const uint kAov = kAovRadiance;
layout(constant_id = kSpecFolded) const bool kFolded = true;
layout(constant_id = kSpecSuspects) const bool kSuspects = false;
layout(constant_id = kSpecNotes) const bool kNotes = false;
layout(constant_id = kSpecGuided) const bool kGuided = false;
layout(constant_id = kSpecLearns) const bool kLearns = false;
layout(constant_id = kSpecGuidedScatterings) const bool kGuidedScatterings = false;

#endif
