// Spells GLSL's types in C++, so that one text declares a struct for both. Scalar block layout on the device: members
// follow each other with the alignment of their scalars, as in C++.
#ifndef GLIM_SHARED_VOCABULARY_H
#define GLIM_SHARED_VOCABULARY_H

#ifdef __cplusplus
#include <glm/glm.hpp>

#include <cstdint>
#define GLIM_SHARED_BEGIN namespace glim {
#define GLIM_SHARED_END }
#define GLIM_CONST inline constexpr
#define GLIM_FUNCTION inline
namespace glim {
using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
using Real = double;  // the host shows pictures in double precision, kernels in single
using RealVec2 = glm::dvec2;
using RealVec3 = glm::dvec3;
using glm::abs;  // of numbers; C++ finds those of vectors by their arguments
using glm::clamp;
using glm::max;
using glm::min;
using glm::mix;
using glm::sqrt;
}  // namespace glim
#else
#extension GL_EXT_scalar_block_layout : require
#define GLIM_SHARED_BEGIN
#define GLIM_SHARED_END
#define GLIM_CONST const
#define GLIM_FUNCTION
#define Real float
#define RealVec2 vec2
#define RealVec3 vec3
#endif

#endif
