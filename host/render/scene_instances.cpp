#include "host/render/scene_instances.hpp"

#include <map>
#include <set>
#include <tuple>

namespace glim {
namespace {

std::string nameOf(const std::vector<std::string>& names, std::uint32_t index, const char* kind)
{
    return index < names.size() && !names[index].empty() ? names[index] : kind + ("." + std::to_string(index));
}

}  // namespace

SceneInstances::SceneInstances(const Scene& scene)
{
    // The first placing of a node has its first of each mesh, the second one its second, and so on.
    std::map<std::tuple<std::uint32_t, std::uint32_t>, std::uint32_t> uses;                       // of a mesh by a node
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> instanceOf;  // node, file's mesh, number
    std::map<std::uint32_t, std::uint32_t> placings;                                              // of a node
    std::map<std::uint32_t, std::string> kinds;                                                   // of a mesh
    std::vector<std::uint32_t> numbers;
    const auto add = [&](std::uint32_t node, std::uint32_t mesh, std::uint32_t number) {
        const auto [found, isNew] = instanceOf.try_emplace({node, mesh, number}, static_cast<std::uint32_t>(instances_.size()));
        if (isNew) {
            const std::string name = nameOf(scene.nodeNames, node, "node");
            const bool isNamed = mesh < scene.meshNames.size() && !scene.meshNames[mesh].empty();
            const std::string kind = mesh == kNoIndex ? "sphere" : isNamed ? scene.meshNames[mesh] : name;
            instances_.push_back({name, node, mesh, kinds.try_emplace(mesh, kind).first->second});
            numbers.push_back(number);
            ++placings[node];
        }
        ofObject_.push_back(found->second);
    };
    for (const MeshInstance& instance : scene.instances) {
        add(instance.node, scene.meshes[instance.mesh].fileMesh, uses[{instance.node, instance.mesh}]++);
    }
    for (const Sphere& sphere : scene.spheres) {
        add(sphere.node, kNoIndex, 0);
    }
    std::map<std::string, std::set<std::uint32_t>> nodes;  // of a name
    for (const SceneInstance& instance : instances_) {
        nodes[instance.name].insert(instance.node);
    }
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        SceneInstance& instance = instances_[i];
        instance.name += nodes[instance.name].size() > 1 ? "." + std::to_string(instance.node) : "";
        instance.name += placings[instance.node] > 1 ? "[" + std::to_string(numbers[i]) + "]" : "";
    }
}

}  // namespace glim
