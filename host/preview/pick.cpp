#include "host/preview/pick.hpp"

#include "host/measure/float_range.hpp"
#include "host/render/ray_tracer.hpp"
#include "shaders/shared/limits.h"

#include <cstdio>

namespace glim {
namespace {

double meanOf(const glm::dvec3& value) { return (value.r + value.g + value.b) / 3.0; }

// The ray through the centre of a pixel of a picture of this size, and through the middle of the lens.
PathRay rayThrough(const FlatCamera& camera, const glm::uvec2& pixel, const glm::uvec2& size)
{
    const glm::vec2 film = 2.0F * (glm::vec2(pixel) + 0.5F) / glm::vec2(size) - 1.0F;
    const glm::vec3 across = film.x * camera.right - film.y * camera.up;
    return camera.kind == kOrthographic ? PathRay{camera.position + across, kNoPrimitive, camera.forward}
                                        : PathRay{camera.position, kNoPrimitive, glm::normalize(camera.forward + across)};
}

}  // namespace

std::optional<Pick> pick(Refiner& refiner, const PreparedScene& prepared, const glm::uvec2& pixel, const glm::uvec2& size)
{
    const PathRay ray = rayThrough(refiner.camera(), pixel, size);
    const PathHit hit = RayTracer(refiner.renderer().resources()).trace(std::span(&ray, 1)).front();
    if (hit.primitiveRef == kNoPrimitiveRef) {
        return std::nullopt;
    }
    const double distance = static_cast<double>(hit.t);
    return Pick{prepared.scene.origin + glm::dvec3(ray.origin) + distance * glm::dvec3(ray.direction), distance,
                describePrimitive(prepared, hit.primitiveRef)};
}

std::string describeSurface(const std::optional<Pick>& found)
{
    if (!found) {
        return "nothing";
    }
    char place[200];
    std::snprintf(place, sizeof place, ", at (%.6g, %.6g, %.6g), %.6g m away", found->position.x, found->position.y, found->position.z,
                  found->distance);
    return toText(found->primitive) + ", material " + found->primitive.material + place;
}

std::string describeSamples(Refiner& refiner, const glm::uvec2& pixel, Aov aov)
{
    const RenderSettings& film = refiner.renderer().settings();
    const glm::uvec2 place = pixel / refiner.scale();
    const PixelMoments moments = refiner.renderer().moments(place.y * film.width + place.x);
    const glm::vec3 variance = computeVarianceOfMean(moments), error = glm::sqrt(variance);
    char text[300];
    std::snprintf(text, sizeof text, "; %u sample%s, mean (%.6g, %.6g, %.6g)%s", moments.count, moments.count == 1 ? "" : "s",
                  static_cast<double>(moments.mean.r), static_cast<double>(moments.mean.g), static_cast<double>(moments.mean.b),
                  aov == Aov::BvhSteps ? " node visits and primitive tests" : " W/(sr m^2)");
    std::string known = text;
    if (refiner.scale() > 1) {
        known += " in a picture of 1/" + std::to_string(refiner.scale()) + " size";
    }
    if (moments.blocks < 2) {
        return known + ", standard error known from 33 samples on";
    }
    if (!isWithinFloat(meanOf(variance), meanOf(moments.mean))) {
        return known + ", standard error unknown";
    }
    std::snprintf(text, sizeof text, ", standard error (%.2g, %.2g, %.2g)", static_cast<double>(error.r), static_cast<double>(error.g),
                  static_cast<double>(error.b));
    return known + text;
}

}  // namespace glim
