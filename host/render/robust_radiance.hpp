// The radiance to which relative errors are relative if there is no reference picture.
#pragma once

#include "host/render/film.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace glim {

// Returns for each pixel and channel its radiance or, if that exceeds the mean of its eight neighbours by less than two of its own
// standard errors, that mean. A rare bright sample raises a pixel's variance and its radiance together, so that their ratio is near 1
// whatever the error: it showed a sixth of the error of a mirror's caustics at 64 samples a pixel (tests/MEASUREMENTS.md). Edges differ
// by more than their noise and keep their radiance. `variance` is that of the radiance, or empty; values that are not finite are left
// out.
std::vector<glm::dvec3> robustRadiance(std::uint32_t width, std::uint32_t height, const std::vector<glm::vec3>& radiance,
                                       const std::vector<glm::vec3>& variance);
std::vector<glm::dvec3> robustRadiance(const Film& film);

}  // namespace glim
