// Pictures of one scene whose lights are times powers of two: the stated error is the same part of the radiance, or unknown, and never
// less.
#include "host/flatten/flatten_scene.hpp"
#include "host/job/film_report.hpp"
#include "host/measure/error_estimate.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 16;

// A floor under a lamp and a point light, in a box that is open.
Scene roomOf(float radiance)
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F)), lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(radiance));
    builder.quad({glm::vec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, white)
        .quad({glm::vec3(-1, 0, -1), {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}}, white)
        .quad({glm::vec3(-0.2F, 1.5F, -0.2F), {0.2F, 1.5F, -0.2F}, {0.2F, 1.5F, 0.2F}, {-0.2F, 1.5F, 0.2F}}, lamp)
        .perspective({0.0F, 0.7F, 2.0F}, {0.0F, 0.5F, 0.0F}, 0.8F);
    return builder.scene();
}

TEST(RadianceRangeTest, TheStatedErrorIsTheSameAtEveryRadianceOrUnknown)
{
    const RenderSettings settings = squareSettings(kSide, 64);
    const Scene first = roomOf(1.0F);
    const FlatCamera camera = flattenCamera(first.cameras.front(), 1.0F);
    Renderer renderer(testDevice(), flattened(first), camera, settings);
    const auto render = [&](int exponent) {
        renderer.restart(flattened(roomOf(std::exp2(static_cast<float>(exponent)))), camera, kSide, kSide);
        return renderer.render([](const RenderProgress&) { return true; });
    };
    const ErrorEstimate once = *estimateError(render(0));
    const double root = relativeRoot(once.mse.value, once.mean);
    EXPECT_GT(root, 0.01) << "a picture with noise";
    int known = 0;
    std::vector<int> exponents(23);
    std::generate(exponents.begin(), exponents.end(), [at = -110]() mutable { return at += 10; });
    exponents.push_back(126);
    for (const int exponent : exponents) {
        const Film film = render(exponent);
        const auto estimate = estimateError(film);
        if (!estimate) {
            std::printf("  2^%d: unknown, %s\n", exponent, whyUnknown(film).c_str());
            continue;
        }
        ++known;
        std::printf("  2^%d: RMSE %.4f %% [%.4f, %.4f]\n", exponent, 100.0 * relativeRoot(estimate->mse.value, estimate->mean),
                    100.0 * relativeRoot(estimate->mse.low, estimate->mean), 100.0 * relativeRoot(estimate->mse.high, estimate->mean));
        EXPECT_NEAR(relativeRoot(estimate->mse.value, estimate->mean), root, 1e-3 * root) << exponent;
        EXPECT_NEAR(estimate->mse.low / estimate->mse.value, once.mse.low / once.mse.value, 1e-3) << exponent;
        EXPECT_NEAR(estimate->mse.high / estimate->mse.value, once.mse.high / once.mse.value, 1e-3) << exponent;
        EXPECT_NEAR(estimate->relMse.value, once.relMse.value, 2e-3 * once.relMse.value) << exponent;
        EXPECT_NEAR(estimate->relMse.low / estimate->relMse.value, once.relMse.low / once.relMse.value, 1e-3) << exponent;
        EXPECT_NEAR(estimate->relMse.high / estimate->relMse.value, once.relMse.high / once.relMse.value, 1e-3) << exponent;
    }
    EXPECT_GE(known, 9) << "from 2^-40 to 2^40 at least";
}

}  // namespace
}  // namespace glim
