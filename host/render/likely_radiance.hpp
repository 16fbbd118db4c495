// What relative errors are relative to, where nothing better is known than the picture itself.
#pragma once

#include "host/render/film.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace glim {

// For each pixel and channel its radiance or, where that is above the mean of the eight around it by less than two of its own standard
// errors, that mean. A pixel that has met a rare bright sample has a large variance and a large radiance for the same reason: their
// ratio is near 1 whatever the error, and of a mirror's caustics at 64 samples a pixel it told a sixth (tests/README.md). Edges are
// sharper than their noise, and keep what they have. `variance` is that of the radiance, or empty; what is not finite is left out.
std::vector<glm::dvec3> findLikelyRadiance(std::uint32_t width, std::uint32_t height, const std::vector<glm::vec3>& radiance,
                                           const std::vector<glm::vec3>& variance);
std::vector<glm::dvec3> findLikelyRadiance(const Film& film);

}  // namespace glim
