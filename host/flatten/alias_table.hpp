// Alias tables: they sample in proportion to weights, in constant time.
#pragma once

#include "shaders/shared/scene_types.h"

#include <span>
#include <vector>

namespace glim {

struct AliasTable {
    std::vector<AliasEntry> entries;
    std::vector<double> probabilities;  // exactly those with which shaders/lib/alias.glsl samples each entry
};

// Takes at least one weight; all are positive and finite. M. Vose, "A Linear Algorithm for Generating Random Numbers with a Given
// Distribution", 1991, in double. Every entry keeps a positive probability however small its weight is.
AliasTable buildAliasTable(std::span<const double> weights);

}  // namespace glim
