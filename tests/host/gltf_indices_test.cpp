// What the scene knows of the file's nodes, meshes and materials, for layers of ids.
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

namespace glim::test {
namespace {

using nlohmann::json;

TEST(GltfIndices, AreThoseOfTheFile)
{
    GltfBuilder builder;
    builder.addNode({{"name", "empty"}});
    builder.append("materials", {{"name", "unused"}});
    builder.append("materials", {{"name", "red"}});
    builder.addTriangleMesh();  // of no node
    const std::size_t mesh = builder.addTriangleMesh();
    json& primitives = builder.document["meshes"][mesh]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[1]["material"] = 1;
    builder.document["meshes"][mesh]["name"] = "pair";
    builder.addNode({{"mesh", mesh}});
    builder.addNode({{"mesh", mesh}, {"name", "again"}});
    builder.addNode({{"name", "ball"}, {"extras", {{"sphere", {{"radius", 1}, {"material", 1}}}}}});
    const Scene scene = load(builder);

    EXPECT_EQ(scene.nodeNames, (std::vector<std::string>{"empty", "", "again", "ball"}));
    ASSERT_EQ(scene.meshNames.size(), 2U);
    EXPECT_EQ(scene.meshNames[1], "pair");
    ASSERT_EQ(scene.instances.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(scene.instances[i].node, 1 + i / 2);
        EXPECT_EQ(scene.meshes[scene.instances[i].mesh].fileMesh, mesh);
        EXPECT_EQ(scene.meshes[scene.instances[i].mesh].material, i % 2 == 0 ? 2U : 1U);
    }
    EXPECT_EQ(scene.spheres.at(0).node, 3U);
    EXPECT_EQ(scene.materials.at(1).name, "red");
    EXPECT_EQ(scene.defaultMaterial, 2U);
}

TEST(GltfIndices, EveryMaterialMayBeTheFiles)
{
    GltfBuilder builder;
    builder.append("materials", {{"name", "red"}});
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.materials.size(), 1U);
    EXPECT_FALSE(scene.defaultMaterial);
}

TEST(GltfIndices, InstancesOfANodeAreTheNode)
{
    GltfBuilder builder;
    builder.addNode({{"name", "empty"}});
    json node = {{"mesh", builder.addTriangleMesh()}};
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", builder.addVec3({0, 0, 0, 5, 0, 0, 9, 0, 0})}};
    builder.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    builder.addNode(node);
    const Scene scene = load(builder);
    ASSERT_EQ(scene.instances.size(), 3U);
    for (const MeshInstance& instance : scene.instances) {
        EXPECT_EQ(instance.node, 1U);
    }
}

}  // namespace
}  // namespace glim::test
