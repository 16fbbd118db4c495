#include "host/bvh/refit_bvh.hpp"

#include "host/bvh/surface_area.hpp"

namespace glim {
std::optional<WideBvh> refitBvh(WideBvh bvh, std::span<const Box> boxes, double maxCost)
{
    const std::size_t nodeCount = bvh.meshTrees.empty() ? bvh.nodes.size() : bvh.meshTrees.front().firstNode;
    std::vector<Box> ofNodes(nodeCount, kEmptyBox);
    for (const InstanceNode& node : bvh.instances) {
        ofNodes[node.node] = boxes[boxes.size() - bvh.instances.size() + node.instance];
    }
    double areas = 0.0;  // of nodes, and of leaves for each of their primitives
    for (std::size_t i = nodeCount; i-- > 0;) {
        bool inner = false;
        for (WideChild& child : bvh.nodes[i].children) {
            if (child.kind == WideChild::Kind::Nothing) {
                continue;
            }
            inner = true;
            child.box = child.kind == WideChild::Kind::Inner ? ofNodes[child.first] : kEmptyBox;
            for (std::uint32_t k = 0; k < child.count; ++k) {
                child.box = unite(child.box, boxes[bvh.order[child.first + k]]);
            }
            areas += child.count * computeHalfArea(child.box);
            ofNodes[i] = unite(ofNodes[i], child.box);
        }
        areas += inner ? computeHalfArea(ofNodes[i]) : 0.0;
    }
    bvh.box = ofNodes[0];
    return areas <= maxCost * bvh.cost * computeHalfArea(bvh.box) ? std::optional(std::move(bvh)) : std::nullopt;
}

}  // namespace glim
