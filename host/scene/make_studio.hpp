// A photographer's studio as an environment, for scenes without a light.
#pragma once

#include "host/image/radiance_map.hpp"

namespace glim {

// Neutral: three softboxes around a dim room, brighter above than below, the key light in front (+z) to the left and above.
RadianceMap makeStudio();

}  // namespace glim
