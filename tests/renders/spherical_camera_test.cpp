// Cameras that see more than a plane shows, against six that each see a face of a cube.
#include "host/measure/confidence.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::dvec3;

constexpr std::size_t kMoments = 9;

// Spherical harmonics up to the second band, without their constants.
std::array<double, kMoments> momentsOf(const dvec3& w)
{
    return {1.0, w.x, w.y, w.z, w.x * w.y, w.y * w.z, w.z * w.x, w.x * w.x - w.y * w.y, 3.0 * w.z * w.z - 1.0};
}

using Sums = std::array<double, kMoments>;

// Adds the light of a film, by the direction that its pixels show and the solid angle of each.
template <class Direction>
void addFilm(const Film& film, const Direction& directionOf, Sums& sums)
{
    constexpr double kStep = 1e-4;
    for (std::uint32_t y = 0; y < film.height; ++y) {
        for (std::uint32_t x = 0; x < film.width; ++x) {
            const double u = (x + 0.5) / film.width, v = (y + 0.5) / film.height;
            const dvec3 du = (directionOf(u + kStep, v) - directionOf(u - kStep, v)) / (2.0 * kStep);
            const dvec3 dv = (directionOf(u, v + kStep) - directionOf(u, v - kStep)) / (2.0 * kStep);
            const double angle = glm::length(glm::cross(du, dv)) / static_cast<double>(film.pixels.size());
            const auto moments = momentsOf(directionOf(u, v));
            const double light = static_cast<double>(film.pixels[std::size_t{y} * film.width + x].mean.g);
            for (std::size_t k = 0; k < kMoments; ++k) {
                sums[k] += light * angle * moments[k];
            }
        }
    }
}

RenderSettings settingsOf(std::uint32_t width, std::uint32_t height, std::uint32_t seed)
{
    RenderSettings settings = squareSettings(height, samplesFor(4));
    settings.width = width;
    settings.seed = seed;
    settings.schedule = Schedule::Persistent;
    settings.caustics = false;
    return settings;
}

dvec3 equirectangular(double u, double v)
{
    const double longitude = 2.0 * std::numbers::pi * (u - 0.5), latitude = std::numbers::pi * (0.5 - v);
    return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), -std::cos(latitude) * std::cos(longitude)};
}

// An equidistant fisheye whose circle of 180 degrees touches the picture; its corners see nothing.
dvec3 fisheye(double u, double v)
{
    const double x = 2.0 * u - 1.0, y = 1.0 - 2.0 * v, r = std::hypot(x, y), angle = std::numbers::pi * std::min(r, 1.0);
    const double ratio = r > 0.0 ? std::sin(angle) / r : std::numbers::pi;
    return {x * ratio, y * ratio, -std::cos(angle)};
}

Sums sumAll(const Scene& scene, Camera camera, const Projection& projection, std::uint32_t seed)
{
    camera.projection = projection;
    Sums sums{};
    if (projection.model == Projection::Model::Equirectangular) {
        addFilm(renderFlat(flattened(scene), camera, settingsOf(256, 128, seed)), equirectangular, sums);
    } else {
        addFilm(renderFlat(flattened(scene), camera, settingsOf(192, 192, seed)), fisheye, sums);
    }
    return sums;
}

Sums sumCube(const Scene& scene, Camera camera, std::uint32_t seed)
{
    constexpr std::uint32_t kSide = 80;
    const std::array<std::array<dvec3, 2>, 6> faces{{{dvec3(1, 0, 0), dvec3(0, 1, 0)},
                                                     {dvec3(-1, 0, 0), dvec3(0, 1, 0)},
                                                     {dvec3(0, 0, 1), dvec3(0, 1, 0)},
                                                     {dvec3(0, 0, -1), dvec3(0, 1, 0)},
                                                     {dvec3(0, 1, 0), dvec3(0, 0, 1)},
                                                     {dvec3(0, -1, 0), dvec3(0, 0, 1)}}};
    const FlatScene flat = flattened(scene);
    camera.yfov = static_cast<float>(0.5 * std::numbers::pi);
    Sums sums{};
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const auto& [forward, up] = faces[i];
        const dvec3 right = glm::cross(forward, up);
        camera.forward = forward;
        camera.up = up;
        camera.right = right;
        addFilm(
            renderFlat(flat, camera, settingsOf(kSide, kSide, 100 + 6 * seed + i)),
            [&, &forward = forward, &up = up](double u, double v) {
                return glm::normalize(forward + (2.0 * u - 1.0) * right + (1.0 - 2.0 * v) * up);
            },
            sums);
    }
    return sums;
}

struct Estimate {
    double mean = 0.0, variance = 0.0;  // of the mean
};

Estimate estimate(const std::vector<Sums>& runs, std::size_t k)
{
    Estimate e;
    const auto count = static_cast<double>(runs.size());
    for (const Sums& run : runs) {
        e.mean += run[k] / count;
    }
    for (const Sums& run : runs) {
        e.variance += (run[k] - e.mean) * (run[k] - e.mean) / (count * (count - 1.0));
    }
    return e;
}

TEST(SphericalCameraTest, TheLightOfAllDirectionsIsThatOfACube)
{
    const Scene scene = mixedScene();
    Camera camera;
    camera.position = {0.1F, 0.2F, 0.3F};
    constexpr std::uint32_t kRuns = 12;
    const Intrinsics circle{glm::dvec2(96.0 / std::numbers::pi), glm::dvec2(96.0), glm::dvec2(192.0)};
    std::vector<Sums> cube, all, round;
    for (std::uint32_t seed = 0; seed < kRuns; ++seed) {
        cube.push_back(sumCube(scene, camera, seed));
        all.push_back(sumAll(scene, camera, {Projection::Model::Equirectangular, std::nullopt, {}, {}}, seed));
        round.push_back(sumAll(scene, camera, {Projection::Model::Fisheye, circle, {}, {}}, seed));
    }
    const double limit = studentLimit(sidakLevel(1e-3, 2 * kMoments), kRuns - 1);
    for (const auto* runs : {&all, &round}) {
        for (std::size_t k = 0; k < kMoments; ++k) {
            const Estimate a = estimate(*runs, k), b = estimate(cube, k);
            const double error = std::sqrt(a.variance + b.variance);
            EXPECT_LE(std::abs(a.mean - b.mean), limit * error) << (runs == &all ? "equirectangular " : "fisheye ") << k;
            EXPECT_LT(error, 0.02 * std::abs(estimate(cube, 0).mean)) << k;  // or the test would see nothing
            std::printf("  %zu: %.5f and %.5f of the cube, t = %.2f of %.2f\n", k, a.mean, b.mean, (a.mean - b.mean) / error, limit);
        }
    }
}

// What lies beyond a lens's field of view is black and transparent, whatever there is to see.
TEST(SphericalCameraTest, BeyondTheFieldOfViewThereIsNothing)
{
    SceneBuilder builder;
    builder.environment(glm::vec3(3.0F))
        .cube(5.0F, builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F)), true)
        .perspective({0, 0, 2}, {0, 0, 0}, 0.8F);
    const Scene scene = builder.scene();
    Camera camera = scene.cameras.front();
    camera.projection = {Projection::Model::RadialTangential, Intrinsics{glm::dvec2(20.0), glm::dvec2(24.0), glm::dvec2(48.0)}, {}, {-0.3}};
    const Film film = renderFlat(flattened(scene), camera, squareSettings(48, 16));
    const double end = std::sqrt(1.0 / 0.9) * (1.0 - 0.3 / 0.9) * 20.0;  // pixels
    std::size_t beyond = 0;
    for (std::uint32_t y = 0; y < 48; ++y) {
        for (std::uint32_t x = 0; x < 48; ++x) {
            const double distance = std::hypot(x + 0.5 - 24.0, y + 0.5 - 24.0);
            const PixelMoments& pixel = film.pixels[48 * y + x];
            if (distance > end + 0.8) {
                ++beyond;
                EXPECT_TRUE(pixel.mean == glm::vec3(0.0F) && pixel.alpha == 0.0F && std::isinf(pixel.depth)) << x << ", " << y;
            } else if (distance < end - 0.8) {
                EXPECT_TRUE(pixel.mean.r > 1.0F && pixel.alpha == 1.0F) << x << ", " << y;
            }
        }
    }
    EXPECT_GT(beyond, 1000U);
}

}  // namespace
}  // namespace glim
