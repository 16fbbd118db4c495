// EXT_mesh_gpu_instancing, the meshes that instances share, and scenes that do not fit into memory.
#include "host/flatten/primitives.hpp"
#include "host/scene/share_meshes.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_glim.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>

#include <sys/resource.h>

namespace glim::test {
namespace {

using nlohmann::json;

// Instances of a triangle, with these attributes.
GltfBuilder instances(const json& attributes, GltfBuilder builder = {})
{
    json node = {{"mesh", builder.addTriangleMesh()}, {"translation", {0, 0, 10}}};
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
    builder.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    builder.document["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    builder.addNode(node);
    return builder;
}

TEST(GltfInstancing, InstancesAreTurnedScaledAndMovedBelowTheirNode)
{
    GltfBuilder builder;
    const auto half = static_cast<float>(std::sqrt(0.5));
    const std::size_t translations = builder.addVec3({0, 0, 0, 5, 0, 0});
    const std::size_t rotations = builder.addAccessor(toBytes(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}), kFloat, "VEC4", 2);
    const std::size_t scales = builder.addVec3({1, 1, 1, 2, 3, 1});
    const Scene scene = load(instances({{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}}, builder));
    ASSERT_EQ(scene.instances.size(), 2U);
    EXPECT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(vertex(scene, 0, 1), glm::vec3(1, 0, 10));
    // (1, 0, 0) and (0, 1, 0), scaled to (2, 0, 0) and (0, 3, 0), turned by 90 degrees about z.
    EXPECT_LE(glm::length(vertex(scene, 1, 1) - glm::vec3(5, 2, 10)), 2e-6F);
    EXPECT_LE(glm::length(vertex(scene, 1, 2) - glm::vec3(2, 0, 10)), 2e-6F);
}

TEST(GltfInstancing, RotationsMayBeNormalizedIntegers)
{
    GltfBuilder builder;
    const std::size_t rotations =
        builder.addAccessor(toBytes(std::vector<std::int16_t>{0, 0, 23170, 23170, 0, 32767, 0, 0}), kShort, "VEC4", 2);
    builder.document["accessors"][rotations]["normalized"] = true;
    const Scene scene = load(instances({{"ROTATION", rotations}}, builder));
    ASSERT_EQ(scene.instances.size(), 2U);
    EXPECT_LE(glm::length(vertex(scene, 0, 1) - glm::vec3(0, 1, 10)), 1e-6F);
    EXPECT_LE(glm::length(vertex(scene, 1, 1) - glm::vec3(-1, 0, 10)), 1e-6F);
}

TEST(GltfInstancing, RefusesWhatHasNoMeaning)
{
    const auto expect = [](const std::function<json(GltfBuilder&)>& attributes, MessageId id, const Parts& parts) {
        GltfBuilder builder;
        const json made = attributes(builder);
        expectRefused(instances(made, builder), id, parts);
    };
    const std::string place = " of EXT_mesh_gpu_instancing of nodes[0]";
    expect(
        [](GltfBuilder& b) {
            return json{{"TRANSLATION", b.addVec3({0, 0, 0, 1, 0, 0})}, {"SCALE", b.addVec3({1, 1, 1})}};
        },
        MessageId::Mismatch, {.place = "SCALE" + place, .value = "1", .expected = "2"});
    expect(
        [](GltfBuilder& b) {
            return json{{"ROTATION", b.addVec3({0, 0, 1})}};
        },
        MessageId::WrongType, {.place = "ROTATION" + place, .expected = "VEC4"});
    expect(
        [](GltfBuilder& b) {
            return json{{"ROTATION", b.addAccessor(toBytes(std::vector<float>{0, 0, 0, 0}), kFloat, "VEC4", 1)}};
        },
        MessageId::Degenerate, {.place = "ROTATION" + place, .value = "0"});
    expect(
        [](GltfBuilder& b) {
            return json{{"TRANSLATION", b.addVec3({0, NAN, 0})}};
        },
        MessageId::OutOfRange, {.place = "TRANSLATION" + place, .value = "nan"});
    expect([](GltfBuilder&) { return json{{"SCALE", 77}}; }, MessageId::DanglingIndex, {.value = "77", .expected = "accessors"});
}

TEST(ShareMeshes, SharesTheGreatestSavingFirstAndNoMoreThanNeeded)
{
    // 100 x 1,000, 10 x 5,000, 1 x 8,000, lamps 50 x 100, pairs 2 x 3: 163,006 triangles.
    const std::vector<MeshUse> uses{{100, 1000, false}, {10, 5000, false}, {1, 8000, false}, {50, 100, true}, {2, 3, false}};
    EXPECT_EQ(countTriangles(uses), 163'006U);
    const auto shared = [&](std::uint64_t most) { return chooseSharedMeshes(uses, most); };
    EXPECT_EQ(shared(163'006), (std::vector<bool>{false, false, false, false, false}));
    EXPECT_EQ(shared(163'005), (std::vector<bool>{true, false, false, false, false}));
    EXPECT_EQ(shared(64'306), (std::vector<bool>{true, false, false, false, false})) << "63,006, 1,000 and what 100 instances take";
    EXPECT_EQ(shared(64'305), (std::vector<bool>{true, true, false, false, false}));
    EXPECT_EQ(shared(0), (std::vector<bool>{true, true, false, false, false})) << "a mesh of one instance, lamps, and few triangles";
}

TEST(ShareMeshes, SharedOnesAreStoredOnce)
{
    GltfBuilder builder;
    const std::size_t first = builder.addTriangleMesh(), second = builder.addTriangleMesh();
    for (int i = 0; i < 9; ++i) {
        builder.addNode({{"mesh", i % 3 == 0 ? first : second}, {"translation", {i, 0, 0}}});
    }
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    Scene scene = load(builder);
    // Of one triangle: it would be larger shared.
    EXPECT_TRUE(makePrimitives(scene, 0).sharedMeshes.empty());
    for (int i = 0; i < 4; ++i) {
        std::vector<std::uint32_t>& indices = scene.meshes.change()[1].indices;
        indices.insert(indices.end(), {0, 1, 2});
    }
    const Primitives primitives = makePrimitives(scene, 0);
    ASSERT_EQ(primitives.sharedMeshes.size(), 1U);
    EXPECT_EQ(primitives.sharedMeshes[0].triangles.size(), 5U);
    EXPECT_EQ(primitives.placements.size(), 6U);
    EXPECT_EQ(primitives.triangles.size(), 4U);
    EXPECT_EQ(primitives.computeTriangleCount(), 34U);
}

#ifdef __SANITIZE_ADDRESS__
constexpr bool kLimits = false;  // the sanitizer reserves terabytes for itself
#else
constexpr bool kLimits = true;
#endif

// A small file whose 2,000 lamps have a million triangles each.
TEST(CheckSize, RefusesABombBeforeItTakesMemory)
{
    GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t indices = builder.addIndices({0, 1, 2});
    builder.document["accessors"][indices]["count"] = 3'000'000;  // it is asked before the data are looked at
    builder.document["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    const std::size_t mesh = builder.addMesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}});
    for (int i = 0; i < 2000; ++i) {
        builder.addNode({{"mesh", mesh}});
    }
    const auto start = std::chrono::steady_clock::now();
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    rlimit limited = before;
    limited.rlim_cur = kLimits ? rlim_t{1} << 30U : before.rlim_cur;
    GlimCall call{{"inspect", writeTemporary("bomb.gltf", builder.toGltf())}};
    setrlimit(RLIMIT_AS, &limited);  // the program inherits it
    const GlimRun run = runForMessages(call);
    setrlimit(RLIMIT_AS, &before);
    expectRefused(run, 1, MessageId::OutOfMemory, {.file = "bomb.gltf", .value = "381470", .expected = kLimits ? "1024 MiB" : ""});
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 30.0) << "a busy machine's second";
}

}  // namespace
}  // namespace glim::test
