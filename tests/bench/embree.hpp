// Embree over the triangles of a scene, on as many threads as the machine has.
#pragma once

#include "host/flatten/primitives.hpp"
#include "shaders/shared/path_types.h"
#include "shaders/shared/scene_types.h"

#include <embree3/rtcore.h>

#include <span>
#include <vector>

namespace glim {

class Embree {
public:
    explicit Embree(const Primitives& primitives);
    ~Embree();
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;

    struct Hit {
        std::uint32_t triangle;  // kNoPrimitive: none
        float t;
    };
    struct Closest {
        std::vector<Hit> hits;
        double seconds;
    };
    struct Shadow {
        std::vector<char> free;
        double seconds;
    };
    // rtcIntersect1 and rtcOccluded1 for each ray.
    Closest trace(std::span<const PathRay> rays) const;
    Shadow trace(std::span<const ShadowRay> rays) const;

    double buildSeconds() const { return buildSeconds_; }

private:
    RTCDevice device_;
    RTCScene scene_;
    double buildSeconds_ = 0.0;
};

}  // namespace glim
