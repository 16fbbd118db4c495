// What a guide knows at one point, as a map of all directions: for windows. The kernel probe_guide evaluates it as paths do.
#pragma once

#include "host/gpu/commands.hpp"
#include "shaders/shared/guide_probe_types.h"
#include "shaders/shared/scene_types.h"

#include <span>
#include <vector>

namespace glim {

// The directions lie as in a picture of `--projection equirectangular`: the camera's axis is in the middle, its right to the right.
struct GuideMap {
    static constexpr int kColumns = 64, kRows = 32;
    struct Cell {
        float density = 0.0F;  // mean; 1: that of uniform directions
        bool isBelow = false;  // at least a part, the surface
    };
    float share = 0.0F;       // of directions that are sampled by the guide; 0: it knows nothing there
    std::vector<Cell> cells;  // row by row from the top

    float highestDensity() const;
};

class GuideProbe {
public:
    explicit GuideProbe(Device& device);

    // Answers what is asked of the guide with these texels.
    std::vector<ProbedDirection> ask(const Buffer& guide, const vec3& point, const vec3& normal, std::span<const vec3> directions) const;
    GuideMap map(const Buffer& guide, const vec3& point, const vec3& normal, const FlatCamera& camera) const;

private:
    Device& device_;
    KernelLayout layout_;
    Kernel kernel_;
};

}  // namespace glim
