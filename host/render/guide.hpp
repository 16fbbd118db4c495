// What paths are guided by: a noun (shaders/shared/guide_types.h says how it is laid out).
#pragma once

#include "shaders/shared/vocabulary.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

struct Guide {
    std::vector<uvec4> texels;
    std::string digest;  // of the texels: films by different guides differ
    std::uint32_t cells = 0;
    std::uint64_t paths = 0;   // that it was learned by
    double seconds = 0.0;      // that this took
    bool scatterings = false;  // it is for those in media too
};

}  // namespace glim
