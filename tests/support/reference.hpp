// A slow and obvious ray caster in double: every primitive is tried, each by its definition. It shares no method with the
// shaders: triangles by their plane and areas, spheres by the point of closest approach.
#pragma once

#include "host/flatten/primitives.hpp"

#include <limits>

namespace glim {

struct ReferenceHit {
    double t = std::numeric_limits<double>::infinity();
    std::uint32_t id = 0xffffffffU;  // triangles, then spheres
    double cosine = 1.0;             // between the ray and the normal, absolute
};

struct ReferenceRay {
    glm::dvec3 origin, direction;
    std::uint32_t source = 0xffffffffU;  // a triangle is never met by the ray that leaves it, a sphere only from within
};

class Reference {
public:
    explicit Reference(const Scene& scene)
        : primitives_(makePrimitives(scene))
    {}

    // The closest primitive at t > 0. Every primitive is grown by `margin` of its size (shrunk if negative). Where two
    // opposite margins agree, rounding does not decide.
    ReferenceHit closest(const ReferenceRay& ray, double margin) const;

    // Whether anything but `target` is met within (0, tMax].
    bool isOccluded(const ReferenceRay& ray, double tMax, std::uint32_t target, double margin) const;

private:
    ReferenceHit meet(const ReferenceRay& ray, std::uint32_t id, double margin) const;
    ReferenceHit meetTriangle(const ReferenceRay& ray, std::uint32_t id, double margin) const;
    ReferenceHit meetSphere(const ReferenceRay& ray, std::uint32_t id, double margin) const;
    std::uint32_t count() const { return static_cast<std::uint32_t>(primitives_.count()); }

    Primitives primitives_;
};

}  // namespace glim
