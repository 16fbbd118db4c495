// Kernels compiled while glim runs, by the steps of the build (tools/compile_shader.cmake).
#pragma once

#include "host/gpu/embedded_shader.hpp"

#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace glim {

// Throws UsageError unless kernels can be compiled from this folder, which --shaders names.
void requireShaders(const std::filesystem::path& folder);

// The files of the folder's kernels, below it, by name.
std::map<std::string, std::filesystem::path> findKernels(const std::filesystem::path& folder);

struct CompiledShader {
    std::shared_ptr<const std::vector<std::uint32_t>> words;  // null: it does not compile, or does not fit glim
    std::string trouble;                                      // why, as in "shaders/lib/warp.glsl:13: error: 'p' : undeclared identifier"
    std::set<std::filesystem::path> files;                    // below the folder, that it is made of; empty if unknown
};

// The folder's kernel of the same name, which must have an interface that glim's host serves.
CompiledShader compileShader(const std::filesystem::path& folder, const EmbeddedShader& own);

}  // namespace glim
