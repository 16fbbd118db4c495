#include "tests/support/reference.hpp"

#include <cmath>

namespace glim {

ReferenceHit Reference::meetTriangle(const ReferenceRay& ray, std::uint32_t id, double margin) const
{
    const glm::dvec3 v0(primitives_.triangles[id].vertices[0]);
    const glm::dvec3 e1 = glm::dvec3(primitives_.triangles[id].vertices[1]) - v0;
    const glm::dvec3 e2 = glm::dvec3(primitives_.triangles[id].vertices[2]) - v0;
    const glm::dvec3 n = glm::cross(e1, e2);
    const double along = glm::dot(ray.direction, n);
    if (id == ray.source || along == 0.0) {
        return {};
    }
    const double t = glm::dot(v0 - ray.origin, n) / along;
    const glm::dvec3 p = ray.origin + t * ray.direction - v0;
    const double area = glm::dot(n, n);
    const double b1 = glm::dot(n, glm::cross(p, e2)) / area, b2 = glm::dot(n, glm::cross(e1, p)) / area;
    if (!(t > 0.0 && b1 >= -margin && b2 >= -margin && b1 + b2 <= 1.0 + margin)) {
        return {};
    }
    return {t, id, std::abs(along) / std::sqrt(area) / glm::length(ray.direction)};
}

ReferenceHit Reference::meetSphere(const ReferenceRay& ray, std::uint32_t id, double margin) const
{
    const PlacedSphere& sphere = primitives_.spheres[id - primitives_.triangles.size()];
    const glm::dvec3 center(sphere.center);
    const double radius = static_cast<double>(sphere.radius) * (1.0 + margin);
    const double closest = glm::dot(center - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
    if (id == ray.source) {
        // The origin is one end of a chord; the other end is as far behind the chord's middle.
        const bool inwards = closest * glm::length(ray.direction) > -margin * radius;
        return inwards ? ReferenceHit{std::abs(2.0 * closest), id, std::abs(closest) * glm::length(ray.direction) / radius}
                       : ReferenceHit{};
    }
    // Within the margin the ray may count as outside or as inside. The grown scene takes a hit at once, the shrunk one takes
    // none.
    if (std::abs(glm::length(ray.origin - center) - static_cast<double>(sphere.radius)) < std::abs(margin) * radius) {
        return margin > 0.0 ? ReferenceHit{0.0, id, 1.0} : ReferenceHit{};
    }
    const double distance = glm::length(ray.origin + closest * ray.direction - center);
    if (distance > radius || radius <= 0.0) {
        return {};
    }
    const double half = std::sqrt((radius - distance) * (radius + distance));
    const double step = half / glm::length(ray.direction);
    const double t = closest - step > 0.0 ? closest - step : closest + step;
    return t > 0.0 ? ReferenceHit{t, id, half / radius} : ReferenceHit{};
}

ReferenceHit Reference::meet(const ReferenceRay& ray, std::uint32_t id, double margin) const
{
    return id < primitives_.triangles.size() ? meetTriangle(ray, id, margin) : meetSphere(ray, id, margin);
}

ReferenceHit Reference::closest(const ReferenceRay& ray, double margin) const
{
    ReferenceHit best;
    for (std::uint32_t id = 0; id < count(); ++id) {
        const ReferenceHit hit = meet(ray, id, margin);
        if (hit.t < best.t) {
            best = hit;
        }
    }
    return best;
}

bool Reference::isOccluded(const ReferenceRay& ray, double tMax, std::uint32_t target, double margin) const
{
    for (std::uint32_t id = 0; id < count(); ++id) {
        const double t = meet(ray, id, margin).t;
        // A blocker at the very end of the segment counts for the grown scene only.
        if (id != target && t < std::numeric_limits<double>::infinity() && t <= tMax * (1.0 + margin)) {
            return true;
        }
    }
    return false;
}

}  // namespace glim
