#include "host/render/device_scene.hpp"

#include "shaders/shared/bindings.h"

#include <algorithm>

namespace glim {
namespace {

// A buffer cannot be empty: an array that the scene does not need gets one zero element.
template <class T>
Buffer uploaded(Device& device, const std::string& name, BufferKind kind, const std::vector<T>& values)
{
    const std::vector<T> one(1, T{});
    const std::vector<T>& source = values.empty() ? one : values;
    Buffer buffer(device, name, kind, source.size() * sizeof(T));
    upload(buffer, std::span<const T>(source));
    return buffer;
}

}  // namespace

DeviceScene::DeviceScene(Device& device, const FlatScene& scene)
    : nodes_(uploaded(device, "scene's BVH nodes", BufferKind::Texel, scene.nodes)),
      records_(uploaded(device, "scene's records", BufferKind::Texel, scene.records)),
      triangles_(uploaded(device, "scene's triangles for shading", BufferKind::Texel, scene.triangles)),
      vertices_(uploaded(device, "scene's vertices", BufferKind::Texel, scene.vertices)),
      materials_(uploaded(device, "scene's materials", BufferKind::Texel, scene.materials)),
      lights_(uploaded(device, "scene's lights", BufferKind::Texel, scene.lights)),
      emitters_(uploaded(device, "scene's emitters", BufferKind::Texel, scene.emitters))
{}

std::vector<BindingSlot> DeviceScene::slots()
{
    return {{kBindNodes, BufferKind::Texel},    {kBindRecords, BufferKind::Texel},   {kBindTriangles, BufferKind::Texel},
            {kBindVertices, BufferKind::Texel}, {kBindMaterials, BufferKind::Texel}, {kBindLights, BufferKind::Texel},
            {kBindEmitters, BufferKind::Texel}};
}

std::map<std::uint32_t, const Buffer*> DeviceScene::buffers() const
{
    return {{kBindNodes, &nodes_},         {kBindRecords, &records_}, {kBindTriangles, &triangles_}, {kBindVertices, &vertices_},
            {kBindMaterials, &materials_}, {kBindLights, &lights_},   {kBindEmitters, &emitters_}};
}

}  // namespace glim
