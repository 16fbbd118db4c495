// Work that does not depend on the machine: what a change of the tree, the kernels or their order costs, counted without a clock.
#include "host/bench/make_hills.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/bench_scenes.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace glim {
namespace {

struct Counted {
    const char* name;
    Scene scene;
    double nodes, primitives;  // visited and tested by a camera ray, as measured when they were last changed on purpose
    double cost;               // of the tree
};

glm::dvec3 meanSteps(const FlatScene& flat, const Camera& camera)
{
    RenderSettings settings = squareSettings(128, 1);
    settings.aov = Aov::BvhSteps;
    settings.bounces = 0;
    return meanOf(renderFlat(flat, camera, settings)).mean;
}

// Better counts fail too: whoever improves them writes the new ones down.
TEST(CountersTest, ACameraRayVisitsAsManyNodesAsRecorded)
{
    for (const Counted& counted : {Counted{"ball in a box", bumpyBall(5), 11.24, 6.34, 14.18},
                                   Counted{"hills", makeHills(200), 8.50, 3.80, 8.24}, Counted{"forest", forest(60), 11.28, 2.67, 6.69}}) {
        const Primitives primitives = makePrimitives(counted.scene);
        const WideBvh bvh = buildSceneBvh(primitives);
        const glm::dvec3 steps = meanSteps(flattenScene(counted.scene, primitives, bvh), counted.scene.cameras.front());
        std::cout << counted.name << ": " << primitives.triangles.size() << " triangles, cost " << bvh.cost << ", " << steps.x
                  << " nodes and " << steps.y << " triangles a ray\n";
        EXPECT_NEAR(steps.x, counted.nodes, 0.03 * counted.nodes) << counted.name;
        EXPECT_NEAR(steps.y, counted.primitives, 0.03 * counted.primitives) << counted.name;
        EXPECT_NEAR(bvh.cost, counted.cost, 0.03 * counted.cost) << counted.name;
    }
}

double bytesPerTriangle(const Scene& scene)
{
    const double count = static_cast<double>(makePrimitives(scene).triangles.size());
    const double bytes = static_cast<double>(sizeInBytes(flattened(scene))) / count;
    std::cout << count << " triangles: " << bytes << " bytes each\n";
    return bytes;
}

// With vertex normals, each another one: those of the hills are shared by their triangles, those of the others belong to one corner each.
TEST(CountersTest, BytesOfASmoothTriangle)
{
    for (const auto& [scene, limit] : {std::pair{makeHills(200), 85.0}, {bumpyBall(5), 126.0}, {forest(60), 126.0}}) {
        Scene smooth = scene;
        Mesh& mesh = smooth.meshes.change().back();
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            mesh.normals.emplace_back(1.0, static_cast<double>(i), 0.0);
        }
        EXPECT_LT(bytesPerTriangle(smooth), limit);
    }
}

// At every hit trace_closest, shade_surface and, but for the last, which samples no lights, trace_shadow; generate_rays and accumulate
// once, which also ends the last block. 16 samples come in passes of 1, 1, 2, 4 and 8
// while nothing is known of their time.
TEST(CountersTest, APassTakesThreeDispatchesABounce)
{
    const Scene scene = makeHills(10);
    const FlatScene flat = flattened(scene);
    for (const std::uint32_t bounces : {0U, 1U, 5U}) {
        RenderSettings settings = squareSettings(32, 16);
        settings.bounces = bounces;
        Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
        renderer.render([](const RenderProgress&) { return true; });
        std::uint64_t dispatches = 0;
        for (const auto& [kernel, statistics] : renderer.statistics().kernels) {
            dispatches += statistics.dispatches;
        }
        const std::uint64_t passes = renderer.statistics().kernels.at("generate_rays").dispatches;
        std::cout << bounces << " bounces: " << dispatches << " dispatches in " << passes << " passes\n";
        EXPECT_LE(passes, 5U);
        EXPECT_LE(dispatches, passes * (2U + 3U * bounces + 2U) + 1U);
    }
}

}  // namespace
}  // namespace glim
