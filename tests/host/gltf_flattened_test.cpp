// Nodes that are scaled to a plane, a line or a point: what has a size is left out, with one warning; what has a direction stays.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/render/prepare_scene.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::test {
namespace {

using nlohmann::json;

TEST(GltfFlattened, MeshesAndSpheresAreLeftOutAndCounted)
{
    GltfBuilder builder = oneTriangle();
    builder.addNode({{"name", "hidden"}, {"mesh", 0}, {"scale", {0, 0, 0}}});
    builder.addNode({{"name", "sheet"}, {"mesh", 0}, {"scale", {1, 0, 1}}});
    builder.addNode({{"name", "ball"}, {"scale", {0, 0, 0}}, {"extras", {{"sphere", {{"radius", 1}}}}}});
    builder.addNode({{"mesh", 0}, {"matrix", {1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
    const std::size_t child = builder.append("nodes", {{"mesh", 0}});
    builder.addNode({{"scale", {0, 0, 0}}, {"children", {child}}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.instances.size(), 1U);
    EXPECT_EQ(scene.spheres.size(), 0U);
    EXPECT_EQ(scene.flattened, 5U);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::FlattenedNode).place,
              "nodes[1] (\"hidden\"), nodes[2] (\"sheet\"), nodes[3] (\"ball\") and 2 more");
}

TEST(GltfFlattened, InstancesOfANodeAreLeftOutOneByOne)
{
    GltfBuilder builder = oneTriangle();
    const std::size_t scales = builder.addVec3({1, 1, 1, 0, 0, 0, 2, 2, 2, 1, 1, 0});
    builder.addNode({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"SCALE", scales}}}}}}}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.instances.size(), 3U);
    EXPECT_EQ(scene.flattened, 2U);
}

TEST(GltfFlattened, ASceneOfNothingElseIsEmptyAndFramed)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}, {"scale", {0, 0, 0}}});
    const Scene scene = load(builder);
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_EQ(scene.cameras.at(0).name, "framed");
    const WideBvh bvh = buildSceneBvh(makePrimitives(scene));
    EXPECT_EQ(bvh.box.lo, glm::vec3(0.0F));
    EXPECT_EQ(bvh.box.hi, glm::vec3(0.0F));
}

TEST(GltfFlattened, AnAnimationMayPassThroughZero)
{
    GltfBuilder builder = oneTriangle();
    const std::size_t input = builder.addAccessor(toBytes(std::vector<float>{0, 1}), kFloat, "SCALAR", 2);
    const std::size_t output = builder.addVec3({1, 1, 1, -1, -1, -1});
    builder.append("animations", {{"samplers", {{{"input", input}, {"output", output}}}},
                                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
    LoadOptions options;
    for (const auto& [seconds, instances] : {std::pair(0.0, 1U), {0.5, 0U}, {1.0, 1U}}) {
        options.at = seconds;
        const Scene scene = load(builder, options);
        EXPECT_EQ(scene.instances.size(), instances) << seconds;
        EXPECT_EQ(hasWarning(scene.warnings, MessageId::FlattenedNode), instances == 0U) << seconds;
    }
}

// A quarter turn about y takes -z to -x.
TEST(GltfFlattened, CamerasAndLightsKeepTheirDirection)
{
    GltfBuilder builder = oneTriangle();
    builder.document["cameras"] = json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}});
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "directional"}}});
    const double half = std::sqrt(0.5);
    const json content = {{"camera", 0}, {"translation", {1, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
    const std::size_t child = builder.append("nodes", content);
    builder.addNode({{"scale", {0, 0, 0}}, {"rotation", {0, half, 0, half}}, {"translation", {0, 0, 5}}, {"children", {child}}});
    const Scene scene = load(builder);
    EXPECT_LT(glm::length(scene.cameras.at(0).forward - glm::vec3(-1, 0, 0)), 1e-6F);
    EXPECT_LT(glm::length(scene.lights.at(0).direction - glm::vec3(-1, 0, 0)), 1e-6F);
    EXPECT_LT(glm::length(glm::dvec3(scene.cameras.at(0).position) + scene.origin - glm::dvec3(0, 0, 5)), 1e-6);
}

TEST(GltfSize, HugeScenesAreRefusedAndTinyOnesSaid)
{
    const auto scaled = [](double scale) {
        GltfBuilder builder;
        builder.addNode({{"mesh", builder.addTriangleMesh()}, {"scale", {scale, scale, scale}}});
        return builder;
    };
    expectRefused(scaled(1e20), MessageId::TooLarge, {.value = "1e+20", .expected = "1e+18"});
    expectRefused(scaled(1e100), MessageId::TooLarge, {.value = "1e+100"});
    EXPECT_EQ(findWarning(load(scaled(1e-16)).warnings, MessageId::TinyScene).value, "1e-16");
    for (const double scale : {1e-12, 1.0, 1e18}) {
        EXPECT_FALSE(hasWarning(load(scaled(scale)).warnings, MessageId::TinyScene)) << scale;
    }
}

TEST(GltfSize, CamerasBeyondSixteenToOneAreSaidAndBounded)
{
    GltfBuilder builder = oneTriangle();
    for (const double ratio : {16.0, 1e30, 1e-30}) {
        const std::size_t camera =
            builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", ratio}}}});
        builder.addNode({{"camera", camera}});
    }
    const Scene scene = load(builder);
    EXPECT_EQ(defaultSize(Camera()), glm::uvec2(910, 512)) << "16:9 without an aspect ratio";
    EXPECT_EQ(defaultSize(scene.cameras.at(0)), glm::uvec2(8192, 512));
    EXPECT_EQ(defaultSize(scene.cameras.at(1)), glm::uvec2(8192, 512));
    EXPECT_EQ(defaultSize(scene.cameras.at(2)), glm::uvec2(32, 512));
    EXPECT_EQ(findWarning(scene.warnings, MessageId::ExtremeAspectRatio).place, "nodes[2] 1e+30, nodes[3] 1e-30");
}

}  // namespace
}  // namespace glim::test
