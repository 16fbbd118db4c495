// What the scene needs, as specialization constants: what it does not contain is compiled away.
#ifndef GLIM_ACCESS_FEATURES
#define GLIM_ACCESS_FEATURES

#include "shared/bindings.h"

layout(constant_id = kSpecSpheres) const bool kSpheres = true;
layout(constant_id = kSpecSmooth) const bool kSmooth = true;
layout(constant_id = kSpecSpecular) const bool kSpecular = true;
layout(constant_id = kSpecSurfaceLights) const bool kSurfaceLights = true;
layout(constant_id = kSpecPunctualLights) const bool kPunctualLights = true;
layout(constant_id = kSpecEnvironment) const bool kEnvironment = true;
layout(constant_id = kSpecSobol) const bool kSobol = true;
layout(constant_id = kSpecMollerTrumbore) const bool kMollerTrumbore = false;

#endif
