#pragma once

#include "shaders/shared/vocabulary.h"

#include <vector>

namespace glim {

// Whether descents through a guide's trees end, and within its texels, which may be of a crafted file: each texel is reached from one place
// at most. The numbers besides may be any. They make another picture, as those of a crafted film's pixels do.
bool hasSoundTrees(const std::vector<uvec4>& texels);

}  // namespace glim
