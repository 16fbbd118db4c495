// The parameters of the course's estimators (shaders/kernels/course). The course is Berkeley's CS 184 with its path tracer.
#ifndef GLIM_SHARED_COURSE_TYPES_H
#define GLIM_SHARED_COURSE_TYPES_H
#include "path_types.h"

GLIM_SHARED_BEGIN

// How direct light is estimated. All have the same expectation.
GLIM_CONST uint kDirectMis = 0u;         // as the production kernels do
GLIM_CONST uint kDirectLights = 1u;      // every light, some samples each
GLIM_CONST uint kDirectHemisphere = 2u;  // directions uniform over the hemisphere; delta lights as in kDirectLights
GLIM_CONST uint kDirectBsdf = 3u;        // the sampled BSDF alone; delta lights as in kDirectLights

GLIM_CONST uint kRouletteThroughput = 0u;  // as the production kernels do
GLIM_CONST uint kRouletteFixed = 1u;
GLIM_CONST uint kRouletteNone = 2u;

// CourseRound::light: one, chosen by power.
GLIM_CONST uint kAnyLight = 0xfffffffeu;

// Direct light is estimated in rounds of one ray per path: sample `lightSample` of `lightSamples` of one light or of the hemisphere. Brute
// force runs in several dispatches, each over references [firstRef, endRef).
struct CourseRound {
    uint light;  // an index, kAnyLight or kNoLightIndex
    uint lightSample;
    uint lightSamples;
    uint addsEmission;  // 1: the round adds the emission that the ray itself has hit (the first round)
    uint firstRef;
    uint endRef;
};

// Push constants of the course's kernels.
struct CoursePass {
    Pass pass;
    CourseRound lightRound;
};

// What stays the same during a render.
struct CourseParameters {
    uint refCount;
    float continuation;    // of kRouletteFixed: the probability to continue
    float tolerance;       // of course_choose_pixels: half the 95 % interval over the mean
    uint constantSamples;  // a pixel whose samples are all equal needs this many
};

GLIM_SHARED_END
#endif
