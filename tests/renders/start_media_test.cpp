// Rays that begin within solids: a camera in water, a lamp in glass. What is left of light after d metres is exp(-absorption d).
#include "host/flatten/start_media.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/caustic_films.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim {
namespace {

// Left after a metre.
const glm::dvec3 kThin(0.1, 0.5, 0.9), kDense(0.3, 0.2, 0.05);

Material getMedium(const glm::dvec3& afterAMetre)
{
    Material m;
    m.transmission = 1.0F;
    m.solid = true;
    m.metallic = m.roughness = 0.0F;
    m.ior = 1.0F;
    m.absorption = glm::vec3(-glm::log(afterAMetre));
    return m;
}

std::uint32_t addMedium(Scene& scene, const glm::dvec3& afterAMetre)
{
    scene.materials.push_back(getMedium(afterAMetre));
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void addBall(Scene& scene, float radius, std::uint32_t material, const glm::vec3& center = glm::vec3(0.0F))
{
    Sphere sphere;
    sphere.center = center;
    sphere.radius = radius;
    sphere.material = material;
    scene.spheres.push_back(sphere);
}

// The box between two corners, fronts outwards. As triangles, each half of them a mesh of its own.
void addBox(Scene& scene, const glm::vec3& low, const glm::vec3& high, std::uint32_t material)
{
    const auto corner = [&](int i) {
        return glm::vec3((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y, (i & 4) != 0 ? high.z : low.z);
    };
    constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    Triangles halves[2];
    for (const auto& f : kFaces) {
        halves[0].push_back({{corner(f[0]), corner(f[1]), corner(f[2])}});
        halves[1].push_back({{corner(f[0]), corner(f[2]), corner(f[3])}});
    }
    for (const Triangles& half : halves) {
        addMesh(scene, half, material);
    }
}

Scene lookingAlongZ(float yfov = 1e-3F)
{
    SceneBuilder builder;
    builder.environment(glm::vec3(1.0F)).perspective({0, 0, 0}, {0, 0, -1}, yfov);
    return builder.scene();
}

// The field of view is so narrow that all ways are as long, to within 1.3e-7.
void expectPixels(const Film& film, const glm::dvec3& truth)
{
    for (const PixelMoments& pixel : film.pixels) {
        for (int c = 0; c < 3; ++c) {
            ASSERT_NEAR(pixel.mean[c], truth[c], 4e-6 * truth[c]);
        }
    }
}

TEST(StartMediaTest, ACameraInABallSeesThroughIt)
{
    Scene scene = lookingAlongZ();
    addBall(scene, 1.0F, addMedium(scene, kThin));
    expectPixels(renderScene(scene, squareSettings(8, 8)), kThin);
}

TEST(StartMediaTest, ACameraInABoxSeesThroughIt)
{
    Scene scene = lookingAlongZ();
    addBox(scene, {-3, -3, -1}, {2, 2, 2}, addMedium(scene, kThin));
    expectPixels(renderScene(scene, squareSettings(8, 8)), kThin);
}

// A lamp under water, and a solid beyond the opaque wall behind it.
TEST(StartMediaTest, LampsUnderWaterAreSeenThroughIt)
{
    Scene scene = lookingAlongZ();
    const std::uint32_t water = addMedium(scene, kThin);
    scene.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(2.0F)));
    addMesh(scene, {{{glm::vec3(-1, -1, -1), {1, -1, -1}, {0, 1, -1}}}}, water + 1);
    addBox(scene, {-9, -9, -9}, {9, 9, 9}, water);
    expectPixels(renderScene(scene, squareSettings(8, 8)), 2.0 * kThin);
}

// The innermost medium counts, and the outer one beyond it; mirrored instances keep their fronts.
TEST(StartMediaTest, NestedSolidsAreLeftInTheirOrder)
{
    Scene scene = lookingAlongZ();
    const std::uint32_t outer = addMedium(scene, kThin), inner = addMedium(scene, kDense);
    addBox(scene, {-2, -2, -1}, {2, 2, 3}, outer);
    addBox(scene, {-1, -1, -0.5F}, {1, 1, 0.25F}, inner);
    for (MeshInstance& instance : scene.instances) {
        instance.worldFromMesh[0].x = -1.0;
    }
    expectPixels(renderScene(scene, squareSettings(8, 8)), glm::sqrt(kThin * kDense));
}

// The left half of the window lies in the box.
TEST(StartMediaTest, AWindowAcrossABoundarySeesBoth)
{
    SceneBuilder builder;
    builder.environment(glm::vec3(1.0F)).orthographic({0, 0, 0}, {0, 0, -1}, 0.5F);
    Scene scene = builder.scene();
    addBox(scene, {-2, -2, -1}, {0, 2, 2}, addMedium(scene, kThin));
    constexpr std::uint32_t kMediaSide = 8;
    const Film film = renderScene(scene, squareSettings(kMediaSide, 8));
    for (std::uint32_t i = 0; i < kMediaSide * kMediaSide; ++i) {
        for (int c = 0; c < 3; ++c) {
            const double truth = i % kMediaSide < kMediaSide / 2 ? kThin[c] : 1.0;
            EXPECT_NEAR(film.pixels[i].mean[c], truth, 4e-6) << i;
        }
    }
}

// Half of the lens lies in the box. Its rays are all but parallel.
TEST(StartMediaTest, ALensAcrossABoundarySeesBoth)
{
    Scene scene = lookingAlongZ();
    addBox(scene, {-2, -2, -1}, {0, 2, 2}, addMedium(scene, kThin));
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = placeInMedia(flattenCamera(scene.cameras.front(), 1.0F, {0.1F, 1e6F}), flat);
    EXPECT_EQ(camera.media, kMediaVary);
    RenderSettings settings = squareSettings(16, 64);
    expectMean("half a lens in a box", renderCaustics(flat, camera, settings, true), 0.5 + 0.5 * kThin);
}

TEST(StartMediaTest, TheHostKnowsWhereACameraIs)
{
    Scene scene = lookingAlongZ();
    const std::uint32_t outer = addMedium(scene, kThin), inner = addMedium(scene, kDense);
    addBox(scene, {-2, -2, -2}, {2, 2, 2}, outer);
    addBall(scene, 1.0F, inner, {0.5F, 0, 0});
    const FlatScene flat = flattened(scene);
    const auto mediaAt = [&](const glm::vec3& position, const Lens& lens = {}) {
        Camera camera = scene.cameras.front();
        camera.position = position;
        return placeInMedia(flattenCamera(camera, 1.0F, lens), flat).media;
    };
    const uint water = flat.mediumOfMaterial[outer], ball = flat.mediumOfMaterial[inner];
    EXPECT_EQ(mediaAt({0, 0, 0}), ball | water << kMediumBits);
    EXPECT_EQ(mediaAt({-1.5F, 1, 0}), water);
    EXPECT_EQ(mediaAt({1.9F, 1.9F, -1.9F}), water);
    EXPECT_EQ(mediaAt({2.1F, 0, 0}), 0U);
    EXPECT_EQ(mediaAt({0, 300, 0}), 0U);
    EXPECT_EQ(mediaAt({-1.5F, 1, 0}, {0.1F, 1.0F}), water);
    EXPECT_EQ(mediaAt({-1.95F, 1, 0}, {0.1F, 1.0F}), kMediaVary);
    EXPECT_EQ(mediaAt({1.45F, 0, 0}, {0.1F, 1.0F}), kMediaVary);
}

// What rays never meet is no solid: what is transparent all over, and what an opaque lamp in the same place hides.
TEST(StartMediaTest, HiddenOrTransparentSolidsDoNotCount)
{
    Scene scene = lookingAlongZ();
    const std::uint32_t water = addMedium(scene, kThin), clear = addMedium(scene, kDense);
    scene.materials[clear].alphaMode = AlphaMode::Blend;
    scene.materials[clear].alpha = 0.0F;
    scene.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(2.0F), true));
    addBox(scene, {-1, -1, -1}, {1, 1, 1}, clear);
    addBall(scene, 0.5F, water);
    addBall(scene, 0.5F, clear + 1);
    addBall(scene, 0.5F, water, {0, 5, 0});
    const FlatScene flat = flattened(scene);
    const auto mediaAt = [&](const glm::vec3& position) {
        Camera camera = scene.cameras.front();
        camera.position = position;
        return placeInMedia(flattenCamera(camera, 1.0F), flat).media;
    };
    EXPECT_NE(flat.features & kFeatureMedia, 0U);
    EXPECT_EQ(mediaAt({0, 0, 0}), 0U);
    EXPECT_EQ(mediaAt({0.9F, 0, 0}), 0U);
    EXPECT_EQ(mediaAt({0, 5, 0}), flat.mediumOfMaterial[water]);
    expectPixels(renderScene(scene, squareSettings(8, 8)), glm::dvec3(2.0));
}

// Light paths look for their media only where a lamp may lie in some.
TEST(StartMediaTest, LampsBetweenSolidsAreInNone)
{
    for (const float y : {0.0F, 3.0F}) {
        Scene scene = lookingAlongZ();
        const std::uint32_t water = addMedium(scene, kThin);
        scene.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(2.0F)));
        addBall(scene, 1.0F, water, {0, 3, 0});
        addBall(scene, 1.0F, water, {0, -3, 0});
        addBall(scene, 0.1F, water + 1, {0, y, 0});
        EXPECT_EQ((flattened(scene).features & kFeatureLightsInMedia) != 0, y != 0.0F);
    }
}

// An instance of a shared mesh, turned inside out and back, is where it is.
TEST(StartMediaTest, InstancesAreSolidsTooWhereTheyArePlaced)
{
    Scene scene = lookingAlongZ();
    addBox(scene, {-1, -1, -1}, {1, 1, 1}, addMedium(scene, kThin));
    const std::vector<MeshInstance> halves = scene.instances;
    for (const double x : {-10.0, 10.0}) {
        for (MeshInstance instance : halves) {
            instance.worldFromMesh[3].x = x;
            instance.worldFromMesh[0].x = x < 0.0 ? -2.0 : 2.0;
            scene.instances.push_back(instance);
        }
    }
    const Primitives primitives = makePrimitives(scene, 0);
    const FlatScene flat = flattenScene(scene, primitives, buildSceneBvh(primitives, SplitRule::Sah));
    ASSERT_EQ(primitives.placements.size(), 6U);
    for (const auto& [x, isInside] : {std::pair(0.9F, true), {1.1F, false}, {-11.9F, true}, {-12.1F, false}, {8.1F, true}, {7.9F, false}}) {
        Camera camera = scene.cameras.front();
        camera.position = {x, 0.1F, 0.2F};
        EXPECT_EQ(placeInMedia(flattenCamera(camera, 1.0F), flat).media, isInside ? 1U : 0U) << x;
    }
}

// Nobody tracks media where nothing absorbs: the camera's word stays 0, and so do the bits.
TEST(StartMediaTest, GlassThatAbsorbsNothingIsNotTracked)
{
    Scene scene = lookingAlongZ();
    addBall(scene, 1.0F, addMedium(scene, glm::dvec3(1.0)));
    const FlatScene flat = flattened(scene);
    EXPECT_EQ(flat.features & (kFeatureMedia | kFeatureLightsInMedia), 0U);
    EXPECT_EQ(placeInMedia(flattenCamera(scene.cameras.front(), 1.0F, {10.0F, 1.0F}), flat).media, 0U);
}

}  // namespace
}  // namespace glim
