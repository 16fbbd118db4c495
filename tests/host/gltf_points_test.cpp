// Primitives of points and lines: where they are, how large, and of what colour.
#include "host/flatten/primitives.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glim::test {
namespace {

using nlohmann::json;

// Four corners of a square with a side of 2, of which the last stands apart.
const std::vector<float> kCorners = {0, 0, 0, 2, 0, 0, 0, 2, 0, 9, 9, 0};

json points(GltfBuilder& builder, json primitive = json::object(), const std::vector<float>& positions = kCorners)
{
    primitive["attributes"]["POSITION"] = builder.addVec3(positions);
    primitive["mode"] = 0;
    return primitive;
}

GltfBuilder cloud(const json& primitive = json::object(), json node = json::object(), const std::vector<float>& positions = kCorners)
{
    GltfBuilder builder;
    node["mesh"] = builder.addMesh(points(builder, primitive, positions));
    builder.addNode(node);
    return builder;
}

std::vector<PlacedSphere> spheresOf(const Scene& scene)
{
    const Primitives primitives = makePrimitives(scene);
    std::vector<PlacedSphere> spheres;
    std::ranges::copy(primitives.spheres.all(), std::back_inserter(spheres));
    return spheres;
}

std::vector<PlacedSphere> spheresOf(const GltfBuilder& builder, const LoadOptions& options = {})
{
    return spheresOf(load(builder, options));
}

// In the world.
glm::dvec3 centerOf(const Scene& scene, std::size_t point) { return glm::dvec3(spheresOf(scene).at(point).center) + scene.origin; }

TEST(GltfPoints, PointsAreSpheresOfHalfTheMedianDistanceToTheNearest)
{
    const Scene scene = load(cloud());
    const std::vector<PlacedSphere> spheres = spheresOf(scene);
    ASSERT_EQ(spheres.size(), 4U);
    for (const PlacedSphere& sphere : spheres) {
        EXPECT_EQ(sphere.radius, 1.0F);
        EXPECT_EQ(sphere.object, 0U);
        EXPECT_EQ(sphere.point, static_cast<std::uint32_t>(&sphere - spheres.data()));
    }
    EXPECT_EQ(centerOf(scene, 3), glm::dvec3(9, 9, 0));
    EXPECT_TRUE(makePrimitives(scene).triangles.empty());
}

TEST(GltfPoints, ARadiusInExtrasIsScaledByTheNode)
{
    const json primitive = {{"extras", {{"radius", 3}}}};
    EXPECT_EQ(spheresOf(cloud(primitive)).at(0).radius, 3.0F);
    EXPECT_EQ(spheresOf(cloud(primitive, {{"scale", {2, 2, 2}}})).at(0).radius, 6.0F);
    EXPECT_EQ(spheresOf(cloud(primitive, {{"scale", {-2, 2, 2}}})).at(0).radius, 6.0F);
    EXPECT_FLOAT_EQ(spheresOf(cloud(primitive, {{"scale", {1, 2, 4}}})).at(0).radius, 6.0F);
}

TEST(GltfPoints, TheOptionIsTheRadiusInTheWorld)
{
    LoadOptions options;
    options.pointRadius = 0.25;
    EXPECT_EQ(spheresOf(cloud({{"extras", {{"radius", 3}}}}, {{"scale", {2, 2, 2}}}), options).at(0).radius, 0.25F);
    options.additions.push_back({writeTemporary("added.gltf", cloud().toGltf()), glm::dmat4(4.0)});
    options.additions[0].worldFromFile[3].w = 1.0;
    const std::vector<PlacedSphere> spheres = spheresOf(oneTriangle(), options);
    ASSERT_EQ(spheres.size(), 4U);
    EXPECT_EQ(spheres[0].radius, 0.25F);
    options.pointRadius.reset();
    EXPECT_EQ(spheresOf(oneTriangle(), options).at(0).radius, 4.0F);
}

TEST(GltfPoints, RadiiThatAreNoneAreIgnoredAndSaidSo)
{
    for (const json& radius : {json(0), json(-1), json("large"), json{1, 2}}) {
        const Scene scene = load(cloud({{"extras", {{"radius", radius}}}}));
        EXPECT_EQ(spheresOf(scene).at(0).radius, 1.0F);
        EXPECT_EQ(findWarning(scene.warnings, MessageId::ExtrasIgnored).place, "meshes[0].primitives[0].extras.radius");
    }
    EXPECT_FALSE(hasWarning(load(cloud({{"extras", {{"color", "red"}}}})).warnings, MessageId::ExtrasIgnored));
}

// Also of points that coincide.
// They are no places that the origin could be near to: float32 resolves none of them.
TEST(GltfPoints, RadiiThatRoundToZeroLeaveTheOriginAsItIs)
{
    GltfBuilder builder;
    json primitive = {{"attributes", {{"POSITION", builder.addVec3({0, 0, 0, 2, 0, 0})}}}, {"mode", 0}, {"extras", {{"radius", 1e-50}}}};
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.origin, glm::dvec3(1, 0, 0));
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::FarPart));
}

TEST(GltfPoints, APointAloneIsAHundredthOfTheScene)
{
    EXPECT_EQ(spheresOf(cloud({}, {}, {5, 5, 5, 5, 5, 5})).at(1).radius, 0.01F);
    GltfBuilder builder = cloud({}, {}, {0.5F, 0.5F, 0});
    builder.addNode({{"mesh", builder.addTriangleMesh()}, {"scale", {50, 50, 50}}});
    EXPECT_EQ(spheresOf(builder).at(0).radius, 0.5F);
}

TEST(GltfPoints, CentresAreWhereVerticesWouldBe)
{
    GltfBuilder builder;
    json node = {{"mesh", builder.addMesh(points(builder))}, {"scale", {-1, 1, 1}}, {"translation", {0, 0, 3}}};
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = builder.addVec3({0, 0, 0, 0, 10, 0});
    builder.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    builder.addNode(node);
    const Scene scene = load(builder);
    EXPECT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(makePrimitives(scene).spheres.size(), 8U);
    EXPECT_EQ(centerOf(scene, 1), glm::dvec3(-2, 0, 3));
    EXPECT_EQ(centerOf(scene, 5), glm::dvec3(-2, 10, 3));
}

TEST(GltfPoints, SkinsAndMorphTargetsMoveThem)
{
    GltfBuilder builder = posedTriangle();
    builder.document["meshes"][0]["primitives"][0]["mode"] = 0;
    GltfBuilder triangles = posedTriangle();
    LoadOptions options;
    options.at = 0.7;
    const Scene scene = load(builder, options), reference = load(triangles, options), rest = load(builder);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LE(glm::distance(centerOf(scene, i), placedVertex(reference, i)), 1e-6);
    }
    EXPECT_GT(glm::distance(centerOf(scene, 2), centerOf(rest, 2)), 1e-3);
}

TEST(GltfPoints, IndicesChooseThem)
{
    GltfBuilder builder;
    json primitive = points(builder);
    primitive["attributes"]["COLOR_0"] = builder.addVec3({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
    primitive["indices"] = builder.addIndices({2, 0});
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    const Scene scene = load(builder);
    ASSERT_EQ(makePrimitives(scene).spheres.size(), 2U);
    EXPECT_EQ(centerOf(scene, 0), glm::dvec3(0, 2, 0));
    EXPECT_EQ(scene.meshes[0].colors, (std::vector<glm::vec4>{{0, 0, 1, 1}, {1, 0, 0, 1}}));
    primitive["indices"] = builder.addIndices({4});
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    expectRefused(builder, MessageId::DanglingIndex,
                  {.place = "accessors[3] (indices of meshes[1].primitives[0])", .value = "4", .expected = "indices below 4"});
}

TEST(GltfPoints, BrokenOnesAreRefusedAsTrianglesAre)
{
    expectRefused(cloud({}, {}, {0, 0, 0, 1, NAN, 0}), MessageId::OutOfRange,
                  {.place = "accessors[0] (POSITION of meshes[0].primitives[0])", .value = "nan"});
    GltfBuilder builder;
    json primitive = points(builder);
    primitive["attributes"]["COLOR_0"] = builder.addVec3({1, 0, 0});
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    expectRefused(builder, MessageId::Mismatch, {.value = "1 vertex colours", .expected = "4 positions"});
    GltfBuilder without;
    without.addNode({{"mesh", without.addMesh({{"attributes", json::object()}, {"mode", 0}})}});
    without.addNode({{"mesh", without.addTriangleMesh()}});
    EXPECT_TRUE(hasWarning(load(without).warnings, MessageId::MeshWithoutPosition));
}

// Refused by counts alone, before any of it is read.
TEST(GltfPoints, MorePointsThanFitIntoMemoryAreRefused)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addMesh(points(builder))}});
    builder.document["accessors"][0]["count"] = 4'000'000'000;
    expectRefused(builder, MessageId::OutOfMemory, {.value = "434875"});  // MiB, of 114 bytes a point
}

TEST(GltfPoints, SplatsArePointsOfTheirColours)
{
    GltfBuilder builder;
    json primitive = points(builder);
    primitive["attributes"]["KHR_gaussian_splatting:SH_DEGREE_0_COEF_0"] =
        builder.addVec3({0, 0, 0, 1.77245385F, -1.77245385F, 0, 0, 0, 0, 0, 0, 0});
    primitive["extensions"]["KHR_gaussian_splatting"] = {{"kernel", "ellipse"}, {"colorSpace", "lin_rec709_display"}};
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    builder.document["extensionsUsed"] = {"KHR_gaussian_splatting"};
    builder.document["extensionsRequired"] = {"KHR_gaussian_splatting"};
    const Scene scene = load(builder);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::SplatsAsPoints).place, "meshes[0].primitives[0]");
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::ExtensionIgnored));
    EXPECT_EQ(scene.meshes[0].colors[0], glm::vec4(0.5, 0.5, 0.5, 1));
    EXPECT_LE(glm::distance(scene.meshes[0].colors[1], glm::vec4(1, 0, 0.5, 1)), 1e-6F);
    builder.document["meshes"][0]["primitives"][0]["extensions"]["KHR_gaussian_splatting"]["colorSpace"] = "srgb_rec709_display";
    EXPECT_FLOAT_EQ(load(builder).meshes[0].colors[0].r, 0.21404114F);  // of the sRGB value 0.5
}

// Of these four corners.
json lines(GltfBuilder& builder, int mode) { return {{"attributes", {{"POSITION", builder.addVec3(kCorners)}}}, {"mode", mode}}; }

TEST(GltfLines, ArePairsStripsAndLoops)
{
    const std::vector<std::pair<int, std::vector<glm::uvec2>>> modes = {
        {1, {{0, 1}, {2, 3}}}, {3, {{0, 1}, {1, 2}, {2, 3}}}, {2, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}}};
    for (const auto& [mode, expected] : modes) {
        GltfBuilder builder;
        builder.addNode({{"mesh", builder.addMesh(lines(builder, mode))}, {"scale", {2, 2, 2}}, {"translation", {0, 0, 1}}});
        const Scene scene = load(builder);
        EXPECT_EQ(scene.meshes[0].lines, expected);
        const std::vector<PlacedSphere> placed = spheresOf(scene);
        ASSERT_EQ(placed.size(), expected.size());
        EXPECT_TRUE(placed[0].isLine());
        EXPECT_EQ(centerOf(scene, 0), glm::dvec3(0, 0, 1));
        EXPECT_EQ(placed[0].axis, glm::vec3(4, 0, 0));
        EXPECT_FLOAT_EQ(placed[0].radius, static_cast<float>(2.0 * std::sqrt(162.0) / 500.0));  // of the box's diagonal
    }
}

TEST(GltfLines, TheirRadiusIsThatOfExtrasOrOfTheOption)
{
    GltfBuilder builder;
    json primitive = lines(builder, 3);
    primitive["extras"]["radius"] = 0.5;
    builder.addNode({{"mesh", builder.addMesh(primitive)}, {"scale", {2, 2, 2}}});
    EXPECT_EQ(spheresOf(builder).at(0).radius, 1.0F);
    LoadOptions options;
    options.pointRadius = 3.0;  // which they are not
    EXPECT_EQ(spheresOf(builder, options).at(0).radius, 1.0F);
    options.lineRadius = 0.25;
    EXPECT_EQ(spheresOf(builder, options).at(0).radius, 0.25F);
}

TEST(GltfLines, IndicesChooseTheirEndsAndColoursAreTheMeans)
{
    GltfBuilder builder;
    json primitive = lines(builder, 1);
    primitive["attributes"]["COLOR_0"] = builder.addVec3({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
    primitive["indices"] = builder.addIndices({3, 0});
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.meshes[0].lines, (std::vector<glm::uvec2>{{3, 0}}));
    const PlacedSpheres spheres(scene);
    EXPECT_EQ(spheres.computeColor(spheres[0]), glm::vec4(1.0F, 0.5F, 0.5F, 1.0F));
}

TEST(GltfLines, LinesWithoutTwoEndsAreRefused)
{
    for (const auto& [mode, count, expected] : {std::tuple(1, 3, "a multiple of 2"), {3, 1, "at least 2"}, {2, 1, "at least 2"}}) {
        GltfBuilder builder;
        json primitive = lines(builder, mode);
        primitive["indices"] = builder.addIndices(std::vector<std::uint32_t>(static_cast<std::size_t>(count), 0));
        builder.addNode({{"mesh", builder.addMesh(primitive)}});
        expectRefused(builder, MessageId::OutOfRange,
                      {.place = "meshes[0].primitives[0]", .value = std::to_string(count), .expected = expected});
    }
}

}  // namespace
}  // namespace glim::test
