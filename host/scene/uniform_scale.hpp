// The factor by which a matrix scales the radius of a sphere, if the matrix keeps spheres spherical.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace glim {

// The factor by which the matrix lengthens every vector, or 0 if it lengthens some more than others. The relative tolerance for its
// columns' equal lengths and right angles is 1e-5: matrices are often printed floats.
inline double computeUniformScale(const glm::dmat3& linear)
{
    constexpr double kTolerance = 1e-5;
    const double scale = std::cbrt(std::abs(glm::determinant(linear)));
    const glm::dmat3 gram = glm::transpose(linear) * linear;
    for (int c = 0; c < 9; ++c) {
        const double expected = c / 3 == c % 3 ? scale * scale : 0.0;
        if (!(std::abs(gram[c / 3][c % 3] - expected) <= kTolerance * scale * scale)) {
            return 0.0;
        }
    }
    return scale;
}

}  // namespace glim
