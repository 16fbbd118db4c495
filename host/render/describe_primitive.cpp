#include "host/render/describe_primitive.hpp"

#include "host/message.hpp"

#include <algorithm>
#include <ranges>

namespace glim {
namespace {

std::string named(const std::string& name) { return name.empty() ? "without a name" : escaped(inQuotes(name)); }

// Compares values, not indices: the flat scene leaves out lights without power.
bool isSame(const PunctualLight& light, const FlatLight& flat)
{
    return light.position == flat.position && light.direction == flat.edge1 && light.intensity == flat.intensity &&
           light.versineInner == flat.versineInner && light.versineOuter == flat.versineOuter;
}

std::string describePunctual(const Scene& scene, const FlatLight& flat)
{
    const auto found =
        std::find_if(scene.lights.begin(), scene.lights.end(), [&](const PunctualLight& light) { return isSame(light, flat); });
    const std::string kind = flat.kind == kPointLight ? "point" : flat.kind == kSpotLight ? "spot" : "directional";
    return kind + " light " + named(found->name);
}

PrimitiveDescription describePart(const Scene& scene, const MeshInstance& instance, std::optional<std::uint32_t> triangle,
                                  std::optional<std::uint32_t> point)
{
    const std::uint32_t material = scene.meshes[instance.mesh].material;
    return {"instance " + named(instance.name), triangle, point, named(scene.materials[material].name), instance.node, material};
}

PrimitiveDescription describePrimitive(const Scene& scene, const Primitives& primitives, std::uint32_t id)
{
    if (id >= primitives.triangles.size()) {
        const PlacedSphere& placed = primitives.spheres[id - primitives.triangles.size()];
        if (placed.point != kNoIndex) {
            PrimitiveDescription part = describePart(scene, scene.instances[placed.object], std::nullopt, placed.point);
            part.isLine = !scene.meshes[scene.instances[placed.object].mesh].lines.empty();
            return part;
        }
        const Sphere& sphere = scene.spheres[placed.object - scene.instances.size()];
        return {"sphere " + named(sphere.name),
                std::nullopt,
                std::nullopt,
                named(scene.materials[sphere.material].name),
                sphere.node,
                sphere.material};
    }
    const std::uint32_t index = primitives.findInstance(id);
    const MeshInstance& instance = scene.instances[index];
    return describePart(scene, instance, id - primitives.firstTriangles[index], std::nullopt);
}

PrimitiveDescription describeInstancedPrimitive(const PreparedScene& prepared, std::uint32_t ref)
{
    const std::uint32_t index = findPlacement(prepared.flat, ref);
    const uvec4* instance = &prepared.flat.instances[std::size_t{index} * kInstanceTexels];
    const std::uint32_t shared = prepared.flat.primitiveRefs[std::size_t{ref - instance[1].w} * kPrimitiveRefTexels].w;
    const Placement& placement = prepared.primitives.placements[index];
    const MeshInstance& placed = prepared.scene.instances[placement.instance];
    return describePart(prepared.scene, placed, shared - prepared.primitives.sharedMeshes[placement.sharedMesh].firstId, std::nullopt);
}

}  // namespace

std::string toText(const PrimitiveDescription& primitive)
{
    return primitive.object + (primitive.triangle ? ", triangle " + std::to_string(*primitive.triangle)
                               : primitive.point  ? (primitive.isLine ? ", line " : ", point ") + std::to_string(*primitive.point)
                                                  : "");
}

bool isInstanced(const FlatScene& flat, std::uint32_t ref) { return ref >= flat.firstInstanceRef && !flat.instances.empty(); }

std::uint32_t findPlacement(const FlatScene& flat, std::uint32_t ref)
{
    const auto indices = std::views::iota(std::size_t{0}, flat.instances.size() / kInstanceTexels);
    const auto after = std::ranges::upper_bound(indices, ref, {}, [&](std::size_t i) { return flat.instances[i * kInstanceTexels].w; });
    return static_cast<std::uint32_t>(after - indices.begin() - 1);
}

PrimitiveDescription describePrimitive(const PreparedScene& prepared, std::uint32_t ref)
{
    if (isInstanced(prepared.flat, ref)) {
        return describeInstancedPrimitive(prepared, ref);
    }
    const std::uint32_t id = prepared.flat.primitiveRefs[std::size_t{ref} * kPrimitiveRefTexels].w;
    return describePrimitive(prepared.scene, prepared.primitives, id);
}

std::string describeLight(const PreparedScene& prepared, std::uint32_t light)
{
    const FlatLight& source = prepared.flat.lights[light];
    if (source.kind == kEnvironmentLight) {
        return "environment";
    }
    if ((source.kind & kLightKindMask) <= kSphereLight) {
        return describePrimitive(prepared.scene, prepared.primitives, source.primitive).object;
    }
    return describePunctual(prepared.scene, source);
}

}  // namespace glim
