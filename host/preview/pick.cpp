#include "host/preview/pick.hpp"

#include "host/measure/float_range.hpp"
#include "shaders/shared/limits.h"

#include <cstdio>

namespace glim {
namespace {

double meanOf(const glm::dvec3& value) { return (value.r + value.g + value.b) / 3.0; }

}  // namespace

std::optional<Pick> Picker::pick(Refiner& refiner, const PreparedScene& prepared, const glm::uvec2& pixel, const glm::uvec2& size)
{
    const RenderResources& resources = refiner.renderer().resources();
    RenderSettings settings = refiner.renderer().settings();
    settings.width = size.x;
    settings.height = size.y;
    CameraRays rays(resources.device, *resources.shared, prepared.flat, refiner.camera(), settings, kernels_, RayPlace::Centers);
    kernels_ = rays.kernels();
    const std::uint32_t chosen = pixel.y * size.x + pixel.x;
    const PathHit hit = rays.trace(std::span(&chosen, 1), 0, 1).front();
    const PathRay ray = rays.rays(1).front();
    if (hit.primitiveRef == kNoPrimitiveRef) {
        return std::nullopt;
    }
    const double distance = static_cast<double>(hit.t);
    const glm::dvec3 direction(ray.direction);
    return Pick{prepared.scene.origin + glm::dvec3(ray.origin) + distance * direction, distance,
                distance * glm::dot(direction, glm::dvec3(refiner.camera().forward)), describePrimitive(prepared, hit.primitiveRef)};
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
