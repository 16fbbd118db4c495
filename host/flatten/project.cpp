#include "host/flatten/project.hpp"

#include <cmath>

namespace glim {
namespace {

struct Coefficients {
    explicit Coefficients(const FlatProjection& p)
        : radial(p.radial),
          radial2(p.radial2),
          tangential(p.tangential)
    {}
    glm::dvec4 radial;
    glm::dvec2 radial2, tangential;
};

// As distortRadially of shaders/lib/projection.glsl.
glm::dvec2 distortRadially(const Coefficients& p, const glm::dvec2& x)
{
    const double r2 = glm::dot(x, x);
    const double above = 1.0 + r2 * (p.radial.x + r2 * (p.radial.y + r2 * p.radial.z));
    const double below = 1.0 + r2 * (p.radial.w + r2 * (p.radial2.x + r2 * p.radial2.y));
    const glm::dvec2 t = p.tangential;
    const double cross2 = 2.0 * x.x * x.y;
    return x * (above / below) + glm::dvec2(t.x * cross2 + t.y * (r2 + 2.0 * x.x * x.x), t.x * (r2 + 2.0 * x.y * x.y) + t.y * cross2);
}

double distortAngle(const Coefficients& p, double angle)
{
    const double s = angle * angle;
    return angle * (1.0 + s * (p.radial.x + s * (p.radial.y + s * (p.radial.z + s * p.radial.w))));
}

std::optional<glm::dvec2> projectToSphere(const FlatCamera& camera, const glm::dvec3& local)
{
    const FlatProjection& projection = camera.projection;
    glm::dvec2 image;
    if (projection.model == kEquirectangular) {
        image = {std::atan2(local.x, local.z), std::atan2(local.y, std::hypot(local.x, local.z))};
    } else {
        const double sine = std::hypot(local.x, local.y), angle = std::atan2(sine, local.z);
        if (angle > static_cast<double>(projection.end)) {
            return std::nullopt;
        }
        image = sine > 0.0 ? glm::dvec2(local) * (distortAngle(Coefficients(projection), angle) / sine) : glm::dvec2(0.0);
    }
    return image / glm::dvec2(projection.scale) - glm::dvec2(projection.shift);
}

}  // namespace

std::optional<glm::dvec2> projectToFilm(const FlatCamera& camera, const glm::dvec3& from)
{
    const glm::dvec3 right(camera.right), up(camera.up), forward(camera.forward);
    const FlatProjection& projection = camera.projection;
    if (projection.model >= kFisheye) {
        return projectToSphere(camera, {glm::dot(from, right), glm::dot(from, up), glm::dot(from, forward)});
    }
    const double depth = glm::dot(from, forward);
    if (!(depth > 0.0)) {
        return std::nullopt;
    }
    const glm::dvec3 across = camera.kind == kOrthographic ? from : from / depth;
    glm::dvec2 plane(glm::dot(across, right) / glm::dot(right, right), glm::dot(across, up) / glm::dot(up, up));
    if (projection.model == kRadialTangential) {
        const glm::dvec2 scale(projection.scale), tangents = plane * scale;
        if (glm::length(tangents) > static_cast<double>(projection.end)) {
            return std::nullopt;
        }
        plane = distortRadially(Coefficients(projection), tangents) / scale;
    }
    return projection.model == kCentredFilm ? plane : plane - glm::dvec2(projection.shift);
}

}  // namespace glim
