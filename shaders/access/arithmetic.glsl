// What probe_arithmetic finds out.
#ifndef GLIM_ACCESS_ARITHMETIC
#define GLIM_ACCESS_ARITHMETIC

#include "shared/bindings.h"
#include "shared/limits.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = kBindProbed, scalar) writeonly buffer ProbedBuffer { float probed[]; };

#endif
