// What the scene needs and what the render is asked for, as specialization constants: the rest is compiled away.
#ifndef GLIM_ACCESS_FEATURES
#define GLIM_ACCESS_FEATURES

#include "shared/bindings.h"
#include "shared/limits.h"

layout(constant_id = kSpecSpheres) const bool kSpheres = true;
layout(constant_id = kSpecSlivers) const bool kSlivers = true;
layout(constant_id = kSpecSmooth) const bool kSmooth = true;
layout(constant_id = kSpecMirrors) const bool kMirrors = true;
layout(constant_id = kSpecGlasses) const bool kGlasses = true;
layout(constant_id = kSpecTriangleLights) const bool kTriangleLights = true;
layout(constant_id = kSpecSphereLights) const bool kSphereLights = true;
layout(constant_id = kSpecPunctualLights) const bool kPunctualLights = true;
layout(constant_id = kSpecEnvironment) const bool kEnvironment = true;
layout(constant_id = kSpecStackLevels) const uint kStackLevels = kMaxStackLevels;
layout(constant_id = kSpecSobol) const bool kSobol = true;
layout(constant_id = kSpecMollerTrumbore) const bool kMollerTrumbore = false;
layout(constant_id = kSpecBruteForce) const bool kBruteForce = false;
layout(constant_id = kSpecDirect) const uint kDirect = kDirectMis;
layout(constant_id = kSpecRoulette) const uint kRoulette = kRouletteThroughput;
layout(constant_id = kSpecLens) const bool kLens = false;
layout(constant_id = kSpecChosen) const bool kChosen = false;
layout(constant_id = kSpecView) const uint kView = kViewNormal;
layout(constant_id = kSpecLook) const uint kLook = 0u;
layout(constant_id = kSpecFolded) const bool kFolded = true;
layout(constant_id = kSpecSuspects) const bool kSuspects = false;
layout(constant_id = kSpecNotes) const bool kNotes = false;
layout(constant_id = kSpecLuminance) const bool kLuminance = false;

#endif
