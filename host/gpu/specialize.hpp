// Kernels with their specialization constants set.
#pragma once

#include "host/gpu/arithmetic.hpp"
#include "host/gpu/embedded_shader.hpp"

#include <map>
#include <vector>

namespace glim {

// The values of specialization constants by constant_id. Booleans are 0 or 1.
using Specialization = std::map<std::uint32_t, std::uint32_t>;

// The shader's SPIR-V with these constants set, the others at their defaults, without the code that they make unreachable, and with this
// arithmetic. Throws DeviceError.
std::vector<std::uint32_t> specialize(const EmbeddedShader& shader, const Specialization& specialization, const Arithmetic& arithmetic);

}  // namespace glim
