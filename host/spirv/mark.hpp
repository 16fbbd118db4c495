// What makes the results of float arithmetic unique but for divisions and roots. Sums and products are written out in one order
// (expand.hpp), the result of every float arithmetic instruction is decorated NoContraction, and the module declares that signed zeros,
// infinities and NaN are kept: kernels let distances be infinite and guard against NaN by comparisons.
//
// Vulkan lets a driver contract and reassociate undecorated float operations. GLSL's `precise` does the same job but does not reach into
// called functions. With every operation marked, kernels with and without a feature, in both schedules and on both versions of the software
// driver compute the same bits; measured cost there: none.
#pragma once

#include "host/spirv/module.hpp"

namespace glim::spirv {

// Throws std::runtime_error for OpExtInst Fma: `fma` may be unfused, so nothing may rest on it.
void markFloats(Module& module);

}  // namespace glim::spirv
