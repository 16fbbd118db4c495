#include "host/scene/make_studio.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

using std::numbers::pi;

// A rectangle on the sphere with soft edges. Angles in degrees: azimuth from +z towards +x, elevation from the horizon.
struct Softbox {
    double azimuth, elevation, halfWidth, halfHeight;
    double radiance;
};

// A ball of 18 % grey has a mean radiance of .2 as the framed camera sees it. A white of .8 that faces the key light has
// 1.4, which the neutral tone holds; the framed camera sees none of the boxes directly.
constexpr Softbox kSoftboxes[] = {
    {-45.0, 42.0, 26.0, 22.0, 5.9},  // key
    {75.0, 20.0, 18.0, 30.0, 2.4},   // fill
    {130.0, 40.0, 24.0, 14.0, 3.7},  // rim, from behind
    {0.0, 88.0, 180.0, 18.0, 0.9},   // overhead
};

double smoothStep(double x)
{
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// 1 inside, 0 outside, over an edge of three degrees.
double inside(double distance, double half) { return smoothStep((half - std::abs(distance)) / 3.0 + 0.5); }

double radianceAt(double azimuth, double elevation)
{
    // The backdrop, which the framed camera sees, grows brighter up to the horizon; the floor below and the walls above are dark. So a
    // mirror differs from what is behind it.
    double radiance = 0.06 + 0.2 * smoothStep((elevation + 55.0) / 60.0) - 0.16 * smoothStep((elevation - 4.0) / 14.0) +
                      0.25 * smoothStep((elevation - 25.0) / 65.0);
    for (const Softbox& box : kSoftboxes) {
        const double across = std::remainder(azimuth - box.azimuth, 360.0) * std::cos(elevation * pi / 180.0);
        radiance +=
            box.radiance * inside(box.halfWidth >= 180.0 ? 0.0 : across, box.halfWidth) * inside(elevation - box.elevation, box.halfHeight);
    }
    return radiance;
}

}  // namespace

RadianceMap makeStudio()
{
    RadianceMap map;
    map.width = 1024;
    map.height = 512;
    map.texels.reserve(std::size_t{map.width} * map.height);
    for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double azimuth = 360.0 - 360.0 * (x + 0.5) / map.width;  // the middle of the map is -z, and +x to its right
            map.texels.emplace_back(static_cast<float>(radianceAt(azimuth, 90.0 - 180.0 * (y + 0.5) / map.height)));
        }
    }
    return map;
}

}  // namespace glim
