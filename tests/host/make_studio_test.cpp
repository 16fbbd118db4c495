#include "host/scene/make_studio.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

// u = .5 is -z and u = .75 is +x (shaders/lib/lat_long.glsl).
TEST(MakeStudio, TheKeyLightIsAboveTheViewerToTheLeft)
{
    const RadianceMap map = makeStudio();
    glm::dvec3 brightest(0.0);
    double most = 0.0, front = 0.0, back = 0.0;
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const double elevation = std::numbers::pi * (0.5 - (y + 0.5) / map.height);
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double phi = 2.0 * std::numbers::pi * ((x + 0.5) / map.width - 0.5);
            const glm::dvec3 d(std::cos(elevation) * std::sin(phi), std::sin(elevation), -std::cos(elevation) * std::cos(phi));
            const double radiance = map.texels[std::size_t{y} * map.width + x].x;
            brightest = radiance > most ? d : brightest;
            most = std::max(most, radiance);
            (d.z > 0.0 ? front : back) += radiance * std::cos(elevation);
        }
    }
    // A camera that looks along -z, as glTF's models expect it, has the key light behind it.
    EXPECT_LT(brightest.x, -0.3);
    EXPECT_GT(brightest.y, 0.4);
    EXPECT_GT(brightest.z, 0.3);
    EXPECT_GT(front, back);
}

}  // namespace
}  // namespace glim
