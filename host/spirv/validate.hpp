#pragma once

#include <cstdint>
#include <span>

namespace glim::spirv {

// Throws std::runtime_error unless Vulkan takes the words, as spirv-val says with the options of the build (tools/compile_shader.cmake).
void requireValid(std::span<const std::uint32_t> words);

}  // namespace glim::spirv
