// Scenes of known size, made in memory. The tables of tests/bench/README.md measure them.
#pragma once

#include "host/scene/scene.hpp"

#include <string>
#include <vector>

namespace glim {

struct BenchScene {
    std::string name;
    Scene scene;
};

// A bumpy ball in a box under a lamp, 4^subdivisions * 20 triangles and a few.
Scene bumpyBall(int subdivisions);
// Trees of 1,000 leaves each on a meadow: many small triangles without order, and gaps.
Scene forest(int trees);

}  // namespace glim
