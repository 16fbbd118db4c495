// Hard cases of materials and textures: at grazing angles, next to limits, and in great numbers.
#include "host/scene/make_studio.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"
#include "tests/support/wrapped_texel.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>

namespace glim {
namespace {

std::string describeMaterial(const MeanEstimate& mean) { return figure(mean.mean.g) + " +- " + figure(mean.standardError.g); }

double samplesOf(const RenderSettings& settings) { return 1.0 * settings.width * settings.height * settings.sampleEnd; }

Material matt(bool nearest, Wrap wrap = Wrap::Repeat)
{
    Material material = makeLambert(glm::vec3(1.0F));
    Texture& texture = material.textures[kSlotBaseColor].emplace();
    texture.nearest = nearest;
    texture.wrapS = texture.wrapT = wrap;
    return material;
}

DecodedImage greyImage(std::uint32_t width, std::uint32_t height, const std::function<std::uint8_t(std::uint32_t, std::uint32_t)>& code)
{
    DecodedImage image;
    image.width = width;
    image.height = height;
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint8_t c = code(x, y);
            image.rgba8.insert(image.rgba8.end(), {c, c, c, 255});
        }
    }
    return image;
}

double meanAlbedo(const DecodedImage& image)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < image.rgba8.size(); i += 4) {
        sum += test::linearFromSrgb(image.rgba8[i] / 255.0);
    }
    return sum / (static_cast<double>(image.rgba8.size()) / 4.0);
}

// The part of a film that is `width` x `height` pixels from column x and row y on.
Film partOf(const Film& film, std::uint32_t across, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height)
{
    Film part;
    for (std::uint32_t row = y; row < y + height; ++row) {
        const auto first = film.pixels.begin() + std::ptrdiff_t{row} * across + x;
        part.pixels.insert(part.pixels.end(), first, first + width);
    }
    return part;
}

// By one schedule: others compare the two.
RenderSettings persistent(std::uint32_t width, std::uint32_t height, std::uint32_t spp)
{
    RenderSettings settings;
    settings.width = width;
    settings.height = height;
    settings.sampleEnd = samplesFor(spp);
    settings.schedule = Schedule::Persistent;
    return settings;
}

// A textured tile of 1 m that fills a square of the picture exactly.
struct Tile {
    const char *number, *name;
    DecodedImage image;
    Material material;
    glm::vec2 firstUv, lastUv;
    const char* naive = "";
};

constexpr std::uint32_t kTilePixels = 32;

// Side by side under a sky of radiance 1: a pixel is the mean albedo of what it sees, without noise where that is one colour.
Scene rowOf(const std::vector<Tile>& tiles)
{
    SceneBuilder builder;
    const float count = static_cast<float>(tiles.size());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const float x = static_cast<float>(i);
        builder.quad({{{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}}}, builder.lambert(glm::vec3(1.0F)));
    }
    builder.environment(glm::vec3(1.0F)).orthographic({0.5F * count, 0.5F, 3.0F}, {0.5F * count, 0.5F, 0.0F}, 0.5F);
    Scene scene = builder.scene();
    scene.cameras[0].halfWidth = 0.5F * count;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        scene.images.push_back({tiles[i].name, tiles[i].image});
        scene.materials[i] = tiles[i].material;
        scene.materials[i].textures[kSlotBaseColor]->image = static_cast<std::uint32_t>(i);
        Mesh& mesh = scene.meshes.change()[i];
        for (const glm::dvec3& p : mesh.positions) {
            const glm::vec2 at(static_cast<float>(p.x) - static_cast<float>(i), 1.0F - static_cast<float>(p.y));
            mesh.uv0.push_back(glm::mix(tiles[i].firstUv, tiles[i].lastUv, at));
        }
    }
    return scene;
}

TEST(HardMaterialTest, H36H46TexturesThatAreHardToSample)
{
    Random random(4);
    const DecodedImage steps =
        greyImage(4, 4, [](std::uint32_t x, std::uint32_t y) { return static_cast<std::uint8_t>(60 * ((x + y) % 4) + 20); });
    const DecodedImage wide =
        greyImage(16384, 1, [&random](std::uint32_t, std::uint32_t) { return static_cast<std::uint8_t>(random.below(256)); });
    const DecodedImage checker = greyImage(
        kTilePixels, kTilePixels, [](std::uint32_t x, std::uint32_t y) { return static_cast<std::uint8_t>((x + y) % 2 == 0 ? 255 : 0); });
    const float half = 0.5F / kTilePixels, more = 34.0F / kTilePixels;
    const std::vector<Tile> tiles = {
        {"H36", "texture coordinates of 1e5", steps, matt(false), {100000, -100004}, {100004, -100000}},
        {"H36", "the same, mirrored", steps, matt(false, Wrap::Mirrored), {100000, -100004}, {100004, -100000}},
        {"H36", "a texture of 16,384 x 1", wide, matt(false), {0, 0}, {1, 1}},
        {"H36", "the same, nearest", wide, matt(true), {0, 0}, {1, 1}},
        {"H46", "a checker, a texel for each pixel", checker, matt(true), {0, 0}, {1, 1}},
        {"H46",
         "the same, shifted by half a pixel",
         checker,
         matt(true),
         {half, half},
         {1 + half, 1 + half},
         "one sample at each pixel's centre: all black or all white"},
        {"H46", "the same, bilinear", checker, matt(false), {half, half}, {1 + half, 1 + half}},
        {"H46", "texels of .94 pixels", checker, matt(true), {0, 0}, {more, more}}};
    const auto across = kTilePixels * static_cast<std::uint32_t>(tiles.size());
    RenderSettings settings = persistent(across, kTilePixels, 64);
    const Film film = renderScene(rowOf(tiles), settings);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const Film tile = partOf(film, across, kTilePixels * static_cast<std::uint32_t>(i), 0, kTilePixels, kTilePixels);
        const double truth = meanAlbedo(tiles[i].image);
        const MeanEstimate mean = meanOf(tile);
        printHardCase(tiles[i].number, tiles[i].name, 1024.0 * settings.sampleEnd,
                      "mean off by " + figure(mean.mean.g / truth - 1.0) + " +- " + figure(mean.standardError.g / truth), tiles[i].naive);
        expectMean(tiles[i].name, tile, glm::dvec3(truth));
    }
    double leaks = 0.0;
    const Film aligned = partOf(film, across, kTilePixels * 4, 0, kTilePixels, kTilePixels);
    for (std::uint32_t i = 0; i < kTilePixels * kTilePixels; ++i) {
        const float expected = (i % kTilePixels + i / kTilePixels) % 2 == 0 ? 1.0F : 0.0F;
        leaks += std::abs(aligned.pixels[i].mean.g - expected) <= 1e-5F ? 0.0 : 1.0;
    }
    EXPECT_LE(leaks, 10.0) << "pixels with light of another texel; a sample in 2^18 rounds onto an edge between texels";
}

// A plane of strips, each of a material, seen along it in a white furnace.
TEST(HardMaterialTest, H20GrazingGgx)
{
    std::vector<Material> materials;
    for (const float metallic : {1.0F, 0.0F}) {
        for (const float roughness : {0.04F, 0.3F, 1.0F}) {
            Material& material = materials.emplace_back();
            material.metallic = metallic;
            material.roughness = roughness;
        }
    }
    constexpr std::uint32_t kStrip = 4;  // pixels
    const RenderSettings settings = persistent(kStrip * 6, 16, 512);
    std::vector<double> least(6, 1e9), most(6, 0.0);
    for (const float degrees : {3.0F, 0.1F, 1e-3F}) {
        const float slope = degrees * static_cast<float>(std::numbers::pi) / 180.0F;
        SceneBuilder builder;
        for (int i = 0; i < 6; ++i) {
            const float x = static_cast<float>(i);
            builder.quad({glm::vec3(x, 0, 1e3F), {x + 1, 0, 1e3F}, {x + 1, 0, -1e3F}, {x, 0, -1e3F}}, builder.lambert(glm::vec3(1.0F)));
        }
        builder.environment(glm::vec3(1.0F)).orthographic({3, 10.0F * slope, 10.0F}, {3, 0, 0}, 0.1F * slope);
        Scene scene = builder.scene();
        scene.cameras[0].halfWidth = 3.0F;
        scene.materials = materials;
        const Film film = renderScene(scene, settings);
        for (std::uint32_t i = 0; i < 6; ++i) {
            const MeanEstimate mean = meanOf(partOf(film, settings.width, kStrip * i, 0, kStrip, 16));
            EXPECT_NEAR(mean.mean.g, 1.0, 5.0 * mean.standardError.g + 5e-3) << "material " << i << " at " << degrees << " degrees";
            least[i] = std::min(least[i], mean.mean.g);
            most[i] = std::max(most[i], mean.mean.g);
        }
    }
    for (std::size_t i = 0; i < 6; ++i) {
        printHardCase("H20",
                      (i < 3 ? "white metal" : "white plastic") + (" of roughness " + figure(static_cast<double>(materials[i].roughness))) +
                          " from 3, .1, .001 degrees",
                      3.0 * kStrip * 16.0 * settings.sampleEnd, "reflects " + figure(least[i]) + " to " + figure(most[i]));
    }
}

// Alpha is the square of roughness: just below 1e-3 a mirror, just above it a lobe.
TEST(HardMaterialTest, H45AlphaAtTheDeltaLimit)
{
    std::vector<Film> films;
    RenderSettings settings = persistent(128, 64, 256);
    for (const float roughness : {0.0316F, 0.0317F}) {
        SceneBuilder builder;
        builder.sphere({-1, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.5F)))
            .sphere({1, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.5F)))
            .orthographic({0, 0, 5}, {0, 0, 0}, 1.0F);
        Scene scene = builder.scene();
        scene.cameras[0].halfWidth = 2.0F;
        for (std::size_t i = 0; i < 2; ++i) {
            scene.materials[i] = Material();
            scene.materials[i].baseColor = glm::vec3(0.8F, 0.5F, 0.2F);
            scene.materials[i].metallic = i == 0 ? 1.0F : 0.0F;
            scene.materials[i].roughness = roughness;
        }
        scene.environment.emplace().map = std::make_shared<RadianceMap>(makeStudio());
        films.push_back(renderScene(scene, settings));
        ++settings.seed;
    }
    for (const std::uint32_t half : {0U, 1U}) {
        const Film below = partOf(films[0], 128, 64 * half, 0, 64, 64), above = partOf(films[1], 128, 64 * half, 0, 64, 64);
        const MeanEstimate a = meanOf(above), b = meanOf(below);
        const std::string name = std::string(half == 0 ? "metal" : "plastic") + " of roughness .0316 and .0317";
        printHardCase("H45", name, 2.0 * 4096.0 * settings.sampleEnd,
                      "means differ by " + figure(a.mean.g / b.mean.g - 1.0) + " +- " +
                          figure(std::hypot(a.standardError.g, b.standardError.g) / b.mean.g));
        expectSameMean(name, below, above);
    }
}

// attenuationColor 0 in a channel, from a file: nothing passes, and nothing is not a number.
TEST(HardMaterialTest, H48BlackAttenuation)
{
    for (const double distance : {2.0, 1e-30}) {
        test::GltfBuilder builder;
        builder.document["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior"};
        builder.append("materials",
                       {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                        {"extensions",
                         {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                          {"KHR_materials_ior", {{"ior", 1}}},
                          {"KHR_materials_volume",
                           {{"thicknessFactor", 1}, {"attenuationDistance", distance}, {"attenuationColor", {0, 0.25, 1}}}}}}});
        builder.addNode({{"extras", {{"sphere", {{"radius", 1}, {"material", 0}}}}}});
        Scene scene = test::load(builder);
        SceneBuilder view;
        view.environment(glm::vec3(1.0F)).perspective({0, 0, 5}, {0, 0, 0}, 1e-3F);
        scene.cameras = view.scene().cameras;
        scene.environment = view.scene().environment;
        const RenderSettings settings = persistent(8, 8, 8);
        const MeanEstimate mean = meanOf(renderScene(scene, settings));
        printHardCase("H48", "attenuationColor 0, .25, 1 at " + figure(distance) + " m, through 2 m", samplesOf(settings),
                      "transmits " + figure(mean.mean.r) + ", " + figure(mean.mean.g) + ", " + figure(mean.mean.b),
                      "log 0: infinity times 0 is not a number");
        EXPECT_LE(mean.mean.r, 1.1e-6);
        EXPECT_NEAR(mean.mean.g, distance > 1.0 ? 0.25 : 0.0, 1e-5);
        EXPECT_NEAR(mean.mean.b, 1.0, 1e-5);
        if (distance > 1.0) {
            // As large as a float can be, and within a rough surface, through which shadow rays leave.
            scene.materials[0].absorption = glm::vec3(std::numeric_limits<float>::infinity(), 1e38F, 0.0F);
            scene.materials[0].roughness = 0.5F;
            const MeanEstimate rough = meanOf(renderScene(scene, settings));
            EXPECT_LE(rough.mean.r, 0.5);
            EXPECT_TRUE(std::isfinite(rough.mean.r + rough.mean.g + rough.mean.b));
        }
    }
}

// A ball of index 1 is not there; of index 1 + 1e-5 it bends light by less than the map shows.
TEST(HardMaterialTest, H49GlassOfIndexOne)
{
    constexpr std::uint32_t kSide = 32;
    const float iors[] = {1.0F, 1.0F, 1.00001F, 1.00001F};
    SceneBuilder builder;
    for (int i = 0; i < 4; ++i) {
        builder.sphere({2.0F * static_cast<float>(i) + 1.0F, 0, 0}, 0.95F, builder.glass(iors[i]));
    }
    builder.orthographic({4, 0, 5}, {4, 0, 0}, 1.0F);
    Scene scene = builder.scene();
    scene.cameras[0].halfWidth = 4.0F;
    scene.materials[1].roughness = scene.materials[3].roughness = 0.3F;
    scene.environment.emplace().map = std::make_shared<RadianceMap>(makeStudio());
    Scene empty = scene;
    for (Sphere& sphere : empty.spheres) {
        sphere.center.z = 50.0F;
    }
    const RenderSettings settings = persistent(4 * kSide, kSide, 64);
    const Film with = renderScene(scene, settings), without = renderScene(empty, settings);
    for (std::uint32_t i = 0; i < 4; ++i) {
        const Film film = partOf(with, 4 * kSide, kSide * i, 0, kSide, kSide),
                   truth = partOf(without, 4 * kSide, kSide * i, 0, kSide, kSide);
        double worst = 0.0;
        for (std::size_t k = 0; k < film.pixels.size(); ++k) {
            worst = std::max(worst, std::abs(static_cast<double>(film.pixels[k].mean.g / truth.pixels[k].mean.g) - 1.0));
        }
        const double off = meanOf(film).mean.g / meanOf(truth).mean.g - 1.0;
        printHardCase("H49", std::string("glass of index ") + (i < 2 ? "1" : "1 + 1e-5") + (i % 2 == 0 ? "" : ", rough"),
                      1024.0 * settings.sampleEnd, "mean off by " + figure(off) + ", a pixel by " + figure(worst));
        EXPECT_LE(std::abs(off), 1e-4);
        EXPECT_LE(worst, 2e-3);
    }
}

// Many materials and instances share one image: it is decoded and stored once.
TEST(HardMaterialTest, H50ManyInstancesOfOneImage)
{
    const bool hard = std::getenv("GLIM_HARD") != nullptr;
    const std::uint32_t kMaterials = 1000, kEach = hard ? 1000 : 50;
    Scene scene = rowOf({{"H50",
                          "image",
                          greyImage(512, 512, [](std::uint32_t x, std::uint32_t y) { return static_cast<std::uint8_t>(x ^ y); }),
                          matt(false),
                          {0, 0},
                          {1, 1}}});
    const Scene one = scene;
    scene.materials[0].alphaMode = AlphaMode::Mask;  // its texels are opaque, which is found out once
    const Material material = scene.materials[0];
    const Mesh mesh = scene.meshes[0];
    scene.instances.clear();
    for (std::uint32_t m = 0; m < kMaterials; ++m) {
        scene.materials.push_back(material);
        scene.meshes.change().push_back(mesh);
        scene.meshes.change().back().material = m + 1;
        for (std::uint32_t i = 0; i < kEach; ++i) {
            MeshInstance& instance = scene.instances.emplace_back();
            instance.mesh = m + 1;
            instance.worldFromMesh = glm::translate(glm::dmat4(1.0), glm::dvec3(1.0 * m / kMaterials, 1.0 * i / kEach, 0.0)) *
                                     glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / kMaterials, 1.0 / kEach, 1.0));
        }
    }
    const auto begin = std::chrono::steady_clock::now();
    const FlatScene flat = flattened(scene);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("flattened in %.2f s\n", seconds.count());
    EXPECT_EQ(flat.features & kFeatureAlpha, 0U);
    EXPECT_EQ(flat.images->texels.size(), 512U * 512U);
    EXPECT_EQ(textureBytes(flat), textureBytes(flattened(one)));
    const RenderSettings settings = persistent(32, 32, 128);
    const Film film = renderFlat(flat, scene.cameras[0], settings);
    printHardCase("H50", figure(1.0 * kMaterials * kEach) + " instances, " + figure(kMaterials) + " materials, one image of 512 x 512",
                  samplesOf(settings),
                  figure(static_cast<double>(textureBytes(flat)) / 1048576.0) + " MiB of texels; mean " + describeMaterial(meanOf(film)),
                  "a copy for each material: " + figure(static_cast<double>(textureBytes(flat)) / 1048576.0 * kMaterials) + " MiB");
    expectMean("many instances of one image", film, glm::dvec3(meanAlbedo(*scene.images[0].pixels)));
}

// A lamp above a floor; its emission has a texture.
Scene texturedLamp(const DecodedImage& image)
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-2, 0, 2), {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}}, builder.lambert(glm::vec3(0.5F)))
        .quad({glm::vec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, builder.lambert(glm::vec3(0.0F), glm::vec3(10.0F)))
        .perspective({0, 0.5F, 3}, {0, 0, 0}, 0.5F);
    Scene scene = builder.scene();
    scene.images.push_back({"lamp", image});
    scene.materials[1].textures[kSlotEmissive].emplace();
    Mesh& mesh = scene.meshes.change()[1];
    for (const glm::dvec3& p : mesh.positions) {
        mesh.uv0.emplace_back(glm::vec2(p.x, p.z));
    }
    return scene;
}

TEST(TexturedLampTest, IsFoundByLightsAndByBsdfsAlike)
{
    Random random(6);
    Scene scene =
        texturedLamp(greyImage(4, 4, [&random](std::uint32_t, std::uint32_t) { return static_cast<std::uint8_t>(random.below(256)); }));
    // Beside it one of a single colour, and a checker.
    scene.images.push_back({"grey", greyImage(2, 2, [](std::uint32_t, std::uint32_t) { return std::uint8_t{128}; })});
    scene.images.push_back(
        {"checker", greyImage(2, 2, [](std::uint32_t x, std::uint32_t y) { return static_cast<std::uint8_t>(x == y ? 255 : 0); })});
    for (std::uint32_t i = 1; i < 3; ++i) {
        scene.materials.push_back(scene.materials[1]);
        scene.materials.back().textures[kSlotEmissive]->image = i;
        scene.meshes.change().push_back(scene.meshes[1]);
        scene.meshes.change().back().material = i + 1;
        MeshInstance& instance = scene.instances.emplace_back();
        instance.mesh = i + 1;
        instance.worldFromMesh = glm::translate(glm::dmat4(1.0), glm::dvec3(i == 1 ? 2.5 : -2.5, 0.2, 0.0));
    }
    RenderSettings settings = persistent(32, 32, 256);
    settings.bounces = 1;
    const Film both = renderScene(scene, settings);
    settings.course.direct = DirectLight::Bsdf;
    settings.seed = 1;
    settings.schedule = Schedule::Wavefront;
    expectSameMean("textured lamps by MIS and by BSDFs", both, renderScene(scene, settings));
}

TEST(TexturedLampTest, ATextureOfOneColourIsPartOfTheEmission)
{
    Scene textured = texturedLamp(greyImage(2, 2, [](std::uint32_t, std::uint32_t) { return std::uint8_t{128}; }));
    Scene plain = textured;
    plain.materials[1].textures[kSlotEmissive].reset();
    plain.materials[1].emission *= static_cast<float>(test::linearFromSrgb(128.0 / 255.0));
    const RenderSettings settings = persistent(16, 16, 16);
    EXPECT_NEAR(meanOf(renderScene(textured, settings)).mean.g / meanOf(renderScene(plain, settings)).mean.g, 1.0, 1e-5);
}

}  // namespace
}  // namespace glim
