// A generated scene of any size, for benches without a scene file.
#pragma once

#include "host/scene/scene.hpp"

namespace glim {

// Hills of 2 * cells^2 triangles in [-10, 10]^2 under an area light of 8 x 8 m and a sky of .5, with one camera; cells >= 1.
Scene makeHills(int cells);

}  // namespace glim
