// Kernels in place of those that are part of the program, for who works on shaders (host/preview/shader_loader.hpp). They hold for the
// whole process, and are kept in no cache on disk: an editor would fill it.
#pragma once

#include "host/gpu/embedded_shader.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace glim {

// SPIR-V by the name of the kernel that it replaces.
using ReplacedKernels = std::map<std::string, std::shared_ptr<const std::vector<std::uint32_t>>>;

// For kernels that are made from now on. None may be under way.
void replaceKernels(ReplacedKernels by);
ReplacedKernels replacedKernels();
// Of what replaceKernels() was given: unique, but 0 while nothing is replaced.
std::uint32_t replacedVersion();

// Null if the kernel is not replaced. Notes that it is used.
std::shared_ptr<const std::vector<std::uint32_t>> findReplaced(const EmbeddedShader& own);
// The program's own kernels that were looked for so far.
std::vector<EmbeddedShader> kernelsInUse();

}  // namespace glim
