// Figures of a whole picture, for a render's report.
#pragma once

#include "host/render/film.hpp"

namespace glim {

// Of the samples per pixel.
struct Rates {
    double mean;
    std::uint32_t least, most;
    std::uint32_t fewestBlocks;  // that a pixel's variance comes from
};
Rates computeRates(const Film& film);

// Of --view bvh-steps, per camera ray: means over the picture, and the largest mean of a pixel.
struct Steps {
    double nodes, primitives, mostNodes;
};
Steps computeSteps(const Film& film);

// Mean radiance that --clamp-indirect took, and that is left.
struct ClampedEnergy {
    double removed, kept;
};
ClampedEnergy computeClampedEnergy(const Film& film);

}  // namespace glim
