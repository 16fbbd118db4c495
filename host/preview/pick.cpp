#include "host/preview/pick.hpp"

#include <algorithm>
#include <iterator>

namespace glim {
namespace {

PathRay rayThrough(const FlatCamera& camera, const glm::uvec2& pixel, const glm::uvec2& size)
{
    const glm::vec2 film = 2.0F * (glm::vec2(pixel) + 0.5F) / glm::vec2(size) - 1.0F;
    const glm::vec3 across = film.x * camera.right - film.y * camera.up;
    return camera.kind == kOrthographic ? PathRay{camera.position + across, kNoRecord, camera.forward}
                                        : PathRay{camera.position, kNoRecord, glm::normalize(camera.forward + across)};
}

std::string quoted(const std::string& name) { return name.empty() ? "without a name" : "\"" + name + "\""; }

// Triangles come before spheres.
void describe(const Scene& scene, std::uint32_t id, Pick& pick)
{
    if (id >= scene.triangles.size()) {
        const Sphere& sphere = scene.spheres[id - scene.triangles.size()];
        pick.object = "sphere " + quoted(sphere.name);
        pick.material = quoted(scene.materials[sphere.material].name);
        return;
    }
    const auto after = std::upper_bound(scene.primitives.begin(), scene.primitives.end(), id,
                                        [](std::uint32_t value, const Primitive& p) { return value < p.firstTriangle; });
    const Primitive& primitive = *std::prev(after);
    pick.object = "mesh " + quoted(primitive.name) + ", triangle " + std::to_string(id - primitive.firstTriangle);
    pick.material = quoted(scene.materials[primitive.material].name);
}

}  // namespace

std::optional<Pick> pick(Renderer& renderer, const PreparedScene& prepared, const FlatCamera& camera, const glm::uvec2& pixel,
                         const glm::uvec2& size)
{
    const PathRay ray = rayThrough(camera, pixel, size);
    const PathHit hit = renderer.traceRay(ray);
    if (hit.record == kNoRecord) {
        return std::nullopt;
    }
    Pick found;
    found.distance = static_cast<double>(hit.t);
    found.position = prepared.scene.origin + glm::dvec3(ray.origin) + found.distance * glm::dvec3(ray.direction);
    describe(prepared.scene, prepared.flat.records[std::size_t{hit.record} * kRecordTexels].w, found);
    return found;
}

}  // namespace glim
