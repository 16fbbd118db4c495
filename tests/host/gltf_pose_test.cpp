// Skins and morph targets of files: each pose is worked out on paper.
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace glim::test {
namespace {

using nlohmann::json;

constexpr double kPoseTolerance = 1e-14;
const json kQuarterTurnAboutZ = {0, 0, std::sqrt(0.5), std::sqrt(0.5)};  // X to Y

constexpr const char* kBlueGreyPixel =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNoaPgPAAODAgAApfuJAAAAAElFTkSuQmCC";

// The triangle (0,0,0) (1,0,0) (0,1,0), whose vertices follow joints by weights, four each and set.
struct SkinnedTriangle : GltfBuilder {
    explicit SkinnedTriangle(const std::vector<std::vector<float>>& weights)
    {
        for (const std::vector<float>& set : weights) {
            addSet({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, addAccessor(toBytes(set), kFloat, "VEC4", 3));
        }
        primitive["attributes"]["POSITION"] = addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    }

    void addSet(const Bytes& joints, std::size_t weights)
    {
        const std::string number = std::to_string(sets++);
        primitive["attributes"]["JOINTS_" + number] = addAccessor(joints, kUnsignedByte, "VEC4", joints.size() / 4);
        primitive["attributes"]["WEIGHTS_" + number] = weights;
    }

    // Nodes 0 and 1 are the joints, node 2 has the mesh.
    void finish(const json& first, const json& second, const json& mesh = json::object())
    {
        addNode(first);
        addNode(second);
        json node = mesh;
        node.update({{"mesh", addMesh(primitive)}, {"skin", 0}});
        addNode(node);
        document["skins"] = json::array({{{"joints", {0, 1}}}});
    }

    json primitive;
    std::size_t sets = 0;
};

// All vertices follow the first joint.
SkinnedTriangle rigid() { return SkinnedTriangle({{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}}); }

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = kPoseTolerance)
{
    EXPECT_LT(glm::length(value - expected), tolerance) << value.x << ' ' << value.y << ' ' << value.z;
}

// joint world x inverse bind: (1, 0, 0) moves to (-1, 0, 0), turns to (0, -1, 0), moves to (1, -1, 0).
TEST(GltfPose, AJointTurnsAboutWhereItWasBound)
{
    SkinnedTriangle builder = rigid();
    builder.finish({{"translation", {1, 0, 0}}, {"rotation", kQuarterTurnAboutZ}}, json::object());
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    builder.document["skins"][0]["inverseBindMatrices"] = builder.addAccessor(toBytes(bind), kFloat, "MAT4", 2);
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {1, -2, 0});
    expectNear(placedVertex(scene, 1), {1, -1, 0});
    expectNear(placedVertex(scene, 2), {0, -2, 0});
    EXPECT_EQ(scene.skins, 1U);
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::ExtensionIgnored));
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::WeightsNormalized));
}

TEST(GltfPose, JointsFollowTheirParentsEvenUnseen)
{
    SkinnedTriangle builder = rigid();
    builder.finish({{"translation", {1, 0, 0}}}, json::object());
    builder.document["scenes"][0]["nodes"] = {1, 2, 3};
    builder.append("nodes", {{"children", {0}},
                             {"rotation", kQuarterTurnAboutZ},
                             {"scale", {2, 2, 2}},
                             {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {0, 2, 0});
    expectNear(placedVertex(scene, 1), {0, 4, 0});
}

// (0, 1, 0) is turned to (-1, 0, 0) by one joint, and moved to (0, 1, 8) by the other.
TEST(GltfPose, TwoJointsAreBlended)
{
    SkinnedTriangle builder({{0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 0.25F, 0.75F, 0, 0}});
    builder.finish({{"rotation", kQuarterTurnAboutZ}}, {{"translation", {0, 0, 8}}});
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {0, 0, 4});
    expectNear(placedVertex(scene, 1), {0, 1, 0});
    expectNear(placedVertex(scene, 2), {-0.25, 0.75, 6});
}

TEST(GltfPose, AVertexMayFollowEightJoints)
{
    SkinnedTriangle builder({{0.5F, 0.125F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, {0.25F, 0.125F, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
    builder.finish({{"translation", {4, 0, 0}}}, {{"translation", {0, 8, 1}}});
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {3, 2, 0.25});
    expectNear(placedVertex(scene, 1), {5, 0, 0});
}

TEST(GltfPose, TheNodeOfASkinnedMeshDoesNotMoveIt)
{
    SkinnedTriangle builder = rigid();
    builder.finish({{"translation", {0, 0, 1}}}, json::object(), {{"translation", {7, 7, 7}}, {"scale", {0, 3, 3}}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.instances.at(0).worldFromMesh, glm::dmat4(1.0));
    expectNear(placedVertex(scene, 1), {1, 0, 1});
}

// 51 and 204 of 255 are 1/5 and 4/5.
TEST(GltfPose, WeightsMayBeBytes)
{
    SkinnedTriangle builder({});
    const std::size_t weights = builder.addAccessor({51, 204, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0}, kUnsignedByte, "VEC4", 3);
    builder.document["accessors"][weights]["normalized"] = true;
    builder.addSet({0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, weights);
    builder.finish({{"translation", {5, 0, 0}}}, {{"translation", {0, 10, 0}}});
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {1, 8, 0});
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::WeightsNormalized));
}

TEST(GltfPose, WeightsThatDoNotAddUpAreNormalised)
{
    SkinnedTriangle builder({{1, 3, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}});
    builder.finish({{"translation", {4, 0, 0}}}, {{"translation", {0, 4, 0}}});
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {1, 3, 0});
    expectNear(placedVertex(scene, 2), {4, 1, 0});
    EXPECT_EQ(findWarning(scene.warnings, MessageId::WeightsNormalized).place, "meshes[0].primitives[0]");

    SkinnedTriangle rounded({{1 - 0x1p-11F, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}});
    rounded.finish({{"translation", {4, 0, 0}}}, json::object());
    const Scene same = load(rounded);
    expectNear(placedVertex(same, 0), {4 - 0x1p-9, 0, 0});
    EXPECT_FALSE(hasWarning(same.warnings, MessageId::WeightsNormalized));
}

// Target 0 lifts all by z = 1 and target 1 moves the second vertex by x = 1.
GltfBuilder morphed(const json& meshWeights, const json& nodeWeights)
{
    GltfBuilder builder;
    const std::size_t lift = builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1}), stretch = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 0, 0});
    const std::size_t mesh = builder.addMesh({{"attributes", {{"POSITION", builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}}},
                                              {"targets", {{{"POSITION", lift}}, {{"POSITION", stretch}}}}});
    builder.addNode({{"mesh", mesh}});
    if (!meshWeights.is_null()) {
        builder.document["meshes"][0]["weights"] = meshWeights;
    }
    if (!nodeWeights.is_null()) {
        builder.document["nodes"][0]["weights"] = nodeWeights;
    }
    return builder;
}

TEST(GltfPose, WeightsOfTheNodeGoBeforeThoseOfTheMesh)
{
    const Scene rest = load(morphed(nullptr, nullptr));
    expectNear(placedVertex(rest, 1), {1, 0, 0});
    EXPECT_EQ(rest.morphTargets, 2U);
    expectNear(placedVertex(load(morphed({0.5, 0}, nullptr)), 1), {1, 0, 0.5});
    expectNear(placedVertex(load(morphed({0.5, 0}, {2, -0.25})), 1), {0.75, 0, 2});
    expectNear(placedVertex(load(morphed({0.5, 0}, {0, 0})), 1), {1, 0, 0});
}

TEST(GltfPose, NodesOfOneMeshAndPoseShareIt)
{
    GltfBuilder builder = morphed(nullptr, {1, 0});
    builder.addNode({{"mesh", 0}, {"weights", {1, 0}}, {"translation", {5, 0, 0}}});
    builder.addNode({{"mesh", 0}, {"weights", {1, 1}}});
    builder.addNode({{"mesh", 0}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.meshes.size(), 3U);
    expectNear(placedVertex(scene, 1, 1), {6, 0, 1});
    expectNear(placedVertex(scene, 1, 2), {2, 0, 1});
    expectNear(placedVertex(scene, 1, 3), {1, 0, 0});
}

// (0, 1, 0) is morphed to (0, 3, 0), which the joint turns to (-3, 0, 0); skinned first it would be (-1, 2, 0).
TEST(GltfPose, MeshesAreMorphedBeforeTheyAreSkinned)
{
    SkinnedTriangle builder = rigid();
    builder.primitive["targets"] = json::array({{{"POSITION", builder.addVec3({0, 0, 0, 0, 0, 0, 0, 2, 0})}}});
    builder.finish({{"rotation", kQuarterTurnAboutZ}}, json::object(), {{"weights", {1}}});
    expectNear(placedVertex(load(builder), 2), {-3, 0, 0});
}

TEST(GltfPose, MorphTargetsMayBeSparse)
{
    GltfBuilder builder = morphed(nullptr, {1, 0});
    json& lift = builder.document["accessors"][0];
    lift.erase("bufferView");
    lift["sparse"] = {{"count", 1},
                      {"indices", {{"bufferView", builder.addAov({1})}, {"componentType", kUnsignedByte}}},
                      {"values", {{"bufferView", builder.addAov(toBytes<float>({0, 0, 7}))}}}};
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {0, 0, 0});
    expectNear(placedVertex(scene, 1), {1, 0, 7});
}

// KHR_mesh_quantization: deltas of 127 are 1.
TEST(GltfPose, MorphTargetsMayBeBytes)
{
    GltfBuilder builder = morphed(nullptr, {0.5, 0});
    const std::size_t lift = builder.addAccessor({0, 0, 127, 0, 0, 0, 129, 0, 0, 0, 0, 0}, kByte, "VEC3", 3);
    builder.document["accessors"][lift]["normalized"] = true;
    builder.document["bufferViews"].back()["byteStride"] = 4;
    builder.document["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = lift;
    const Scene scene = load(builder);
    expectNear(placedVertex(scene, 0), {0, 0, 0.5});
    expectNear(placedVertex(scene, 1), {1, 0, -0.5});
}

TEST(GltfPose, NormalsAndTangentsAreMorphedToo)
{
    GltfBuilder builder = morphed(nullptr, {2, 0});
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] = builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1});
    primitive["attributes"]["TANGENT"] = builder.addAccessor(toBytes<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}), kFloat, "VEC4", 3);
    primitive["targets"][0]["NORMAL"] = builder.addVec3({0.5F, 0, 0, 0, 0, 0, 0, 0, 0});
    primitive["targets"][0]["TANGENT"] = builder.addVec3({0, 0, -0.5F, 0, 0, 0, 0, 0, 0});
    primitive["targets"][0]["COLOR_0"] = primitive["targets"][0]["POSITION"];
    const Scene scene = load(builder);
    const Mesh& mesh = scene.meshes.at(0);
    const double half = std::sqrt(0.5);
    expectNear(mesh.normals.at(0), {half, 0, half});
    expectNear(mesh.normals.at(1), {0, 0, 1});
    expectNear(glm::dvec3(mesh.tangents.at(0)), {half, 0, -half}, 1e-7);
    EXPECT_EQ(mesh.tangents.at(0).w, -1.0F);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::MorphAttributeIgnored).place, "COLOR_0 of meshes[0].primitives[0].targets[0]");
}

// The target turns the triangle about y: u, which rises along x, rises along -z then.
TEST(GltfPose, TangentsThatTheFileLacksFollowThePose)
{
    GltfBuilder builder = morphed({0, 0}, nullptr);
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["attributes"]["TEXCOORD_0"] = builder.addAccessor(toBytes<float>({0, 0, 1, 0, 0, 1}), kFloat, "VEC2", 3);
    primitive["targets"][0]["POSITION"] = builder.addVec3({0, 0, 0, -1, 0, -1, 0, 0, 0});
    primitive["material"] = 0;
    builder.document["materials"] = json::array({{{"normalTexture", {{"index", 0}}}}});
    builder.document["textures"] = json::array({{{"source", 0}}});
    builder.document["images"] = json::array({{{"uri", kBlueGreyPixel}}});
    expectNear(glm::dvec3(load(builder).meshes.at(0).tangents.at(0)), {1, 0, 0}, 1e-7);
    builder.document["meshes"][0]["weights"] = {1, 0};
    expectNear(glm::dvec3(load(builder).meshes.at(0).tangents.at(0)), {0, 0, -1}, 1e-7);
}

TEST(GltfPose, RefusesBrokenSkins)
{
    const auto edited = [](const std::function<void(SkinnedTriangle&)>& edit) {
        SkinnedTriangle builder = rigid();
        builder.finish(json::object(), json::object());
        edit(builder);
        return builder;
    };
    const auto attributes = [](SkinnedTriangle& b) -> json& { return b.document["meshes"][0]["primitives"][0]["attributes"]; };
    expectRefused(edited([](SkinnedTriangle& b) {
                      b.document["skins"][0]["joints"] = {0, 5};
                  }),
                  MessageId::DanglingIndex, {.place = "skins[0].joints[1]", .value = "5", .expected = "nodes"});
    expectRefused(edited([](SkinnedTriangle& b) { b.document["skins"][0].erase("joints"); }), MessageId::Missing,
                  {.place = "skins[0].joints"});
    expectRefused(edited([&](SkinnedTriangle& b) {
                      attributes(b)["JOINTS_0"] = b.addAccessor({0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}, kUnsignedByte, "VEC4", 3);
                  }),
                  MessageId::DanglingIndex, {.place = "vertex 1 of meshes[0].primitives[0]", .value = "2", .expected = "2"});
    expectRefused(edited([&](SkinnedTriangle& b) {
                      attributes(b)["WEIGHTS_0"] = b.addAccessor(toBytes<float>({1, 0, 0, 0, 1, 0, 0, 0, 2, -1, 0, 0}), kFloat, "VEC4", 3);
                  }),
                  MessageId::OutOfRange, {.place = "vertex 2 of meshes[0].primitives[0]", .value = "-1"});
    expectRefused(edited([&](SkinnedTriangle& b) {
                      attributes(b)["JOINTS_0"] = b.addAccessor({0, 0, 0, 0, 0, 0, 0, 0}, kUnsignedByte, "VEC4", 2);
                  }),
                  MessageId::Mismatch, {.place = "meshes[0].primitives[0]", .value = "2 joints", .expected = "3"});
    expectRefused(edited([&](SkinnedTriangle& b) {
                      attributes(b)["JOINTS_0"] = b.addAccessor({0, 0, 0, 0, 0, 0, 0, 0, 0}, kUnsignedByte, "VEC3", 3);
                  }),
                  MessageId::WrongType, {.place = "accessors[3] (JOINTS_0 of meshes[0].primitives[0])", .expected = "VEC4"});
    expectRefused(edited([&](SkinnedTriangle& b) { attributes(b).erase("WEIGHTS_0"); }), MessageId::Requires,
                  {.place = "meshes[0].primitives[0]", .value = "JOINTS_0"});
    expectRefused(edited([&](SkinnedTriangle& b) {
                      attributes(b).erase("WEIGHTS_0");
                      attributes(b).erase("JOINTS_0");
                  }),
                  MessageId::Missing, {.place = "meshes[0].primitives[0]", .value = "JOINTS_0"});
    const std::vector<float> identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const auto bind = [](SkinnedTriangle& b, const std::vector<float>& matrices, const char* type, std::size_t count) {
        b.document["skins"][0]["inverseBindMatrices"] = b.addAccessor(toBytes(matrices), kFloat, type, count);
    };
    expectRefused(edited([&](SkinnedTriangle& b) { bind(b, identity, "MAT4", 1); }), MessageId::Mismatch,
                  {.place = "skins[0]", .value = "1", .expected = "2"});
    expectRefused(edited([&](SkinnedTriangle& b) { bind(b, identity, "VEC4", 4); }), MessageId::WrongType,
                  {.place = "accessors[3] (inverseBindMatrices of skins[0])", .expected = "MAT4"});
    std::vector<float> projective = identity;
    projective.insert(projective.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2, 0, 0, 0, 1});
    expectRefused(edited([&](SkinnedTriangle& b) { bind(b, projective, "MAT4", 2); }), MessageId::OutOfRange,
                  {.place = "inverseBindMatrices of skins[0]", .value = "0 0 2 1"});
}

TEST(GltfPose, RefusesBrokenMorphTargets)
{
    expectRefused(morphed(nullptr, {1}), MessageId::Mismatch, {.place = "meshes[0].primitives[0]", .value = "2 morph targets"});
    expectRefused(morphed(nullptr, {1, "x"}), MessageId::WrongType, {.place = "nodes[0].weights[1]", .value = "\"x\""});
    GltfBuilder builder = morphed(nullptr, {1, 0});
    json& target = builder.document["meshes"][0]["primitives"][0]["targets"][0];
    target["POSITION"] = builder.addVec3({0, 0, 0});
    expectRefused(builder, MessageId::Mismatch, {.place = "meshes[0].primitives[0].targets[0]", .value = "1 positions", .expected = "3"});
    target["POSITION"] = 77;
    expectRefused(builder, MessageId::DanglingIndex,
                  {.place = "meshes[0].primitives[0].targets[0].POSITION", .value = "77", .expected = "accessors"});
    target["POSITION"] = builder.addVec3({0, 0, NAN, 0, 0, 0, 0, 0, 0});
    expectRefused(builder, MessageId::OutOfRange, {.place = "nodes[0]", .value = "nan nan nan"});
}

}  // namespace
}  // namespace glim::test
