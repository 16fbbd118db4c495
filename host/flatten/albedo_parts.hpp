// The building blocks of the albedo tables.
#pragma once

#include "shaders/shared/vocabulary.h"

#include <vector>

namespace glim {

// Quadrature by the rule of Gauss and Legendre: nodes and weights on [-1, 1].
struct GaussRule {
    explicit GaussRule(std::size_t count);

    std::vector<double> nodes, weights;
};

// To 2^-22, so that all machines make the same table whatever their sine is.
double rounded(double value);

// Of 1 - cosine: Schlick's weight.
double fifthPower(double x);

// A texel of four floats for each value: itself, and the next one of the row.
void pushTexels(std::vector<uvec4>& table, const std::vector<glm::dvec2>& row);
uvec4 texelOf(const glm::dvec2& a, const glm::dvec2& b);

}  // namespace glim
