// Spatial splits: splits the boxes of large triangles, so that they enclose less empty space.
#pragma once

#include "host/bvh/bvh.hpp"
#include "host/scene/placed_mesh.hpp"

#include <span>
#include <vector>

namespace glim {

// Boxes of primitives or of parts of them. Together, the boxes of a primitive cover it.
struct Pieces {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> primitives;  // of each box
};

// `boxes` are those of all primitives, at least one; those of `triangles` come first. Splits the most wasteful boxes first, until there
// are a tenth more boxes or none wastes as much as two boxes of mean size. Returns nothing unless there are then more than a fiftieth
// more boxes.
// T. Karras, T. Aila, Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (2013), section 4.2.
Pieces splitTriangles(std::span<const Triangle> triangles, std::vector<Box> boxes);

}  // namespace glim
