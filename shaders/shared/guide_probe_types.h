// What a guide is asked about one point, for windows.
#ifndef GLIM_SHARED_GUIDE_PROBE_TYPES_H
#define GLIM_SHARED_GUIDE_PROBE_TYPES_H
#include "vocabulary.h"

GLIM_SHARED_BEGIN

// Push constants.
struct GuideProbePass {
    vec3 point, normal;  // the shading normal
    uint directions;     // how many there are
};

struct ProbedDirection {
    vec3 w;       // asked, unit;
    float pdf;    // the answer, per steradian,
    float share;  // and of directions that are sampled by the guide; 0: it knows nothing there
};

GLIM_SHARED_END
#endif
