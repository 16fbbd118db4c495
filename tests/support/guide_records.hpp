// What paths might have written down, for guides.
#pragma once

#include "host/render/build_guide.hpp"
#include "tests/harness/random.hpp"

#include <bit>
#include <cmath>
#include <vector>

namespace glim {

// As lib/octahedral.glsl.
inline std::uint32_t encodeDirection(const glm::dvec3& w)
{
    glm::dvec2 p = glm::dvec2(w.x, w.y) / (std::abs(w.x) + std::abs(w.y) + std::abs(w.z));
    if (w.z < 0.0) {
        p = (1.0 - glm::abs(glm::dvec2(p.y, p.x))) * glm::dvec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    }
    const auto bits = [](double x) { return static_cast<std::uint32_t>(std::lround(32767.0 * x)) & 0xffffU; };
    return bits(p.x) | bits(p.y) << 16U;
}

// As access/guide_records.glsl.
inline std::uint32_t packDirect(float luminance, std::uint32_t lights, bool arrived)
{
    return (std::bit_cast<std::uint32_t>(luminance) & ~(kSampledLights | kSampleBlocked)) | lights | (arrived ? 0U : kSampleBlocked);
}

// Points within a cube of 2 m, to which light comes from a ball of 10 cm beside it and, a tenth of it, from everywhere.
inline std::vector<GuideRecord> recordsOfBall(std::size_t count, Random& random)
{
    const glm::dvec3 ball(1.6, 0.3, -0.4);
    std::vector<GuideRecord> records;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 p = 2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0;
        const glm::dvec3 w = i % 10 == 0 ? random.direction() : glm::normalize(ball + 0.1 * random.direction() - p);
        records.push_back({vec3(p), 1.0F, encodeDirection(w), encodeDirection(random.direction()), 1.0F, 0});
    }
    return records;
}

inline Guide guideOf(std::span<const GuideRecord> records, bool scatterings = false)
{
    GuideBuilder builder(scatterings);
    builder.add(records);
    return builder.build();
}

}  // namespace glim
