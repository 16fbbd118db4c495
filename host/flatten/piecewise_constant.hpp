// Tables that sample a piecewise constant density by inverting its cumulative distribution function, so that well-spread random numbers
// give well-spread samples (shaders/access/environment_map.glsl reads them).
#pragma once

#include "shaders/shared/scene_types.h"

#include <span>
#include <vector>

namespace glim {

// An entry is sampled by the random words from `first` to `last`.
struct PiecewiseConstantEntry {
    std::uint32_t first, last;
    std::uint32_t searchBegin, searchEnd;  // entry i: the entries that random words in [i, i + 1) / n of all fall to
};

// One entry per weight. Weights are at least 0, one above. Every entry keeps a positive probability.
std::vector<PiecewiseConstantEntry> buildPiecewiseConstant(std::span<const double> weights);

// The exact probability with which an entry is sampled.
double computeProbability(const PiecewiseConstantEntry& entry);

}  // namespace glim
