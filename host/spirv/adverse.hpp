// Arithmetic as bad as Vulkan allows, to test that no result leans on more.
#pragma once

#include "host/spirv/module.hpp"

namespace glim::spirv {

// Flushes denormals, moves the results of native divisions, roots and transcendental functions by errors that Vulkan allows, lets minima
// and maxima of NaN and of two zeros be either operand, and conversions to integers out of their range anything. Each place of the module
// has errors of its own, functions of the result's bits and `seed`; seed 0 moves all results away from zero as far as is allowed. `library`
// has the functions of shaders/lib/adverse.glsl.
void makeAdverse(Module& module, const Module& library, std::uint32_t seed);

}  // namespace glim::spirv
