// Quadrature by the rule of Gauss and Legendre.
#pragma once

#include <cstddef>
#include <vector>

namespace glim {

// Nodes and weights on [-1, 1].
struct GaussRule {
    explicit GaussRule(std::size_t count);

    std::vector<double> nodes, weights;
};

}  // namespace glim
