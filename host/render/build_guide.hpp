// Makes a guide of what paths have written down.
#pragma once

#include "host/render/guide.hpp"
#include "shaders/shared/guide_types.h"

#include <array>
#include <span>

namespace glim {

// One that knows nothing: it guides no path. `scatterings`: it is for those in media, too.
Guide emptyGuide(bool scatterings = false);

// Of a guide's texels.
std::string digestOf(const std::vector<uvec4>& texels);

// What a record says of light. 24 bytes: there are millions.
struct GuidePoint {
    vec3 p;
    std::uint32_t direction;  // as in GuideRecord
    float light;              // that the ray along it brought
    std::uint32_t direct;     // its light sample, as in GuideRecord
};

// The order of the records is part of what a guide depends on.
class GuideBuilder {
public:
    explicit GuideBuilder(bool scatterings = false)
        : scatterings_(scatterings)
    {}

    // Leaves out records without throughput, and those that are not finite.
    void add(std::span<const GuideRecord> records);
    // Of all records so far.
    Guide build();

private:
    bool scatterings_;
    std::array<std::vector<GuidePoint>, kGuideRoots> points_;
    std::vector<GuidePoint> scattered_;
};

}  // namespace glim
