// The instances of a scene: what a node shows, once for each time that it is placed (EXT_mesh_gpu_instancing).
#pragma once

#include "host/scene/scene.hpp"

#include <string>
#include <vector>

namespace glim {

struct SceneInstance {
    std::string name;  // the node's, or node.N by its index; with .N where nodes share a name, with [K] where a node is placed often
    std::uint32_t node, mesh;  // of the file; kNoIndex where it has none
    std::string kind;          // the mesh's name; that of its first node where it has none, or sphere

    bool operator==(const SceneInstance&) const = default;
};

class SceneInstances {
public:
    explicit SceneInstances(const Scene& scene);

    const std::vector<SceneInstance>& all() const { return instances_; }
    // `object`: of the scene's instances, which have one material each, and behind these its spheres.
    std::uint32_t ofObject(std::uint32_t object) const { return ofObject_[object]; }

private:
    std::vector<SceneInstance> instances_;  // in the scene's order
    std::vector<std::uint32_t> ofObject_;
};

}  // namespace glim
