#include "host/preview/pick.hpp"

namespace glim {
namespace {

PathRay rayThrough(const FlatCamera& camera, const glm::uvec2& pixel, const glm::uvec2& size)
{
    const glm::vec2 film = 2.0F * (glm::vec2(pixel) + 0.5F) / glm::vec2(size) - 1.0F;
    const glm::vec3 across = film.x * camera.right - film.y * camera.up;
    return camera.kind == kOrthographic ? PathRay{camera.position + across, kNoPrimitive, camera.forward}
                                        : PathRay{camera.position, kNoPrimitive, glm::normalize(camera.forward + across)};
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
    found.primitive = describeRecord(prepared.scene, prepared.flat, hit.record);
    return found;
}

}  // namespace glim
