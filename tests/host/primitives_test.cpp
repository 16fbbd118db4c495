#include "host/flatten/primitives.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

namespace glim {
namespace {

// Two triangles with an edge in common.
Mesh square(bool smooth)
{
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    if (smooth) {
        mesh.normals = {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {0, 0, 2}};
    }
    return mesh;
}

Scene sceneWith(const std::vector<Mesh>& meshes, const std::vector<MeshInstance>& instances)
{
    Scene scene;
    scene.materials.emplace_back();
    scene.meshes = meshes;
    scene.instances = instances;
    return scene;
}

TEST(PrimitivesTest, AreTheTrianglesOfEachInstanceInTurn)
{
    const glm::dmat4 shifted = glm::translate(glm::dmat4(1.0), glm::dvec3(4, 0, 0));
    Scene scene = sceneWith({square(false)}, {{"a", 0}, {"b", 0, shifted}});
    scene.origin = glm::dvec3(1, 0, 0);
    scene.spheres.resize(1);
    const Primitives primitives = makePrimitives(scene);
    EXPECT_EQ(primitives.count(), 5U);
    EXPECT_EQ(primitives.firstTriangles, (std::vector<std::uint32_t>{0, 2, 4}));
    EXPECT_EQ(primitives.findInstance(1), 0U);
    EXPECT_EQ(primitives.findInstance(2), 1U);
    EXPECT_EQ(primitives.triangles[0].vertices[1], glm::vec3(0, 0, 0));
    EXPECT_EQ(primitives.triangles[3].vertices[2], glm::vec3(3, 1, 0));
    EXPECT_TRUE(primitives.vertexNormals.empty() && primitives.vertexIndices.empty());
}

TEST(PrimitivesTest, TrianglesShareTheirMeshsVertices)
{
    const Primitives primitives = makePrimitives(sceneWith({square(true), square(false)}, {{"flat", 1}, {"smooth", 0}}));
    EXPECT_EQ(primitives.vertexNormals.size(), 5U) << "none, and four of the square's";
    EXPECT_EQ(primitives.vertexIndices[0], glm::uvec3(0));
    EXPECT_EQ(primitives.vertexNormals[0], glm::vec3(0.0F));
    EXPECT_EQ(primitives.vertexIndices[2], glm::uvec3(1, 2, 3));
    EXPECT_EQ(primitives.vertexIndices[3], glm::uvec3(1, 3, 4));
    EXPECT_EQ(primitives.vertexNormals[4], glm::vec3(0, 0, 1));
}

// The same square without indices: six corners with three different unit normals.
TEST(PrimitivesTest, TrianglesWithoutIndicesShareEqualNormals)
{
    const Mesh shared = square(true);
    Mesh corners;
    for (const std::uint32_t index : shared.indices) {
        corners.positions.push_back(shared.positions[index]);
        corners.normals.push_back(shared.normals[index]);
        corners.indices.push_back(static_cast<std::uint32_t>(corners.indices.size()));
    }
    const Primitives primitives = makePrimitives(sceneWith({corners}, {{"", 0}}));
    EXPECT_EQ(primitives.vertexIndices[0], glm::uvec3(1, 2, 3));
    EXPECT_EQ(primitives.vertexIndices[1], glm::uvec3(1, 3, 1)) << "(0, 0, 2) is as long as (0, 0, 1) once it is a unit vector";
    EXPECT_EQ(primitives.vertexNormals.size(), 4U);
}

TEST(PrimitivesTest, ABadNormalGivesWayToTheFaceOfEachTriangle)
{
    Mesh bent = square(true);
    bent.positions[3] = {0, 1, 1};
    bent.normals[0] = glm::dvec3(0.0);
    const Primitives primitives = makePrimitives(sceneWith({bent}, {{"", 0}}));
    EXPECT_EQ(primitives.vertexNormals[primitives.vertexIndices[0].x], glm::vec3(0, 0, 1));
    const glm::vec3 other = primitives.vertexNormals[primitives.vertexIndices[1].x];
    EXPECT_LT(glm::length(other - glm::normalize(glm::vec3(1, -1, 1))), 1e-6F);
    ASSERT_EQ(primitives.warnings.size(), 1U);
    test::expectMessage(primitives.warnings[0], MessageId::BadNormal, {.value = "2 normals"});
}

// Triangles whose vertices coincide in float32 have no area.
TEST(PrimitivesTest, WhatHasNoAreaHasNoId)
{
    const glm::dmat4 tiny = glm::scale(glm::dmat4(1.0), glm::dvec3(1e-60));
    const Primitives primitives = makePrimitives(sceneWith({square(true)}, {{"tiny", 0, tiny}, {"", 0}}));
    EXPECT_EQ(primitives.firstTriangles, (std::vector<std::uint32_t>{0, 0, 2}));
    EXPECT_EQ(primitives.findInstance(0), 1U);
    ASSERT_EQ(primitives.warnings.size(), 1U);
    test::expectMessage(primitives.warnings[0], MessageId::FlatTriangle, {.value = "2 triangles"});
    const FlatScene flat = flattened(sceneWith({square(true)}, {{"tiny", 0, tiny}, {"", 0}}));
    EXPECT_EQ(flat.triangles.size(), 2U);
}

TEST(PrimitivesTest, VerticesThatNoTriangleHasAreLeftOut)
{
    Mesh part = square(true);
    part.indices.resize(3);
    EXPECT_EQ(makePrimitives(sceneWith({part}, {{"", 0}})).vertexNormals.size(), 4U);
}

// Normals are per primitive, not per reference.
TEST(PrimitivesTest, PiecesDuplicateNoNormals)
{
    Scene scene = makeTestScene({});
    const Triangles triangles = strips(12, 9);
    addMesh(scene, triangles, 0, std::vector<glm::vec3>(3 * triangles.size(), glm::vec3(0, 0, 1)));
    const FlatScene flat = flattened(scene);
    EXPECT_GT(flat.primitiveRefs.size(), kPrimitiveRefTexels * triangles.size() + 100);
    EXPECT_EQ(flat.triangles.size(), triangles.size());
    EXPECT_EQ(flat.vertices.size(), 2U) << "none, and the one that all corners have";
}

// The fingerprint of a scene, by which films are merged and resumed, as it was when the loader made three normals per triangle (but for the
// framed camera, which stands elsewhere since then). One mesh is smooth, mirrored, and has a bad normal; beside it are a flat mesh and a
// sphere.
TEST(PrimitivesTest, FingerprintsOfSmoothScenesAreWhatTheyWere)
{
    test::GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
    const std::size_t normals = builder.addVec3({0, 0, 1, 0, 1, 1, 1, 0, 1, 0, 0, 0});
    builder.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                                 {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}});
    const std::size_t mesh = builder.addMesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}},
                                              {"indices", builder.addIndices({0, 1, 2, 2, 1, 3})},
                                              {"material", 0}});
    const std::size_t triangle = builder.addTriangleMesh();
    builder.document["meshes"][triangle]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}, {"scale", {-2, 1, 1}}});
    builder.addNode({{"mesh", triangle}, {"translation", {2, 0, 0}}});
    builder.addNode({{"extras", {{"sphere", {{"radius", 0.5}, {"material", 0}}}}}, {"translation", {0, 2, 0}}});
    const Scene scene = test::load(builder, {.environment = glm::vec3(1.0F)});
    EXPECT_EQ(fingerprint(fingerprint(flattened(scene)), flattenCamera(scene.cameras.front(), 1.0F)), "74dfd0865394cb9f");
}

// Three squares in one place: a wall, and lamps of which one has a coverage.
Scene squaresInOnePlace()
{
    Mesh lamp = square(true);
    lamp.material = 1;
    Scene scene = sceneWith({square(true), lamp, lamp}, {{"wall", 0}, {"lamp", 1}, {"again", 2}, {"clear", 2}});
    scene.materials.resize(3);
    scene.materials[1].emission = glm::vec3(1.0F);
    scene.meshes.change().push_back(lamp);
    scene.meshes.change()[3].material = 2;
    scene.instances[3].mesh = 3;
    scene.materials[2].alphaMode = AlphaMode::Blend;
    scene.materials[2].alpha = 0.5F;
    scene.spheres = {{"ball", {3, 0, 0}, 1.0F, 2}};
    return scene;
}

TEST(PrimitivesTest, AHiddenLampIsLeftOut)
{
    const Primitives primitives = makePrimitives(squaresInOnePlace());
    EXPECT_EQ(primitives.firstTriangles, (std::vector<std::uint32_t>{0, 2, 4, 4, 6}));
    EXPECT_EQ(primitives.vertexIndices.size(), 6U);
    EXPECT_EQ(primitives.hasAlpha, (std::vector<bool>{false, false, false, false, true, true, true}));
    EXPECT_EQ(primitives.triangles[0].vertices[0].z, 0.0F) << "a wall stays";
    EXPECT_GT(primitives.triangles[2].vertices[0].z, 0.0F) << "a lamp is before it";
    EXPECT_LT(primitives.triangles[2].vertices[0].z, 1e-5F);
    EXPECT_EQ(primitives.warnings.size(), 2U);
}

TEST(PrimitivesTest, ATriangleHasAlphaIfOneOfItsOwnCornersHas)
{
    Mesh mesh = square(true);
    mesh.colors.assign(mesh.positions.size(), glm::vec4(1.0F));
    mesh.colors[1].a = 0.5F;  // the first triangle's alone
    Scene scene = sceneWith({mesh}, {{"square", 0}});
    scene.materials[0].alphaMode = AlphaMode::Blend;
    EXPECT_EQ(makePrimitives(scene).hasAlpha, (std::vector<bool>{true, false}));
}

TEST(PrimitivesTest, ADoubleSidedLampInAWallIsTwo)
{
    Scene scene = squaresInOnePlace();
    scene.materials[1].doubleSided = true;
    const Primitives primitives = makePrimitives(scene);
    EXPECT_EQ(primitives.firstTriangles, (std::vector<std::uint32_t>{0, 2, 6, 6, 8}));
    EXPECT_EQ(primitives.vertexIndices[3], primitives.vertexIndices[2]);
    EXPECT_EQ(primitives.hasAlpha.size(), 9U);
    EXPECT_GT(primitives.triangles[2].vertices[1].z, 0.0F);
    EXPECT_LT(primitives.triangles[3].vertices[1].z, 0.0F);
}

TEST(PrimitivesTest, LampsApartStayWhereTheyAre)
{
    Scene scene = squaresInOnePlace();
    scene.instances = {{"wall", 0},
                       {"lamp", 1, glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 1e-6))},
                       {"beside", 2, glm::translate(glm::dmat4(1.0), glm::dvec3(1, 0, 0))}};
    const Primitives primitives = makePrimitives(scene);
    EXPECT_EQ(primitives.triangles.size(), 6U);
    EXPECT_EQ(primitives.triangles[2].vertices[0].z, 1e-6F);
    EXPECT_EQ(primitives.triangles[4].vertices[0].z, 0.0F);
    EXPECT_TRUE(primitives.warnings.empty());
}

// Shared meshes' triangles are numbered behind what is left out.
TEST(PrimitivesTest, SharedMeshesFollowWhatIsLeft)
{
    Scene scene = squaresInOnePlace();
    const std::vector<std::uint32_t> once = scene.meshes[0].indices;
    for (int i = 0; i < 4; ++i) {
        std::vector<std::uint32_t>& indices = scene.meshes.change()[0].indices;
        indices.insert(indices.end(), once.begin(), once.end());
        scene.instances.push_back({"more", 0});
    }
    const Primitives primitives = makePrimitives(scene, 0);
    ASSERT_EQ(primitives.sharedMeshes.size(), 1U);
    EXPECT_EQ(primitives.firstTriangles, (std::vector<std::uint32_t>{0, 0, 2, 2, 4, 4, 4, 4, 4}));
    EXPECT_EQ(primitives.sharedMeshes[0].firstId, 5U);
}

// Kernels are compiled for the lobes of what is drawn, not of what the file lists.
TEST(FlattenScene, UnusedMaterialsAddNoFeature)
{
    Scene scene = sceneWith({square(false)}, {{"", 0}});
    scene.materials.resize(2);
    scene.materials[1].transmission = 1.0F;
    scene.materials[1].solid = true;
    scene.materials[1].metallic = scene.materials[1].roughness = 0.0F;
    EXPECT_EQ(flattened(scene).features & kFeatureDielectric, 0U);
    scene.meshes.change()[0].material = 1;
    EXPECT_EQ(flattened(scene).features & kFeatureDielectric, kFeatureDielectric);
    scene.meshes.change()[0].material = 0;
    scene.spheres.push_back({"", glm::vec3(0.0F), 1.0F, 1});
    EXPECT_EQ(flattened(scene).features & kFeatureDielectric, kFeatureDielectric);
}

}  // namespace
}  // namespace glim
