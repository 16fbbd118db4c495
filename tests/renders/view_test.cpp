// --view and the thin lens.
#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace glim {
namespace {

Film view(const Scene& scene, Aov what)
{
    RenderSettings settings = squareSettings(32, 4);
    settings.aov = what;
    return renderScene(scene, settings);
}

TEST(ViewTest, ShowsWhatTheCameraSees)
{
    const Scene scene = mixedScene();
    const Film normal = view(scene, Aov::Normal), depth = view(scene, Aov::Depth), albedo = view(scene, Aov::Albedo);
    int partly = 0;
    for (std::size_t i = 0; i < normal.pixels.size(); ++i) {
        EXPECT_EQ(normal.pixels[i].mean, normal.pixels[i].normal);
        EXPECT_EQ(albedo.pixels[i].mean, albedo.pixels[i].albedo);
        const PixelMoments& pixel = depth.pixels[i];
        if (pixel.alpha == 1.0F) {
            EXPECT_GE(pixel.mean.r, pixel.depth);  // the mean, and the nearest
        } else if (pixel.alpha == 0.0F) {
            EXPECT_EQ(pixel.mean, glm::vec3(0.0F));
        } else {
            ++partly;
        }
        EXPECT_EQ(pixel.alpha, normal.pixels[i].alpha);
    }
    EXPECT_GT(partly, 0);
}

// A wall across the view, at depth 3.
TEST(ViewTest, DepthIsAlongTheViewAxis)
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-9, -9, 0), {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, builder.lambert(glm::vec3(0.5F)))
        .perspective({0, 0, 3}, {0, 0, 0}, 1.0F);
    for (const PixelMoments& pixel : view(builder.scene(), Aov::Depth).pixels) {
        EXPECT_NEAR(pixel.mean.g, 3.0F, 1e-6F);
    }
}

TEST(ViewTest, BvhStepsCountsNodesAndPrimitives)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.5F))).perspective({0, 0, 5}, {0, 0, 0}, 0.2F);
    for (const PixelMoments& pixel : view(builder.scene(), Aov::BvhSteps).pixels) {
        EXPECT_EQ(pixel.mean, glm::vec3(1.0F, 1.0F, 0.0F));
    }
    const Triangles triangles = icosphere(5);
    Scene mesh = makeTestScene(triangles);
    mesh.cameras = builder.scene().cameras;
    const MeanEstimate steps = meanOf(view(mesh, Aov::BvhSteps));
    std::printf("%zu triangles: %.1f nodes and %.1f primitives per camera ray\n", triangles.size(), steps.mean.r, steps.mean.g);
    EXPECT_GT(steps.mean.r, std::log2(static_cast<double>(triangles.size())) / 3.0 - 1.0);
    EXPECT_LT(steps.mean.r, 30.0);
}

// An emitting half plane, its edge across the middle of the picture, `depth` metres away.
Scene edgeAt(float depth)
{
    SceneBuilder builder;
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F));
    builder.quad({glm::vec3(0, -9, -depth), {9, -9, -depth}, {9, 9, -depth}, {0, 9, -depth}}, lamp)
        .perspective({0, 0, 0}, {0, 0, -1}, 0.5F);
    return builder.scene();
}

// Through a lens of radius r focused at f an edge at depth d is spread over r |d/f - 1| to both sides, measured at depth d.
TEST(LensTest, SpreadsAnEdgeByTheCircleOfConfusion)
{
    constexpr float kRadius = 0.05F, kFocus = 2.0F;
    constexpr std::uint32_t kSide = 128;
    for (const float depth : {1.0F, 2.0F, 4.0F}) {
        const Scene scene = edgeAt(depth);
        const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F, {kRadius, kFocus});
        RenderSettings settings = squareSettings(kSide, 64);
        Renderer renderer(testDevice(), flattened(scene), camera, settings);
        const Film film = renderer.render([](const RenderProgress&) { return true; });
        int partly = 0;
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const float seen = film.pixels[kSide / 2 * kSide + x].mean.g;
            partly += seen > 0.0F && seen < 1.0F ? 1 : 0;
            EXPECT_TRUE((x < kSide / 2) == (seen < 0.5F)) << x;
        }
        const float pixel = 2.0F * depth * std::tan(0.25F) / kSide;
        const float width = 2.0F * kRadius * std::abs(depth / kFocus - 1.0F) / pixel;
        std::printf("edge at %.0f m: spread over %d pixels, by geometry %.1f\n", static_cast<double>(depth), partly,
                    static_cast<double>(width));
        EXPECT_LE(partly, width + 2.0F);
        // The outermost pixels see less than 1 in 64 of the lens.
        EXPECT_GE(partly, 0.85F * width - 2.0F);
    }
}

TEST(LensTest, DoesNotChangeTheMeanOfAWall)
{
    SceneBuilder builder;
    builder
        .quad({glm::vec3(-90, -90, 0), {90, -90, 0}, {90, 90, 0}, {-90, 90, 0}},
              builder.lambert(glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 3.0F)))
        .perspective({0, 0, 3}, {0, 0, 0}, 1.0F);
    Renderer renderer(testDevice(), flattened(builder.scene()), flattenCamera(builder.scene().cameras.front(), 1.0F, {0.3F, 1.5F}),
                      squareSettings(16, 32));
    expectEverywhere(renderer.render([](const RenderProgress&) { return true; }), {1.0, 2.0, 3.0}, 1);
}

}  // namespace
}  // namespace glim
