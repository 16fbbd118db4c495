// Work that does not depend on the machine: what a change of the tree, of the kernels or of their order costs, without a clock.
#include "host/bench/make_hills.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/support/bench_scenes.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_device.hpp"

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
    settings.view = View::BvhSteps;
    settings.bounces = 0;
    return meanOf(renderFlat(flat, camera, settings)).mean;
}

// Both ways: whoever makes it better writes down how much.
TEST(CountersTest, ACameraRayVisitsAsManyNodesAsRecorded)
{
    for (const Counted& counted : {Counted{"ball in a box", bumpyBall(5), 11.24, 6.34, 14.18}, Counted{"hills", makeHills(200), 8.50, 3.80, 8.24},
                                   Counted{"forest", forest(60), 11.28, 2.67, 6.69}}) {
        const WideBvh bvh = buildSceneBvh(counted.scene);
        const glm::dvec3 steps = meanSteps(flattenScene(counted.scene, bvh), counted.scene.cameras.front());
        std::cout << counted.name << ": " << counted.scene.triangles.size() << " triangles, cost " << bvh.cost << ", " << steps.x
                  << " nodes and " << steps.y << " triangles a ray\n";
        EXPECT_NEAR(steps.x, counted.nodes, 0.03 * counted.nodes) << counted.name;
        EXPECT_NEAR(steps.y, counted.primitives, 0.03 * counted.primitives) << counted.name;
        EXPECT_NEAR(bvh.cost, counted.cost, 0.03 * counted.cost) << counted.name;
    }
}

TEST(CountersTest, ATriangleTakesAtMost130Bytes)
{
    for (Scene scene : {bumpyBall(5), makeHills(200), forest(60)}) {
        scene.primitives.back().smooth = true;
        scene.normals.resize(scene.triangles.size(), {{glm::vec3(0, 1, 0), glm::vec3(0, 1, 0), glm::vec3(0, 1, 0)}});
        const double bytes = static_cast<double>(sizeInBytes(flattened(scene))) / static_cast<double>(scene.triangles.size());
        std::cout << scene.triangles.size() << " triangles: " << bytes << " bytes each\n";
        EXPECT_LT(bytes, 130.0);
    }
}

// At every hit trace_closest, sample_lights, trace_shadow and bounce, and what sizes the shadow rays and the next rays; generate_rays and
// accumulate once, which also ends the last block. 16 samples come in passes of 1, 1, 2, 4 and 8 while nothing is known of their time.
TEST(CountersTest, APassTakesSixDispatchesABounce)
{
    const Scene scene = makeHills(10);
    const FlatScene flat = flattened(scene);
    for (const std::uint32_t bounces : {0U, 1U, 5U}) {
        RenderSettings settings = squareSettings(32, 16);
        settings.bounces = bounces;
        settings.roulette = Roulette::None;
        Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
        renderer.render([](const RenderProgress&) { return true; });
        std::uint64_t dispatches = 0;
        for (const auto& [kernel, statistics] : renderer.statistics().kernels) {
            dispatches += statistics.dispatches;
        }
        const std::uint64_t passes = renderer.statistics().kernels.at("generate_rays").dispatches;
        std::cout << bounces << " bounces: " << dispatches << " dispatches in " << passes << " passes\n";
        EXPECT_LE(passes, 5U);
        EXPECT_LE(dispatches, passes * (2U + 6U * (bounces + 1U)) + 1U);
    }
}

}  // namespace
}  // namespace glim
