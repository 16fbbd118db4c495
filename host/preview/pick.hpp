// What is printed of a pixel that is clicked.
#pragma once

#include "host/preview/refiner.hpp"
#include "host/render/aov.hpp"

#include <string>

namespace glim {

// The surface behind the centre of a pixel of a window of this size, and its place: "nothing" if there is none.
std::string describeSurface(Refiner& refiner, const PreparedScene& prepared, const glm::uvec2& pixel, const glm::uvec2& size);
// For example "; 64 samples, mean (1, 1, 1) W/(sr m^2), standard error (.1, .1, .1)".
std::string describeSamples(Refiner& refiner, const glm::uvec2& pixel, Aov aov);

}  // namespace glim
