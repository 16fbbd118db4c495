// What the scene needs and what the render is asked for, as specialization constants: the rest is compiled away.
#ifndef GLIM_ACCESS_FEATURES
#define GLIM_ACCESS_FEATURES

#include "shared/bindings.h"
#include "shared/features.h"
#include "shared/limits.h"

layout(constant_id = kSpecFeatures) const uint kFeatures = kAllFeatures;
const bool kSpheres = (kFeatures & kFeatureSpheres) != 0u;
const bool kSlivers = (kFeatures & kFeatureSlivers) != 0u;
const bool kSmooth = (kFeatures & kFeatureSmooth) != 0u;
const bool kMirrors = (kFeatures & kFeatureMirror) != 0u;
const bool kDielectrics = (kFeatures & kFeatureGlass) != 0u;
const bool kTriangleLights = (kFeatures & kFeatureTriangleLights) != 0u;
const bool kSphereLights = (kFeatures & kFeatureSphereLights) != 0u;
const bool kPunctualLights = (kFeatures & kFeaturePunctualLights) != 0u;
const bool kEnvironment = (kFeatures & kFeatureEnvironment) != 0u;

layout(constant_id = kSpecStackLevels) const uint kStackLevels = kMaxStackLevels;
layout(constant_id = kSpecSobol) const bool kSobol = true;
layout(constant_id = kSpecLens) const bool kLens = false;
layout(constant_id = kSpecChosen) const bool kChosen = false;
layout(constant_id = kSpecAov) const uint kAov = kAovRadiance;
layout(constant_id = kSpecFolded) const bool kFolded = true;
layout(constant_id = kSpecSuspects) const bool kSuspects = false;
layout(constant_id = kSpecNotes) const bool kNotes = false;

#endif
