// What probe_infinities is given and finds out.
#ifndef GLIM_ACCESS_INFINITIES
#define GLIM_ACCESS_INFINITIES

#include "shared/bindings.h"

layout(local_size_x = 1) in;

// 0, 1, the largest number, infinity and NaN; then the answers, one bit each.
layout(set = 0, binding = kBindProbed, scalar) buffer InfinitiesBuffer
{
    float zero, one, largest, infinity, nan;
    uint answers;
};

#endif
