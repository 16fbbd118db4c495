#include "host/bvh/surface_area.hpp"

namespace glim {

double computeHalfArea(const Box& box)
{
    const glm::dvec3 extent = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    return extent.x * extent.y + extent.y * extent.z + extent.z * extent.x;
}

double computeCost(std::span<const BvhNode> nodes)
{
    const double rootArea = computeHalfArea(nodes.front().box);
    double cost = 0.0;
    for (const BvhNode& node : nodes) {
        const double met = rootArea > 0.0 ? computeHalfArea(node.box) / rootArea : 1.0;
        cost += met * (node.count == 0 ? 1.0 : node.count);
    }
    return cost;
}

}  // namespace glim
