// What paths are guided by: a noun (shaders/shared/guide_types.h says how it is laid out).
#pragma once

#include "shaders/shared/guide_types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

struct Guide {
    std::vector<uvec4> texels;
    std::string digest;  // of the texels: films by different guides differ
    std::uint32_t cells = 0;
    std::uint64_t paths = 0;  // that it was learned by
    double seconds = 0.0;     // that this took
};

// Whether they guide scatterings in media, too: the root of these has children then, as all nodes have.
inline bool guideScatterings(const std::vector<uvec4>& texels)
{
    return texels.size() > kGuideOfScatterings && texels[kGuideOfScatterings].w != 0;
}

}  // namespace glim
