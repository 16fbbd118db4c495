// Divisions and square roots that are rounded to nearest whatever the device makes of its own.
#pragma once

#include "host/spirv/module.hpp"

namespace glim::spirv {

// Replaces each division and each square root by a call of a function of shaders/lib/exact.glsl, which `library` has.
void makeExact(Module& module, const Module& library);

}  // namespace glim::spirv
