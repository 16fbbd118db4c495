// --accelerator, --split, --intersector: the same picture, by bits or by means.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "shaders/shared/limits.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

// A mesh of more triangles than one dispatch of brute force tries, under a lamp and a sky; a loose shell around it throws shadows
// from everywhere in the list of references.
Scene meshScene()
{
    SceneBuilder builder;
    builder.lambert(glm::vec3(0.6F, 0.5F, 0.4F));
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(4.0F));
    builder.sphere({0.0F, 2.2F, 0.5F}, 0.4F, lamp).environment(glm::vec3(0.1F, 0.2F, 0.3F)).perspective({0, 1, 4}, {0, 0, 0}, 0.7F);
    Scene scene = builder.scene();
    const Triangles ball = icosphere(5);
    Triangles mesh = ball;
    for (std::size_t i = 0; i < ball.size(); i += 4) {
        const Triangle& t = ball[i];
        mesh.push_back({{1.3F * t.vertices[0], 1.3F * t.vertices[1], 1.3F * t.vertices[2]}});
    }
    addMesh(scene, mesh);
    return scene;
}

// A floor seen from exactly 4 metres above, with tiles in its plane. Tiles in even fields come before the floor in the scene,
// those in odd fields after it. Every ray meets two primitives at the same distance; which one it meets first depends on the
// tree.
Scene tiledScene()
{
    SceneBuilder builder;
    const auto tile = builder.lambert(glm::vec3(0.8F)), floor = builder.lambert(glm::vec3(0.2F));
    const auto quad = [&](const glm::vec2& low, float size, std::uint32_t material) {
        builder.quad(
            {glm::vec3(low, 0.0F), glm::vec3(low.x + size, low.y, 0.0F), glm::vec3(low + size, 0.0F), glm::vec3(low.x, low.y + size, 0.0F)},
            material);
    };
    const auto tiles = [&](int parity) {
        for (int i = 0; i < 64; ++i) {
            if ((i % 8 + i / 8) % 2 == parity) {
                quad({0.25F * static_cast<float>(i % 8) - 1.0F, 0.25F * static_cast<float>(i / 8) - 1.0F}, 0.25F, tile);
            }
        }
    };
    tiles(0);
    quad({-1.0F, -1.0F}, 2.0F, floor);
    tiles(1);
    builder.environment(glm::vec3(1.0F)).orthographic({0, 0, 4}, {0, 0, 0}, 1.0F);
    return builder.scene();
}

// Strips, some of which emit, aslant through a ball of small triangles. The strips are split into pieces and have many references.
Scene aslantScene()
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F)), lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(3.0F), true);
    builder.sphere({1.0F, -0.2F, 1.5F}, 0.3F, white).sphere({-1.2F, 0.8F, 1.5F}, 0.1F, lamp);
    for (int i = 0; i < 12; ++i) {
        const float x = 0.3F * static_cast<float>(i) - 1.65F;
        builder.quad({glm::vec3(x, -1.7F, -1.6F), {x + 0.02F, -1.7F, -1.6F}, {x + 0.52F, 1.6F, 1.7F}, {x + 0.5F, 1.6F, 1.7F}},
                     i % 3 == 0 ? lamp : white);
    }
    builder.environment(glm::vec3(0.05F)).perspective({0, 1, 4}, {0, 0, 0}, 0.7F);
    Scene scene = builder.scene();
    addMesh(scene, icosphere(3), white);
    return scene;
}

class AcceleratorTest : public testing::TestWithParam<test::Named<DirectLight>> {
protected:
    AcceleratorTest()
    {
        settings.bounces = 3;
        settings.course.direct = GetParam().value;
        settings.course.lightSamples = 2;
        settings.caustics = false;  // the course has none
    }
    RenderSettings settings = squareSettings(12, 4);
};

TEST_P(AcceleratorTest, NoneGivesTheBitsOfTheTree)
{
    for (const Scene& scene : {meshScene(), mixedScene(), tiledScene(), aslantScene()}) {
        settings.course.accelerator = Accelerator::Bvh;
        const Film tree = renderScene(scene, settings);
        settings.course.accelerator = Accelerator::None;
        EXPECT_TRUE(sameBits(tree, renderScene(scene, settings))) << scene.instances.size() << " instances";
    }
    EXPECT_GT(makePrimitives(meshScene()).count(), 2 * kScanPrimitiveRefs);
}

INSTANTIATE_TEST_SUITE_P(Ways, AcceleratorTest,
                         testing::Values(test::Named{"mis", DirectLight::Mis}, test::Named{"lights", DirectLight::Lights},
                                         test::Named{"hemisphere", DirectLight::Hemisphere}, test::Named{"bsdf", DirectLight::Bsdf}),
                         test::nameOfParameter);

TEST(SplitRulePictureTest, EveryRuleGivesTheBitsOfTheOthers)
{
    RenderSettings settings = squareSettings(24, 32);
    for (const Scene& scene : {meshScene(), mixedScene(), tiledScene(), aslantScene()}) {
        const FlatScene sah = flattened(scene);
        settings.schedule = Schedule::Auto;
        const Film film = renderFlat(sah, scene.cameras.front(), settings);
        for (const auto& [rule, schedule] :
             {std::pair(SplitRule::Mean, Schedule::Wavefront), std::pair(SplitRule::Median, Schedule::Persistent)}) {
            const FlatScene other = flattened(scene, rule);
            settings.schedule = schedule;
            EXPECT_NE(other.nodes, sah.nodes);
            // Their films may be merged.
            EXPECT_EQ(fingerprint(other), fingerprint(sah));
            EXPECT_TRUE(sameBits(renderFlat(other, scene.cameras.front(), settings), film))
                << scene.instances.size() << " instances, rule " << static_cast<int>(rule);
        }
    }
}

// Films are merged and resumed by their fingerprint, films of earlier builds too.
TEST(FingerprintTest, HasTheValueOfEarlierBuilds)
{
    Scene scene = mixedScene();
    const std::uint64_t culled = fingerprint(flattened(scene));
    scene.showsBackFaces = true;  // as earlier builds did
    EXPECT_EQ(fingerprint(flattened(scene)), 0x4e064192d3cc34d4U);
    EXPECT_NE(culled, 0x4e064192d3cc34d4U);
}

TEST(SplitRulePictureTest, OnlyTheHeuristicsTreeIsOfPieces)
{
    const Scene scene = aslantScene();
    const Primitives primitives = makePrimitives(scene);
    EXPECT_GT(buildSceneBvh(primitives).order.size(), primitives.count() + 10);
    EXPECT_EQ(buildSceneBvh(primitives, SplitRule::Mean).order.size(), primitives.count());
    EXPECT_EQ(buildSceneBvh(primitives, SplitRule::Median).order.size(), primitives.count());
}

TEST(SplitRulePictureTest, TiesGoToTheLowerId)
{
    const Scene scene = tiledScene();
    RenderSettings settings = squareSettings(8, 4);
    settings.bounces = 0;
    for (const SplitRule rule : {SplitRule::Sah, SplitRule::Mean, SplitRule::Median}) {
        const Film film = renderFlat(flattened(scene, rule), scene.cameras.front(), settings);
        for (int i = 0; i < 64; ++i) {
            // Rows of the film go down, those of the tiles up: of eight, parity changes.
            EXPECT_FLOAT_EQ(film.pixels[static_cast<std::size_t>(i)].albedo.r, (i % 8 + i / 8) % 2 == 1 ? 0.8F : 0.2F)
                << i << ", rule " << static_cast<int>(rule);
        }
    }
}

// The textbook test leaks at edges and rounds otherwise: other bits, the same picture.
TEST(IntersectorTest, MollerTrumboreAgreesInTheMean)
{
    RenderSettings settings = squareSettings(32, 256);
    settings.sampler = Sampler::Independent;
    settings.bounces = 3;
    const Film watertight = renderScene(meshScene(), settings);
    settings.course.intersector = Intersector::MollerTrumbore;
    EXPECT_FALSE(sameBits(watertight, renderScene(meshScene(), settings)));
    settings.seed = 1;
    expectSameMean("moller-trumbore", renderScene(meshScene(), settings), watertight);
}

// Timestamps show that brute force tries every reference: as many dispatches of trace_closest per bounce as there are portions.
TEST(AcceleratorDispatchTest, NoneScansEveryPrimitiveRef)
{
    const Scene scene = meshScene();
    const FlatScene flat = flattened(scene);
    RenderSettings settings = squareSettings(4, 1);
    settings.bounces = 0;
    settings.course.accelerator = Accelerator::None;
    Renderer renderer(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
    renderer.render([](const RenderProgress&) { return true; });
    const auto portions = (flat.primitiveRefs.size() / kPrimitiveRefTexels + kScanPrimitiveRefs - 1) / kScanPrimitiveRefs;
    EXPECT_EQ(portions, 4U);
    EXPECT_EQ(renderer.statistics().kernels.at("course_trace_closest").dispatches, portions);
}

}  // namespace
}  // namespace glim
