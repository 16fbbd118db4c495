// Chooses the origin of a scene's coordinates, and finds parts that are too far from it for float32.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace glim {

// The box of a triangle or a sphere, in world coordinates.
struct Place {
    glm::dvec3 center;
    double size;         // its longest side, > 0
    double count;        // of the part's primitives that it stands for
    std::uint32_t part;  // of the scene
};

// The size of fine primitives: all but the four smallest and the smallest 64th are at least as large, so that a tiny part that lies astray
// does not count. `sizes` is not empty.
double fineSize(std::vector<double> sizes);

// The centre of the scene's box; or the median of all primitives, weighted by 1 / size, if from there half of the weight lies within a
// quarter of the distance. The median is where the sum of distance / size, which is what float32 loses, is least. However far away they
// lie, parts that have less than half of the weight do not move it far, and the largest coordinate is at most twice that about the centre.
// `places` is not empty.
glm::dvec3 chooseOrigin(std::span<const Place> places, const glm::dvec3& center);

// A part that rounding to float32 shows in.
struct CoarsePart {
    std::uint32_t part;
    double spacing;  // of coordinates there
    double size;     // of a primitive there
};

// The coarsest first.
std::vector<CoarsePart> findCoarseParts(std::span<const Place> places, const glm::dvec3& origin);

}  // namespace glim
