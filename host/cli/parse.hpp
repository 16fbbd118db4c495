// Option values that are more than one number. Each throws CLI::ValidationError (exit code 2) naming what was expected.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <utility>

namespace glim {

// The largest sample index + 1: the sampler keeps one bit of the block number for itself.
inline constexpr std::uint32_t kMaxSample = 1U << 31;

glm::uvec2 parseSize(const std::string& text);                                 // "640x480"
std::pair<std::uint32_t, std::uint32_t> parseRange(const std::string& text);   // "0:256", begin < end
glm::vec3 parseRadiance(const std::string& text);                              // "1,1,1", >= 0; a file is refused

}  // namespace glim
