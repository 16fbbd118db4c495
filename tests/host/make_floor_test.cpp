// The floor that --floor and --backdrop lay under a scene.
#include "host/scene/make_floor.hpp"
#include "host/error.hpp"
#include "host/scene/placed_mesh.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

class MakeFloorTest : public ::testing::Test {
protected:
    // A ball of radius 0.5 at (3, 2, -1), which an animation moves down by 1 within a second, and a smaller one in a file of its own.
    void SetUp() override
    {
        GltfBuilder builder;
        builder.append("materials", {{"name", "paint"}});
        builder.addNode({{"translation", {3, 2, -1}}, {"extras", {{"sphere", {{"radius", 0.5}, {"material", 0}}}}}});
        const std::size_t times = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
        builder.append("animations", {{"samplers", {{{"input", times}, {"output", builder.addVec3({3, 2, -1, 3, 1, -1})}}}},
                                      {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
        writeText(folder_ / "ball.gltf", builder.toGltf());
        GltfBuilder low;
        low.append("materials", json::object());
        low.addNode({{"translation", {0, -4, 0}}, {"extras", {{"sphere", {{"radius", 0.25}, {"material", 0}}}}}});
        writeText(folder_ / "low.gltf", low.toGltf());
        options_.environment = BuiltInEnvironment::Studio;
        options_.floor.emplace();
    }
    Scene load() const { return loadGltf(folder_ / "ball.gltf", options_); }

    // Its triangles, in the world.
    static std::vector<std::array<glm::dvec3, 3>> floorOf(const Scene& scene)
    {
        std::vector<std::array<glm::dvec3, 3>> triangles;
        const MeshInstance& floor = scene.instances.back();
        EXPECT_EQ(floor.name, kFloorName);
        EXPECT_EQ(scene.materials[scene.meshes[floor.mesh].material].name, kFloorName);
        EXPECT_EQ(scene.nodeNames.at(floor.node), kFloorName);
        const PlacedMesh placed(scene, floor);
        for (std::size_t i = 0; i < placed.triangleCount(); ++i) {
            const Triangle triangle = placed.triangle(i);
            triangles.push_back({scene.origin + glm::dvec3(triangle.vertices[0]), scene.origin + glm::dvec3(triangle.vertices[1]),
                                 scene.origin + glm::dvec3(triangle.vertices[2])});
        }
        return triangles;
    }
    static void expectHeight(const Scene& scene, double height)
    {
        double area = 0.0;
        for (const auto& [a, b, c] : floorOf(scene)) {
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            EXPECT_GT(normal.y, 0.0) << "its front faces up";
            EXPECT_NEAR(a.y, height, 1e-5);
            EXPECT_NEAR(b.y, height, 1e-5);
            area += 0.5 * glm::length(normal);
        }
        EXPECT_NEAR(area, 314.0, 1.0) << "a disc with the radius of ten balls";
    }

    ScratchFolder folder_;
    LoadOptions options_;
};

TEST_F(MakeFloorTest, LiesAtTheLowestPointOrAtAHeight)
{
    expectHeight(load(), 1.5);
    options_.floor->height = -0.75;
    expectHeight(load(), -0.75);
}

// So it does not move while what stands on it does.
TEST_F(MakeFloorTest, LiesUnderTheRestPose)
{
    options_.at = 1.0;
    expectHeight(load(), 1.5);
    SceneFile file(folder_ / "ball.gltf", options_);
    const Scene first = file.sceneAt(0.25), second = file.sceneAt(0.75);
    expectHeight(first, 1.5);
    expectHeight(second, 1.5);
    EXPECT_NE(first.spheres.front().center + glm::vec3(first.origin), second.spheres.front().center + glm::vec3(second.origin));
}

TEST_F(MakeFloorTest, LiesUnderWhatIsAdded)
{
    options_.additions = {{folder_ / "low.gltf"}};
    double lowest = 0.0;
    for (const auto& corners : floorOf(load())) {
        lowest = std::min(lowest, corners[0].y);
    }
    EXPECT_NEAR(lowest, -4.25, 1e-4);
}

TEST_F(MakeFloorTest, ChangesNoFramedCamera)
{
    const Scene with = load();
    options_.floor.reset();
    const Scene without = load();
    EXPECT_LT(glm::length((glm::dvec3(with.cameras.back().position) + with.origin) -
                          (glm::dvec3(without.cameras.back().position) + without.origin)),
              1e-5);
}

TEST_F(MakeFloorTest, ABackdropIsAWallInItsDirection)
{
    for (const double azimuth : {0.0, 90.0, 215.0}) {
        options_.floor->backdrop = azimuth;
        const double angle = glm::radians(azimuth);
        const glm::dvec3 behind(std::sin(angle), 0.0, -std::cos(angle)), middle(3.0, 1.5, -1.0);
        double farthest = 0.0, highest = 0.0;
        for (const auto& [a, b, c] : floorOf(load())) {
            const glm::dvec3 center = (a + b + c) / 3.0, normal = glm::cross(b - a, c - a);
            EXPECT_GT(glm::dot(normal, middle + glm::dvec3(0.0, 3.0, 0.0) - center), 0.0) << "its front faces the subject";
            for (const glm::dvec3& corner : {a, b, c}) {
                farthest = std::max(farthest, glm::dot(corner - middle, behind));
                highest = std::max(highest, corner.y - middle.y);
                EXPECT_GE(corner.y, 1.5 - 1e-5);
            }
        }
        EXPECT_NEAR(farthest, 2.5, 1e-4);
        EXPECT_NEAR(highest, 8.0, 1e-4);
    }
}

TEST_F(MakeFloorTest, HasItsColourAndRoughness)
{
    EXPECT_EQ(load().materials.back().baseColor, glm::vec3(0.8F));
    EXPECT_EQ(load().materials.back().specular, 0.0F);
    options_.floor->color = {0.1F, 0.2F, 0.3F};
    options_.floor->roughness = 0.25F;
    EXPECT_EQ(load().materials.back().baseColor, glm::vec3(0.1F, 0.2F, 0.3F));
    EXPECT_EQ(load().materials.back().roughness, 0.25F);
    EXPECT_EQ(load().materials.back().specular, 1.0F);
}

TEST_F(MakeFloorTest, ItsMaterialMayCatchShadows)
{
    EXPECT_FALSE(load().materials.back().isCatcher);
    options_.catchers = {"floor"};
    EXPECT_TRUE(load().materials.back().isCatcher);
    EXPECT_FALSE(load().materials.front().isCatcher);
    options_.catchers = {"paint"};
    EXPECT_TRUE(load().materials.front().isCatcher);
    options_.catchers = {"ground"};
    expectRefusal<InputError>([this] { load(); }, MessageId::UnknownName,
                              {"ball.gltf", "--catcher", "ground", R"(one of "floor", "paint")"});
}

}  // namespace
}  // namespace glim::test
