#include "host/scene/make_studio.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

// u = .5 is -z and u = .75 is +x (shaders/lib/lat_long.glsl).
TEST(MakeStudio, TheKeyLightIsAboveTheViewerToTheLeft)
{
    const RadianceMap map = makeStudio();
    glm::dvec3 key(0.0);
    double front = 0.0, back = 0.0;
    const auto darker = [](const glm::vec3& a, const glm::vec3& b) { return a.x < b.x; };
    const auto most = static_cast<double>(std::max_element(map.texels.begin(), map.texels.end(), darker)->x);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const double elevation = std::numbers::pi * (0.5 - (y + 0.5) / map.height);
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double phi = 2.0 * std::numbers::pi * ((x + 0.5) / map.width - 0.5);
            const glm::dvec3 d(std::cos(elevation) * std::sin(phi), std::sin(elevation), -std::cos(elevation) * std::cos(phi));
            const auto radiance = static_cast<double>(map.texels[std::size_t{y} * map.width + x].x);
            key += radiance > 0.7 * most ? std::cos(elevation) * d : glm::dvec3(0.0);
            (d.z > 0.0 ? front : back) += radiance * std::cos(elevation);
        }
    }
    // A camera that looks along -z, as glTF's models expect it, has the key light behind it.
    key = glm::normalize(key);
    EXPECT_LT(key.x, -0.3);
    EXPECT_GT(key.y, 0.4);
    EXPECT_GT(key.z, 0.3);
    EXPECT_GT(front, back);
}

}  // namespace
}  // namespace glim
