// Products, interpolations and lengths as the additions, multiplications and roots that they stand for.
#pragma once

#include "host/spirv/module.hpp"

namespace glim::spirv {

// Replaces dot, cross, mix, clamp, fract, length, distance and normalize. Vulkan gives these a precision, not a result: it leaves the order
// of a sum to the driver ("Precision of GLSL.std.450 Instructions"). A sum goes from the first component to the last. A vector divided by
// a number is multiplied by the reciprocal, since a product takes a tenth of the time of an exact quotient; it is off by 1.5 ulp at most.
void expand(Module& module);

}  // namespace glim::spirv
