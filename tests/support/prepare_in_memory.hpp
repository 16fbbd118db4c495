// A scene made in memory, as prepareScene makes it of a file.
#pragma once

#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/prepare_scene.hpp"

namespace glim {

// Nodes are the instances and then the spheres, meshes and materials those of the scene.
inline Scene nameParts(Scene scene)
{
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        scene.meshes.change()[i].fileMesh = static_cast<std::uint32_t>(i);
        scene.meshNames.push_back(scene.meshes[i].name);
    }
    for (MeshInstance& instance : scene.instances) {
        instance.node = static_cast<std::uint32_t>(scene.nodeNames.size());
        scene.nodeNames.push_back(instance.name);
    }
    for (Sphere& sphere : scene.spheres) {
        sphere.node = static_cast<std::uint32_t>(scene.nodeNames.size());
        scene.nodeNames.push_back(sphere.name);
    }
    return scene;
}

inline PreparedScene prepare(Scene scene, std::uint64_t maxFlatTriangles = kMaxFlatTriangles)
{
    PreparedScene prepared;
    prepared.scene = std::move(scene);
    prepared.primitives = makePrimitives(prepared.scene, maxFlatTriangles);
    prepared.bvh = buildSceneBvh(prepared.primitives);
    prepared.flat = flattenScene(prepared.scene, prepared.primitives, prepared.bvh);
    return prepared;
}

}  // namespace glim
