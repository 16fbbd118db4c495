#include "host/render/describe_primitive.hpp"

#include <algorithm>
#include <iterator>

namespace glim {
namespace {

std::string quoted(const std::string& name) { return name.empty() ? "without a name" : "\"" + name + "\""; }

// The flat one has its values, and lights without any power are left out.
bool isSame(const PunctualLight& light, const FlatLight& flat)
{
    return light.position == flat.position && light.direction == flat.direction && light.intensity == flat.intensity &&
           light.cosInner == flat.cosInner && light.cosOuter == flat.cosOuter;
}

std::string describePunctual(const Scene& scene, const FlatLight& flat)
{
    const auto found = std::find_if(scene.lights.begin(), scene.lights.end(),
                                    [&](const PunctualLight& light) { return isSame(light, flat); });
    const std::string kind = flat.kind == kPointLight ? "point" : flat.kind == kSpotLight ? "spot" : "directional";
    return kind + " light " + quoted(found->name);
}

}  // namespace

std::string textOf(const PrimitiveDescription& primitive)
{
    return primitive.object + (primitive.triangle ? ", triangle " + std::to_string(*primitive.triangle) : "");
}

// Triangles come before spheres.
PrimitiveDescription describePrimitive(const Scene& scene, std::uint32_t id)
{
    if (id >= scene.triangles.size()) {
        const Sphere& sphere = scene.spheres[id - scene.triangles.size()];
        return {"sphere " + quoted(sphere.name), std::nullopt, quoted(scene.materials[sphere.material].name)};
    }
    const auto after = std::upper_bound(scene.primitives.begin(), scene.primitives.end(), id,
                                        [](std::uint32_t value, const Primitive& p) { return value < p.firstTriangle; });
    const Primitive& primitive = *std::prev(after);
    return {"mesh " + quoted(primitive.name), id - primitive.firstTriangle, quoted(scene.materials[primitive.material].name)};
}

PrimitiveDescription describeRecord(const Scene& scene, const FlatScene& flat, std::uint32_t record)
{
    return describePrimitive(scene, flat.records[std::size_t{record} * kRecordTexels].w);
}

std::string describeLight(const Scene& scene, const FlatScene& flat, std::uint32_t light)
{
    const FlatLight& source = flat.lights[light];
    if (source.kind == kEnvironmentLight) {
        return "environment";
    }
    if (source.kind == kTriangleLight || source.kind == kSphereLight) {
        return describeRecord(scene, flat, flat.emitters[source.firstEmitter].record).object;
    }
    return describePunctual(scene, source);
}

}  // namespace glim
