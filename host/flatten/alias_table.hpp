// Alias tables for drawing in proportion to weights.
#pragma once

#include "shaders/shared/scene_types.h"

#include <span>
#include <vector>

namespace glim {

struct AliasTable {
    std::vector<AliasEntry> entries;
    std::vector<double> probabilities;  // with which shaders/lib/alias.glsl draws each entry, exactly
};

// At least one weight, all positive and finite. Vose, "A Linear Algorithm for Generating Random Numbers with a Given
// Distribution", 1991, in double; every entry keeps a positive probability however small its weight.
AliasTable buildAliasTable(std::span<const double> weights);

}  // namespace glim
