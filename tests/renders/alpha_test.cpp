// Surfaces that are transparent in places: whatever the tree and the schedule, and as calculated where that is possible. Normal maps too.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;

// White, with these alphas; rows from the top.
DecodedImage alphaImage(std::uint32_t width, const std::vector<std::uint8_t>& alphas)
{
    DecodedImage image;
    image.width = width;
    image.height = static_cast<std::uint32_t>(alphas.size()) / width;
    for (const std::uint8_t alpha : alphas) {
        image.rgba8.insert(image.rgba8.end(), {255, 255, 255, alpha});
    }
    return image;
}

DecodedImage randomAlpha(std::uint32_t side, std::uint64_t seed)
{
    Random random(seed);
    std::vector<std::uint8_t> alphas(std::size_t{side} * side);
    for (std::uint8_t& alpha : alphas) {
        alpha = static_cast<std::uint8_t>(random.below(256));
    }
    return alphaImage(side, alphas);
}

// Coordinates of the mesh's corners, from (0, 0) to `repeats`.
void setQuadUvs(Mesh& mesh, float repeats)
{
    const glm::vec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    mesh.uv0.clear();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.uv0.push_back(repeats * corners[i % 6]);
    }
}

// Strips aslant, some of a leaf's mask and some like smoked glass, through a ball of small triangles: their tree is one of pieces, and
// rays pass several of them one behind the other.
Scene cardsInFrontOfCards()
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F)), masked = builder.lambert(glm::vec3(0.3F, 0.6F, 0.2F)),
               blended = builder.lambert(glm::vec3(0.6F, 0.3F, 0.2F)), lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(8.0F), true);
    builder.sphere({1.0F, -0.2F, 1.5F}, 0.3F, blended).sphere({-1.2F, 0.8F, 1.5F}, 0.1F, lamp);
    for (int i = 0; i < 24; ++i) {
        const float x = 0.15F * static_cast<float>(i) - 1.65F;
        builder.quad({glm::vec3(x, -1.7F, -1.6F), {x + 0.06F, -1.7F, -1.6F}, {x + 0.56F, 1.6F, 1.7F}, {x + 0.5F, 1.6F, 1.7F}},
                     i % 3 == 0 ? masked : blended);
    }
    builder.environment(glm::vec3(0.3F)).perspective({0, 1, 4}, {0, 0, 0}, 0.7F);
    Scene scene = builder.scene();
    for (Mesh& mesh : scene.meshes.change()) {
        setQuadUvs(mesh, 3.0F);
        for (std::size_t i = 0; mesh.material == blended && i < mesh.positions.size(); ++i) {
            mesh.colors.emplace_back(1.0F, 1.0F, 1.0F, 0.25F * static_cast<float>(i % 4) + 0.25F);
        }
    }
    addMesh(scene, icosphere(3), white);
    scene.images.push_back({"leaf", randomAlpha(8, 1)});
    scene.images.push_back({"smoke", randomAlpha(4, 2)});
    scene.materials[masked].alphaMode = AlphaMode::Mask;
    scene.materials[masked].textures[kSlotBaseColor].emplace();
    scene.materials[blended].alphaMode = AlphaMode::Blend;
    scene.materials[blended].alpha = 0.8F;
    scene.materials[blended].textures[kSlotBaseColor].emplace().image = 1;
    return scene;
}

// No primitive is left, and rays meet the sky.
TEST(AlphaTest, AScenesOnlySurfaceMayBeTransparentAllOver)
{
    SceneBuilder builder;
    const auto clear = builder.lambert(glm::vec3(0.5F));
    builder.cube(1.0F, clear, false).environment(glm::vec3(0.25F)).perspective({0, 0, 5}, {0, 0, 0}, 0.3F);
    Scene scene = builder.scene();
    scene.materials[clear].alphaMode = AlphaMode::Blend;
    scene.materials[clear].alpha = 0.0F;
    const FlatScene flat = flattened(scene);
    EXPECT_EQ(flat.primitiveRefs.size(), 0U);
    EXPECT_EQ(flat.nodes.size(), kNodeTexels) << "a root";
    for (const PixelMoments& pixel : renderFlat(flat, scene.cameras.front(), squareSettings(4, 2)).pixels) {
        EXPECT_EQ(pixel.mean, glm::vec3(0.25F));
    }
}

TEST(AlphaTest, CardsInFrontOfCardsWhateverTheTree)
{
    const Scene scene = cardsInFrontOfCards();
    const Primitives primitives = makePrimitives(scene);
    EXPECT_GT(buildSceneBvh(primitives).order.size(), primitives.count() + 10) << "the tree is not one of pieces";
    const FlatScene pieces = flattened(scene);
    EXPECT_NE(pieces.features & kFeatureAlpha, 0U);
    RenderSettings settings = squareSettings(24, 32);
    const Film film = renderFlat(pieces, scene.cameras.front(), settings);
    settings.schedule = Schedule::Persistent;
    EXPECT_TRUE(sameBits(renderFlat(flattened(scene, SplitRule::Median), scene.cameras.front(), settings), film));
}

// A floor under a lamp that is a point, with cards between them; the camera looks from below the cards. The factors of all cards multiply,
// without noise.
TEST(AlphaTest, ShadowsOfCardsMultiply)
{
    SceneBuilder builder;
    const auto floor = builder.lambert(glm::vec3(0.5F));
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, floor);
    std::vector<std::uint32_t> cards;
    for (int i = 0; i < 6; ++i) {
        const float y = 1.0F + 0.1F * static_cast<float>(i);
        cards.push_back(builder.lambert(glm::vec3(0.2F), glm::vec3(0.0F), true));
        builder.quad({glm::vec3(-1, y, 1), {1, y, 1}, {1, y, -1}, {-1, y, -1}}, cards.back());
    }
    builder.light({"", PunctualLight::Kind::Point, {0.0F, 2.0F, 0.0F}, {0, 0, -1}, glm::vec3(7.0F)})
        .orthographic({0.03F, 0.05F, 0.02F}, {0, 0, 0}, 1e-3F);
    Scene scene = builder.scene();
    for (const std::uint32_t card : cards) {
        scene.materials[card].alphaMode = AlphaMode::Blend;
    }
    double through = 1.0;
    const auto setAlpha = [&](std::size_t card, float alpha) {
        scene.materials[cards[card]].alpha = alpha;
        return 1.0 - static_cast<double>(alpha);
    };
    through *= setAlpha(0, 0.3F);
    // A texture whose alpha is 51 and 204 by halves: .5 where they meet, in the middle of the card. Factor .8: .4.
    setAlpha(1, 0.8F);
    scene.images.push_back({"halves", alphaImage(2, {51, 204})});
    scene.materials[cards[1]].textures[kSlotBaseColor].emplace();
    setQuadUvs(scene.meshes.change()[2], 1.0F);
    through *= 1.0 - 0.8 * 0.5;
    // The colour of a vertex: .2 and .6, so .4 in the middle.
    setAlpha(2, 1.0F);
    for (const float alpha : {0.2F, 0.6F, 0.6F, 0.2F, 0.6F, 0.2F}) {
        scene.meshes.change()[3].colors.emplace_back(0.5F, 0.5F, 0.5F, alpha);
    }
    through *= 0.6;
    // Both, and a factor.
    through *= 1.0 - 0.5 * 0.5 * 0.4;
    setAlpha(3, 0.5F);
    scene.materials[cards[3]].textures[kSlotBaseColor] = scene.materials[cards[1]].textures[kSlotBaseColor];
    setQuadUvs(scene.meshes.change()[4], 1.0F);
    scene.meshes.change()[4].colors = scene.meshes[3].colors;
    // A mask below its cutoff is not there, one whose factor is 0 neither.
    setAlpha(4, 0.49F);
    scene.materials[cards[4]].alphaMode = AlphaMode::Mask;
    setAlpha(5, 0.0F);
    RenderSettings settings = squareSettings(16, 4);
    settings.bounces = 1;
    settings.schedule = Schedule::Persistent;
    const double truth = 0.5 / kPi * 7.0 / 4.0 * through;
    const MeanEstimate mean = meanOf(renderScene(scene, settings));
    // The spot is 2 mm wide: alphas change by 1e-3 over it, and by less in the mean.
    EXPECT_NEAR(mean.mean.g / truth, 1.0, 1e-4);
    std::printf("shadow of six cards: %.6g, truth %.6g\n", mean.mean.g, truth);
    // An opaque mask lets nothing through.
    setAlpha(4, 0.5F);
    EXPECT_EQ(meanOf(renderScene(scene, settings)).mean.g, 0.0);
}

// What the camera and light by chance see through a card is what shadow rays see: coverage in the mean.
TEST(AlphaTest, TexturesAndVertexAlphaAreCoverageToTheCamera)
{
    SceneBuilder builder;
    builder.quad({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, builder.lambert(glm::vec3(0.0F)))
        .environment(glm::vec3(1.0F))
        .orthographic({0, 0, 3}, {0, 0, 0}, 1.0F);
    Scene scene = builder.scene();
    scene.materials[0].alphaMode = AlphaMode::Blend;
    scene.materials[0].alpha = 0.8F;
    scene.materials[0].textures[kSlotBaseColor].emplace();
    scene.materials[0].textures[kSlotBaseColor]->nearest = true;
    const DecodedImage image = randomAlpha(4, 3);
    double mean = 0.0;
    for (std::size_t i = 0; i < 16; ++i) {
        mean += image.rgba8[4 * i + 3] / 255.0 / 16.0;
    }
    scene.images.push_back({"alphas", image});
    setQuadUvs(scene.meshes.change()[0], 4.0F);  // so that the texture and the vertices' gradient are all but independent
    for (int i = 0; i < 6; ++i) {
        scene.meshes.change()[0].colors.emplace_back(1.0F, 1.0F, 1.0F, 0.5F);
    }
    RenderSettings settings = squareSettings(64, samplesFor(64));
    settings.schedule = Schedule::Persistent;
    expectMean("a card of texture, vertex and factor", renderScene(scene, settings), glm::dvec3(1.0 - 0.8 * 0.5 * mean));
}

DecodedImage normalImage(const std::vector<glm::u8vec3>& texels)
{
    DecodedImage image;
    image.width = static_cast<std::uint32_t>(texels.size());
    image.height = 1;
    for (const glm::u8vec3& t : texels) {
        image.rgba8.insert(image.rgba8.end(), {t.x, t.y, t.z, 255});
    }
    return image;
}

// A quad that faces the camera at an angle, with tangents, under a sky with a lamp.
Scene mappedQuad(const Material& material, const glm::vec3& camera)
{
    SceneBuilder builder;
    builder.quad({{{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}}}, builder.lambert(glm::vec3(0.0F)))
        .environment(glm::vec3(1.0F))
        .orthographic(camera, {0, 0, 0}, 0.5F);
    Scene scene = builder.scene();
    scene.materials[0] = material;
    setQuadUvs(scene.meshes.change()[0], 5.0F);
    scene.meshes.change()[0].tangents.assign(6, glm::vec4(1, 0, 0, 1));
    scene.meshes.change()[0].normals.assign(6, glm::dvec3(0, 0, 1));
    return scene;
}

Material glossy(float metallic, float roughness)
{
    Material material;
    material.baseColor = glm::vec3(0.9F);
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

// Two ways to be flat: a scale of 0, and texels of 127 and 128 half and half.
TEST(AlphaTest, AFlatNormalMapIsNone)
{
    Material material = glossy(0.5F, 0.3F);
    Scene plain = mappedQuad(material, {1, 0.5F, 3});
    plain.environment->radiance = glm::vec3(0.2F);
    plain.spheres.push_back({"", {1.0F, 1.5F, 2.0F}, 0.5F, 1});
    plain.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(10.0F)));
    material.textures[kSlotNormal].emplace();
    material.normalScale = 0.0F;
    Scene scaled = plain;
    scaled.materials[0] = material;
    scaled.images.push_back({"bumps", normalImage({{255, 10, 200}, {3, 90, 250}, {128, 128, 255}})});
    Scene halves = plain;
    material.normalScale = 1.0F;
    halves.materials[0] = material;
    halves.images.push_back({"halves", normalImage({{127, 127, 255}, {128, 128, 255}})});
    halves.meshes.change()[0].uv0.assign(6, glm::vec2(0.5F, 0.0F));
    RenderSettings settings = squareSettings(32, 32);
    settings.schedule = Schedule::Persistent;
    const Film expected = renderScene(plain, settings);
    for (const Scene& scene : {scaled, halves}) {
        const FlatScene flat = flattened(scene);
        EXPECT_NE(flat.features & kFeatureNormalMaps, 0U);
        const Film film = renderFlat(flat, scene.cameras[0], settings);
        double worst = 0.0;
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {
            worst = std::max(worst, std::abs(static_cast<double>(film.pixels[i].mean.g / expected.pixels[i].mean.g) - 1.0));
        }
        std::printf("a flat normal map: pixels off by %.1e at most\n", worst);
        EXPECT_LE(worst, 1e-6);
    }
}

// Normals that point away from the camera, along the surface, below it, or nowhere, in strips: no pixel is black, none brighter than the
// sky.
TEST(AlphaTest, H47NormalMapsThatPointAway)
{
    const std::pair<const char*, glm::u8vec3> maps[] = {{"backwards", {128, 128, 0}},
                                                        {"along the surface", {255, 128, 128}},
                                                        {"away from the camera", {0, 128, 140}},
                                                        {"below", {10, 10, 60}},
                                                        {"hardly anywhere", {128, 128, 128}}};
    const std::pair<float, float> materials[] = {{1.0F, 0.0F}, {1.0F, 0.3F}, {0.0F, 0.5F}};
    constexpr std::uint32_t kStrips = 15, kRows = 2, kColumns = 16;
    for (const glm::vec3& view : {glm::vec3(3, 0, 0.3F), glm::vec3(1, 0, 1)}) {
        SceneBuilder builder;
        for (std::uint32_t i = 0; i < kStrips; ++i) {
            const float y = static_cast<float>(i) / kStrips - 0.5F, top = y + 1.0F / kStrips;
            builder.quad({{{-9, y, 0}, {9, y, 0}, {9, top, 0}, {-9, top, 0}}}, builder.lambert(glm::vec3(0.0F)));
        }
        builder.environment(glm::vec3(1.0F)).orthographic(view, {0, 0, 0}, 0.5F);
        Scene scene = builder.scene();
        for (std::uint32_t i = 0; i < kStrips; ++i) {
            scene.materials[i] = glossy(materials[i / 5].first, materials[i / 5].second);
            scene.materials[i].textures[kSlotNormal].emplace().image = i % 5;
            setQuadUvs(scene.meshes.change()[i], 1.0F);
            scene.meshes.change()[i].tangents.assign(6, glm::vec4(1, 0, 0, 1));
        }
        for (const auto& [name, texel] : maps) {
            scene.images.push_back({name, normalImage({texel, texel})});
        }
        RenderSettings settings = squareSettings(kColumns, samplesFor(256));
        settings.height = kRows * kStrips;
        const Film film = renderScene(scene, settings);
        double least = 1e9, most = 0.0;
        for (std::uint32_t i = 0; i < kStrips; ++i) {
            Film strip;
            const auto first = film.pixels.begin() + std::ptrdiff_t{kStrips - 1 - i} * kRows * kColumns;
            strip.pixels.assign(first, first + kRows * kColumns);
            const MeanEstimate mean = meanOf(strip);
            EXPECT_LE(mean.mean.g, 1.0 + 5.0 * mean.standardError.g + 3e-3) << maps[i % 5].first << ", material " << i / 5;
            for (const PixelMoments& pixel : strip.pixels) {
                EXPECT_GT(pixel.mean.g, 0.25F) << maps[i % 5].first << ", material " << i / 5;
            }
            least = std::min(least, mean.mean.g);
            most = std::max(most, mean.mean.g);
            std::printf("normal %s, material %u: %.4f +- %.4f\n", maps[i % 5].first, i / 5, mean.mean.g, mean.standardError.g);
        }
        printHardCase("H47", "normal maps that point away, seen from " + figure(view.z < 1.0F ? 6.0 : 45.0) + " degrees",
                      1.0 * kStrips * kRows * kColumns * settings.sampleEnd,
                      "reflects " + figure(least) + " to " + figure(most) + ", no black pixel");
    }
}

// White under a coat that is tilted by 40 degrees away from a camera at 45: it would reflect .65 of the light, into the surface. What the
// coat takes of light from other directions is left.
TEST(AlphaTest, ACoatThatReflectsIntoTheSurfaceLeavesTheLightToTheBase)
{
    SceneBuilder builder;
    builder.quad({{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}}, builder.lambert(glm::vec3(1.0F)))
        .environment(glm::vec3(1.0F))
        .orthographic({1, 0, 1}, {0, 0, 0}, 0.5F);
    Scene scene = builder.scene();
    scene.materials[0].clearcoat = 1.0F;
    scene.materials[0].clearcoatRoughness = 0.1F;
    scene.materials[0].textures[kSlotClearcoatNormal].emplace().image = 0;
    setQuadUvs(scene.meshes.change()[0], 1.0F);
    scene.meshes.change()[0].tangents.assign(6, glm::vec4(1, 0, 0, 1));
    scene.images.push_back({"tilted", normalImage({{46, 128, 225}, {46, 128, 225}})});
    const MeanEstimate mean = meanOf(renderScene(scene, squareSettings(16, samplesFor(256))));
    std::printf("white under a coat that reflects into it: %.4f +- %.4f\n", mean.mean.g, mean.standardError.g);
    EXPECT_GT(mean.mean.g, 0.85);
    EXPECT_LE(mean.mean.g, 1.0 + 5.0 * mean.standardError.g);
}

}  // namespace
}  // namespace glim
