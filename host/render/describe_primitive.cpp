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

// `id`: of a primitive that belongs to no shared mesh.
ScenePart findPart(const Primitives& primitives, std::uint32_t id)
{
    if (id >= primitives.triangles.size()) {
        const PlacedSphere placed = primitives.spheres[id - primitives.triangles.size()];
        return {placed.object, 0, placed.point};
    }
    const std::uint32_t instance = primitives.findInstance(id);
    return {instance, id - primitives.firstTriangles[instance]};
}

PrimitiveDescription describePart(const Scene& scene, const ScenePart& part)
{
    if (part.object >= scene.instances.size()) {
        const Sphere& sphere = scene.spheres[part.object - scene.instances.size()];
        return {"sphere " + named(sphere.name), {}, {}, named(scene.materials[sphere.material].name), sphere.node, sphere.material};
    }
    const MeshInstance& instance = scene.instances[part.object];
    const Mesh& mesh = scene.meshes[instance.mesh];
    PrimitiveDescription description{
        "instance " + named(instance.name), {}, {}, named(scene.materials[mesh.material].name), instance.node, mesh.material};
    (mesh.isCloud ? description.point : description.triangle) = mesh.isCloud ? part.point : part.triangle;
    description.isLine = mesh.isCloud && !mesh.lines.empty();
    return description;
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

ScenePart findPart(const PreparedScene& prepared, std::uint32_t ref)
{
    if (ref == kNoPrimitiveRef) {
        return {};
    }
    const Primitives& primitives = prepared.primitives;
    const auto idOf = [&prepared](std::uint32_t any) { return prepared.flat.primitiveRefs[std::size_t{any} * kPrimitiveRefTexels].w; };
    if (isInstanced(prepared.flat, ref)) {
        const std::uint32_t index = findPlacement(prepared.flat, ref);
        const Placement& placement = primitives.placements[index];
        const std::uint32_t shared = idOf(ref - prepared.flat.instances[std::size_t{index} * kInstanceTexels + 1].w);
        return {placement.instance, shared - primitives.sharedMeshes[placement.sharedMesh].firstId};
    }
    return findPart(primitives, idOf(ref));
}

PrimitiveDescription describePrimitive(const PreparedScene& prepared, std::uint32_t ref)
{
    return describePart(prepared.scene, findPart(prepared, ref));
}

std::string describeLight(const PreparedScene& prepared, std::uint32_t light)
{
    const FlatLight& source = prepared.flat.lights[light];
    if (source.kind == kEnvironmentLight) {
        return "environment";
    }
    if ((source.kind & kLightKindMask) <= kSphereLight) {
        return describePart(prepared.scene, findPart(prepared.primitives, source.primitive)).object;
    }
    return describePunctual(prepared.scene, source);
}

}  // namespace glim
