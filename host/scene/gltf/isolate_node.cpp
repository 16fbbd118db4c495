#include "host/scene/gltf/isolate_node.hpp"

#include <vector>

namespace glim {

std::set<std::size_t> nodesToHide(const tinygltf::Model& model, const std::set<std::size_t>& drawn, std::optional<std::size_t> kept)
{
    std::vector<std::optional<std::size_t>> parents(model.nodes.size());
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        for (const int child : model.nodes[i].children) {
            parents[static_cast<std::size_t>(child)] = i;
        }
    }
    // What must stay visible, with all above it.
    std::vector<bool> stays(model.nodes.size(), false);
    const auto keep = [&](std::optional<std::size_t> node) {
        for (; node && !stays[*node]; node = parents[*node]) {
            stays[*node] = true;
        }
    };
    keep(kept);
    for (std::size_t i = 0; i < model.nodes.size(); ++i) {
        if (model.nodes[i].extensions.count("KHR_lights_punctual") != 0) {
            keep(i);
        }
    }
    std::set<std::size_t> hidden;
    for (const std::size_t node : drawn) {
        std::optional<std::size_t> topmost;
        bool isBelow = false;
        for (std::optional<std::size_t> at = node; at && !isBelow; at = parents[*at]) {
            isBelow = at == kept;
            topmost = stays[*at] ? topmost : at;
        }
        if (topmost && !isBelow) {
            hidden.insert(*topmost);
        }
    }
    return hidden;
}

}  // namespace glim
