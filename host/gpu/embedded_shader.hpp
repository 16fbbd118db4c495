// SPIR-V that is part of the executable (tools/compile_shader.cmake).
#pragma once

#include <cstdint>
#include <span>

namespace glim {

struct EmbeddedShader {
    const char* name;
    const std::uint32_t* begin;
    const std::uint32_t* end;

    std::span<const std::uint32_t> words() const { return {begin, end}; }
};

}  // namespace glim
