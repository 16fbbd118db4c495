// Several light samples per camera sample.
#ifndef GLIM_LIB_COURSE_SPLIT_SAMPLE
#define GLIM_LIB_COURSE_SPLIT_SAMPLE

#include "lib/sampler.glsl"

// Id of the k-th of `count` samples of light `light` within one camera sample. Together they are points [index * count, index
// * count + count) of a sequence that belongs to this light.
SampleId splitSample(SampleId id, uint light, uint k, uint count)
{
    return SampleId(hash4(uvec4(id.seed, light, 0u, 0u)).x, id.pixel, id.index * count + k);
}

#endif
