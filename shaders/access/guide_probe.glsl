// What probe_guide is asked and answers. The push constants are not those of a pass that traces.
#ifndef GLIM_ACCESS_GUIDE_PROBE
#define GLIM_ACCESS_GUIDE_PROBE

#include "features.glsl"
#include "shared/guide_probe_types.h"

layout(push_constant, scalar) uniform GuideProbeBlock { GuideProbePass pass; };
layout(local_size_x_id = kSpecWorkgroup) in;

layout(set = 0, binding = kBindProbed, scalar) buffer ProbedBuffer { ProbedDirection probed[]; };

#endif
