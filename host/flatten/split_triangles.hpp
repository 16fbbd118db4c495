// Boxes of parts of triangles, for a tree in which a large triangle's box does not cover what is beside it.
#pragma once

#include "host/bvh/bvh.hpp"
#include "host/scene/scene.hpp"

#include <vector>

namespace glim {

// Boxes of a scene's primitives or of parts of them. A primitive is inside all of its boxes together.
struct Pieces {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> primitives;  // whose each box is
};

// `boxes`: primitiveBoxes(scene), at least one. Divides those that waste most, the worst first, until there are a tenth more or none that wastes two
// boxes of mean size. Empty unless that makes more than a fiftieth more.
// T. Karras, T. Aila, Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (2013), section 4.2.
Pieces splitTriangles(const Scene& scene, std::vector<Box> boxes);

}  // namespace glim
