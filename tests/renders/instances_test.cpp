// Scenes whose instances share meshes, against the same scenes with every instance flattened.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/pack_nodes.hpp"
#include "host/render/describe_primitive.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim {
namespace {

FlatScene flattenedWith(const Scene& scene, std::uint64_t maxFlatTriangles, SplitRule rule = SplitRule::Sah)
{
    const Primitives primitives = makePrimitives(scene, maxFlatTriangles);
    return flattenScene(scene, primitives, buildSceneBvh(primitives, rule));
}

// The mesh that was added last, alone.
std::uint32_t addShape(Scene& scene, const Triangles& triangles, std::uint32_t material, const std::vector<glm::vec3>& normals = {})
{
    addMesh(scene, triangles, material, normals);
    scene.instances.pop_back();
    return static_cast<std::uint32_t>(scene.meshes.size() - 1);
}

// A floor, a lamp that two instances share, smooth and angular balls, glass, a sphere of the scene's own and cards that are half
// transparent.
Scene yard()
{
    SceneBuilder builder;
    const auto floor = builder.lambert(glm::vec3(0.6F)), red = builder.lambert(glm::vec3(0.7F, 0.2F, 0.1F));
    const auto metal = builder.lambert(glm::vec3(0.8F)), glass = builder.glass(1.5F), card = builder.lambert(glm::vec3(0.2F, 0.6F, 0.2F));
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(9.0F));
    builder.quad({glm::vec3(-6, 0, 6), {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}}, floor)
        .sphere({-2.6F, 0.5F, 0.4F}, 0.5F, red)
        .environment(glm::vec3(0.2F, 0.3F, 0.4F))
        .perspective({0.5F, 3.0F, 7.0F}, {0, 0.6F, 0}, 0.6F);
    Scene scene = builder.scene();
    scene.materials[metal].metallic = 1.0F;
    scene.materials[metal].roughness = 0.4F;
    scene.materials[card].alphaMode = AlphaMode::Blend;
    scene.materials[card].alpha = 0.5F;
    const Triangles ball = icosphere(2), cards = strips(3, 5);
    const std::uint32_t smooth = addShape(scene, ball, metal, listVertices(ball)), angular = addShape(scene, ball, red);
    const std::uint32_t clear = addShape(scene, icosphere(3), glass), leaves = addShape(scene, cards, card);
    const std::uint32_t light = addShape(scene, icosphere(1), lamp);
    addInstance(scene, smooth, {-1.5, 0.7, -1.0}, 0.4, glm::dvec3(0.7));
    addInstance(scene, smooth, {0.0, 0.6, -1.6}, 1.4, {0.9, 0.6, -0.4});
    addInstance(scene, smooth, {1.6, 0.4, 0.4}, 2.4, {0.2, 0.4, 0.7});
    addInstance(scene, angular, {0.2, 0.35, 1.2}, 0.1, {-0.3, 0.35, 0.3});
    addInstance(scene, angular, {2.6, 0.8, -1.5}, 0.9, glm::dvec3(0.8));
    addInstance(scene, clear, {-0.9, 0.5, 1.0}, 0.0, glm::dvec3(0.45));
    addInstance(scene, clear, {1.0, 0.4, 1.8}, 0.3, {0.5, 0.35, -0.5});
    addInstance(scene, leaves, {-2.0, 1.2, 1.6}, 0.5, glm::dvec3(0.4));
    addInstance(scene, leaves, {2.2, 1.0, 1.4}, 2.0, {0.3, -0.5, 0.4});
    addInstance(scene, light, {-1.5, 3.2, 1.0}, 0.0, glm::dvec3(0.3));
    addInstance(scene, light, {2.0, 3.0, 0.0}, 0.2, {0.4, 0.2, 0.3});
    return scene;
}

TEST(SharedMeshesTest, LookLikeFlattenedOnes)
{
    const Scene scene = yard();
    const FlatScene flat = flattenedWith(scene, 1U << 20), shared = flattenedWith(scene, 0);
    EXPECT_EQ(flat.features & kFeatureInstances, 0U);
    EXPECT_NE(shared.features & kFeatureInstances, 0U);
    EXPECT_LT(shared.primitiveRefs.size(), flat.primitiveRefs.size());
    EXPECT_EQ(shared.lights.size(), flat.lights.size()) << "each lamp of each instance is a light";
    RenderSettings settings = squareSettings(48, samplesFor(256));
    const Film expected = renderFlat(flat, scene.cameras.front(), settings);
    settings.seed = 1;
    const Film film = renderFlat(shared, scene.cameras.front(), settings);
    expectSameMean("shared meshes", film, expected);
    EXPECT_NE(film.identity.settings.find(" meshes=shared"), std::string::npos) << film.identity.settings;
    EXPECT_EQ(expected.identity.settings.find("meshes="), std::string::npos) << expected.identity.settings;
}

// What the first surface is: the same samples of both scenes see the same, but for rays that rounding takes past an edge.
TEST(SharedMeshesTest, HaveTheNormalsAndDepthsOfFlattenedOnes)
{
    Scene scene = yard();
    for (Material& material : scene.materials) {
        material.alphaMode = AlphaMode::Opaque;  // else it is the primitives' ids that decide what a sample sees
    }
    RenderSettings settings = squareSettings(96, 1);
    settings.bounces = 0;
    const Film flat = renderFlat(flattenedWith(scene, 1U << 20), scene.cameras.front(), settings);
    const Film shared = renderFlat(flattenedWith(scene, 0), scene.cameras.front(), settings);
    std::size_t different = 0, covered = 0;
    for (std::size_t i = 0; i < flat.pixels.size(); ++i) {
        const PixelMoments &a = flat.pixels[i], &b = shared.pixels[i];
        covered += std::isfinite(a.depth) ? 1 : 0;
        const bool same = std::isinf(a.depth) ? std::isinf(b.depth)
                                              : std::abs(a.depth - b.depth) <= 1e-5F * a.depth &&
                                                    glm::length(a.normal - b.normal) <= 1e-4F && a.albedo == b.albedo;
        different += same ? 0 : 1;
    }
    std::printf("%zu of %zu pixels differ\n", different, covered);
    EXPECT_GT(covered, 4000U);
    EXPECT_LE(different, 2U);
}

TEST(SharedMeshesTest, DoNotDependOnTheTreeOrTheSchedule)
{
    const Scene scene = yard();
    RenderSettings settings = squareSettings(32, 32);
    settings.schedule = Schedule::Persistent;
    const Film sah = renderFlat(flattenedWith(scene, 0), scene.cameras.front(), settings);
    EXPECT_TRUE(sameBits(sah, renderFlat(flattenedWith(scene, 0, SplitRule::Median), scene.cameras.front(), settings)));
    EXPECT_TRUE(sameBits(sah, renderFlat(flattenedWith(scene, 0, SplitRule::Mean), scene.cameras.front(), settings)));
    settings.schedule = Schedule::Wavefront;
    EXPECT_TRUE(sameBits(sah, renderFlat(flattenedWith(scene, 0), scene.cameras.front(), settings)));
}

// Each reference of an instance has the instance's name and the triangle's number in the mesh.
TEST(SharedMeshesTest, AreNamedByTheirInstances)
{
    PreparedScene prepared;
    prepared.scene = yard();
    for (std::size_t i = 0; i < prepared.scene.instances.size(); ++i) {
        prepared.scene.instances[i].name = std::to_string(i);
    }
    prepared.primitives = makePrimitives(prepared.scene, 0);
    prepared.bvh = buildSceneBvh(prepared.primitives);
    prepared.flat = flattenScene(prepared.scene, prepared.primitives, prepared.bvh);
    std::uint32_t ref = prepared.flat.firstInstanceRef;
    for (const Placement& placement : prepared.primitives.placements) {
        const SharedMesh& mesh = prepared.primitives.sharedMeshes[placement.sharedMesh];
        const MeshTree& tree = prepared.bvh.meshTrees[placement.sharedMesh];
        for (std::uint32_t k = 0; k < tree.entryCount; ++k) {
            const PrimitiveDescription found = describePrimitive(prepared, ref++);
            EXPECT_EQ(found.object, "instance \"" + std::to_string(placement.instance) + "\"");
            ASSERT_TRUE(found.triangle);
            EXPECT_EQ(*found.triangle, prepared.bvh.order[tree.firstEntry + k] - mesh.firstId);
            EXPECT_LT(*found.triangle, mesh.triangles.size());
        }
    }
    EXPECT_GT(prepared.primitives.placements.size(), 5U);
}

// When something else has moved. Trees by another rule tell which are kept.
TEST(SharedMeshesTest, KeepTheirTrees)
{
    Scene scene = yard();
    const Primitives before = makePrimitives(scene, 0);
    const WideBvh sah = buildSceneBvh(before), median = buildSceneBvh(before, SplitRule::Median);
    scene.instances.back().worldFromMesh[3].y += 1.0;  // a lamp, flattened
    scene.instances[1].worldFromMesh[3].x += 0.1;
    scene.meshes.change()[scene.instances[1].mesh].positions[5] *= 1.01;
    const std::uint32_t deformed = scene.instances[1].mesh;
    const Primitives after = makePrimitives(scene, 0);
    const WideBvh fresh = buildSceneBvh(after), kept = updateSceneBvh(sah, before, after);
    EXPECT_EQ(packNodes(kept), packNodes(fresh));
    EXPECT_EQ(kept.order, fresh.order);
    EXPECT_EQ(kept.depth, fresh.depth);
    const WideBvh mixed = updateSceneBvh(median, before, after);
    ASSERT_GT(after.sharedMeshes.size(), 2U);
    for (std::size_t i = 0; i < after.sharedMeshes.size(); ++i) {
        const WideBvh& source = after.sharedMeshes[i].mesh == deformed ? fresh : median;
        const auto orderOf = [i](const WideBvh& bvh) {
            const auto begin = bvh.order.begin() + bvh.meshTrees[i].firstEntry;
            return std::vector<std::uint32_t>(begin, begin + bvh.meshTrees[i].entryCount);
        };
        EXPECT_EQ(orderOf(mixed), orderOf(source)) << i;
    }
}

// A tree that is refitted finds what a new one finds.
TEST(SharedMeshesTest, MoveInARefittedTree)
{
    Scene scene = yard();
    for (const std::uint64_t maxFlat : {std::uint64_t{0}, std::uint64_t{1} << 20U}) {
        const Primitives before = makePrimitives(scene, maxFlat);
        const WideBvh built = buildSceneBvh(before);
        Scene moved = scene;
        for (std::size_t i = 1; i < moved.instances.size(); ++i) {
            moved.instances[i].worldFromMesh[3] += glm::dvec4(i % 2 == 1 ? 0.2 : -0.2, 0.1, 0.05, 0);
        }
        const Primitives primitives = makePrimitives(moved, maxFlat);
        const WideBvh updated = updateSceneBvh(built, before, primitives), fresh = buildSceneBvh(primitives);
        EXPECT_EQ(updated.order, built.order);
        EXPECT_NE(updated.order, fresh.order);
        const FlatScene flat = flattenScene(moved, primitives, updated), other = flattenScene(moved, primitives, fresh);
        EXPECT_EQ(fingerprint(flat), fingerprint(other));
        RenderSettings settings = squareSettings(32, 32);
        settings.schedule = Schedule::Persistent;
        EXPECT_TRUE(sameBits(renderFlat(flat, moved.cameras.front(), settings), renderFlat(other, moved.cameras.front(), settings)))
            << maxFlat;
    }
}

TEST(SharedMeshesTest, AreInTheFingerprint)
{
    Scene scene = yard();
    const std::uint64_t before = fingerprint(flattenedWith(scene, 0));
    EXPECT_NE(before, fingerprint(flattenedWith(scene, 1U << 20)));
    EXPECT_EQ(before, fingerprint(flattenedWith(scene, 0, SplitRule::Median)));
    scene.instances[1].worldFromMesh[3].x += 1e-3;
    EXPECT_NE(before, fingerprint(flattenedWith(scene, 0)));
}

}  // namespace
}  // namespace glim
