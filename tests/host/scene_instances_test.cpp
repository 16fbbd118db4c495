// Instances of a scene have ids and names of their own, however many materials they have and nodes share.
#include "host/render/scene_instances.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

TEST(SceneInstancesTest, EachPlacingOfANodeIsOne)
{
    Scene scene;
    scene.nodeNames = {"tree", "", "ball", "lone"};
    scene.meshNames = {"oak", ""};
    const auto addMesh = [&scene](std::uint32_t fileMesh) {
        Mesh mesh;
        mesh.fileMesh = fileMesh;
        scene.meshes.change().push_back(mesh);
    };
    for (const std::uint32_t fileMesh : {0U, 0U, 1U}) {
        addMesh(fileMesh);  // leaves and trunk of the oak, and another
    }
    const std::pair<std::uint32_t, std::uint32_t> placed[] = {{0, 0}, {0, 1}, {1, 2}, {0, 0}, {0, 1}, {3, 0}, {3, 1}};
    for (const auto& [node, mesh] : placed) {
        scene.instances.push_back({"", mesh, glm::dmat4(1.0), node});
    }
    scene.spheres.push_back({"ball", {}, 1.0F, 0, 2});
    const SceneInstances instances(scene);
    const std::vector<SceneInstance> expected{{"tree[0]", 0, 0, "oak"},
                                              {"node.1", 1, 1, "node.1"},
                                              {"tree[1]", 0, 0, "oak"},
                                              {"lone", 3, 0, "oak"},
                                              {"ball", 2, kNoIndex, "sphere"}};
    EXPECT_EQ(instances.all(), expected);
    const std::uint32_t ofObjects[] = {0, 0, 1, 2, 2, 3, 3, 4};
    for (std::uint32_t object = 0; object < std::size(ofObjects); ++object) {
        EXPECT_EQ(instances.ofObject(object), ofObjects[object]) << object;
    }
}

TEST(SceneInstancesTest, NodesOfOneNameHaveDifferentNames)
{
    Scene scene;
    scene.nodeNames = {"chair", "table", "chair"};
    scene.meshNames = {"mesh"};
    Mesh mesh;
    mesh.fileMesh = 0;
    scene.meshes.change().push_back(mesh);
    for (const std::uint32_t node : {0U, 1U, 2U, 2U}) {
        scene.instances.push_back({"", 0, glm::dmat4(1.0), node});
    }
    std::vector<std::string> names;
    const SceneInstances instances(scene);
    for (const SceneInstance& instance : instances.all()) {
        names.push_back(instance.name);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"chair.0", "table", "chair.2[0]", "chair.2[1]"}));
}

}  // namespace
}  // namespace glim
