// What a render with the course's estimators is asked for, as specialization constants.
#ifndef GLIM_ACCESS_COURSE_FEATURES
#define GLIM_ACCESS_COURSE_FEATURES

#include "shared/bindings.h"
#include "shared/course_types.h"

layout(constant_id = kSpecMollerTrumbore) const bool kMollerTrumbore = false;
layout(constant_id = kSpecBruteForce) const bool kBruteForce = false;
layout(constant_id = kSpecDirect) const uint kDirect = kDirectMis;
layout(constant_id = kSpecRoulette) const uint kRoulette = kRouletteThroughput;

#endif
