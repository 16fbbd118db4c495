// Layers of ids, against areas known on paper and against what the film itself has seen.
#include "host/render/identify.hpp"
#include "host/flatten/start_media.hpp"
#include "host/image/cryptomatte.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/prepare_in_memory.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace glim {
namespace {

struct Identified {
    Film film;
    Image ids;
};

Identified identify(const PreparedScene& prepared, const RenderSettings& settings, const Lens& lens = {})
{
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    const FlatCamera camera = flattenCamera(prepared.scene.cameras.front(), aspect, lens);
    Renderer renderer(testDevice(), prepared.flat, camera, settings);
    Identified identified;
    identified.film = renderer.render([](const RenderProgress&) { return true; });
    Identifier identifier(renderer, prepared, camera);
    identified.ids = identifier.rows(identified.film, 0, settings.height);
    return identified;
}

// What the mattes say of a pixel: coverage by id.
std::map<std::uint32_t, float> mattesOf(const Image& ids, const std::string& layer, std::size_t pixel)
{
    std::map<std::uint32_t, float> mattes;
    float last = 1.0F;
    for (std::size_t rank = 0; rank < kMatteRanks; ++rank) {
        const float id = ids.channels.at(matteIdChannel(layer, rank))[pixel];
        const float coverage = ids.channels.at(matteCoverageChannel(layer, rank))[pixel];
        EXPECT_LE(coverage, last) << "ranks are sorted";
        EXPECT_EQ(id == 0.0F, coverage == 0.0F);
        last = coverage;
        if (coverage > 0.0F) {
            EXPECT_TRUE(mattes.emplace(std::bit_cast<std::uint32_t>(id), coverage).second) << "an id has one rank";
        }
    }
    return mattes;
}

// A card of [x0, x1] x [-1, 1] at this height, seen by a camera that looks down on [-1, 1]^2.
void addCard(SceneBuilder& builder, float x0, float x1, float height, std::uint32_t material)
{
    builder.quad({{{x0, -1, height}, {x1, -1, height}, {x1, 1, height}, {x0, 1, height}}}, material);
}

SceneBuilder cards()
{
    SceneBuilder builder;
    builder.orthographic({0, 0, 5}, {0, 0, 0}, 1.0F);
    return builder;
}

// The samples of a block are one to each of 32 strips of the pixel, so strips of eighths have exact shares. Of one pixel: nine cards, of
// which the last two have a name in common.
TEST(IdentifyTest, SharesOfAPixelAreExactAndRanked)
{
    SceneBuilder builder = cards();
    const float widths[] = {1, 1, 1, 1, 1, 2, 3, 2, 3};  // of sixteenths of the pixel; one is left
    const auto red = builder.lambert(glm::vec3(0.5F)), blue = builder.lambert(glm::vec3(0.5F));
    float x = -1.0F;
    for (int i = 0; i < 9; ++i) {
        addCard(builder, x, x + widths[i] / 8.0F, 0.0F, i < 8 ? red : blue);
        x += widths[i] / 8.0F;
    }
    Scene scene = builder.scene();
    scene.instances[7].name = scene.instances[8].name = "pair";
    scene.materials[red].name = "red";
    scene.meshes.change()[6].name = "six";
    const auto [film, ids] = identify(prepare(nameParts(scene)), squareSettings(1, 64));

    EXPECT_EQ(ids.counts.at("node.X")[0], 6U) << "the smaller index of two that cover 3/16";
    EXPECT_EQ(ids.counts.at("mesh.X")[0], 6U);
    EXPECT_EQ(ids.counts.at("material.X")[0], red);
    const auto nodes = mattesOf(ids, "CryptoObject", 0);
    ASSERT_EQ(nodes.size(), 6U);
    EXPECT_EQ(nodes.at(matteId("pair")), 5.0F / 16.0F);
    EXPECT_EQ(nodes.at(matteId("node.6")), 3.0F / 16.0F);
    EXPECT_EQ(nodes.at(matteId("node.5")), 2.0F / 16.0F);
    EXPECT_EQ(ids.channels.at("CryptoObject00.R")[0], std::bit_cast<float>(matteId("pair")));
    EXPECT_EQ(ids.channels.at("CryptoObject00.B")[0], std::bit_cast<float>(matteId("node.6")));
    const auto meshes = mattesOf(ids, "CryptoAsset", 0);
    EXPECT_EQ(meshes.at(matteId("six")), 3.0F / 16.0F);
    EXPECT_EQ(meshes.at(matteId("mesh.8")), 3.0F / 16.0F);
    const auto materials = mattesOf(ids, "CryptoMaterial", 0);
    ASSERT_EQ(materials.size(), 2U);
    EXPECT_EQ(materials.at(matteId("red")), 12.0F / 16.0F);
    EXPECT_EQ(materials.at(matteId("material.1")), 3.0F / 16.0F);
}

TEST(IdentifyTest, NothingAndWhatTheFileDoesNotHaveHaveNoIndex)
{
    SceneBuilder builder = cards();
    const auto white = builder.lambert(glm::vec3(0.5F));
    addCard(builder, -1.0F, -0.25F, 0.0F, white);  // all of pixel 0, half of pixel 1
    addCard(builder, 0.0F, 0.125F, 0.0F, white);   // a quarter of pixel 2
    builder.sphere({0.75F, 0.0F, -2.0F}, 0.57F, white);
    Scene scene = builder.scene();
    scene.defaultMaterial = white;
    const auto [film, ids] = identify(prepare(nameParts(scene)), squareSettings(4, 64));
    EXPECT_EQ(ids.counts.at("node.X")[0], 0U);
    EXPECT_EQ(ids.counts.at("node.X")[1], 0U) << "half of a pixel counts before nothing";
    EXPECT_EQ(ids.counts.at("node.X")[2], kNoIndex);
    EXPECT_EQ(ids.counts.at("mesh.X")[1], 0U);
    EXPECT_EQ(mattesOf(ids, "CryptoObject", 1), (std::map<std::uint32_t, float>{{matteId("node.0"), 0.5F}}));
    const std::size_t middle = 4 + 3;
    EXPECT_EQ(ids.counts.at("node.X")[middle], 2U);
    EXPECT_EQ(ids.counts.at("mesh.X")[middle], kNoIndex);
    EXPECT_EQ(ids.counts.at("material.X")[middle], kNoIndex);
    EXPECT_EQ(mattesOf(ids, "CryptoAsset", middle), (std::map<std::uint32_t, float>{{matteId("mesh.sphere"), 1.0F}}));
    EXPECT_EQ(mattesOf(ids, "CryptoMaterial", middle), (std::map<std::uint32_t, float>{{matteId("material.default"), 1.0F}}));
}

// Independent samples: counts over all pixels are multinomial. A disk in front of a card that lets three samples of four through.
TEST(IdentifyTest, AreasAreThoseOfTheScene)
{
    SceneBuilder builder = cards();
    const auto veil = builder.lambert(glm::vec3(0.5F)), white = builder.lambert(glm::vec3(0.5F));
    addCard(builder, -1.0F, 0.3F, 0.0F, veil);
    addCard(builder, -0.7F, 1.0F, -1.0F, white);
    builder.sphere({0.1F, 0.2F, 1.0F}, 0.5F, white);
    Scene scene = builder.scene();
    scene.materials[veil].alphaMode = AlphaMode::Blend;
    scene.materials[veil].alpha = 0.25F;
    RenderSettings settings = squareSettings(32, samplesFor(64));
    settings.sampler = Sampler::Independent;
    const auto [film, ids] = identify(prepare(nameParts(scene)), settings);

    // Of the square of area 4. The part of the disk that lies beyond x = .3 is a segment whose chord is .2 from the centre.
    const double r = 0.5, disk = M_PI * r * r, d = 0.2;
    const double beyond = r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d), within = disk - beyond;
    const double veiled = 2.0 * 1.3 - within;             // by the card alone
    const double bare = 0.3 * 2.0;                        // of that, with nothing behind
    const double behind = 2.0 * 1.7 - disk;               // of the far card, beside the disk
    const double seen = behind - 0.25 * (veiled - bare);  // the disk lies over the far card
    const double areas[] = {0.25 * veiled, seen, disk, 0.75 * bare};
    double counts[4] = {};
    const double samples = settings.sampleEnd;
    for (std::size_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        double covered = 0.0;
        for (const auto& [id, coverage] : mattesOf(ids, "CryptoObject", pixel)) {
            const std::size_t node = id == matteId("node.0") ? 0 : id == matteId("node.1") ? 1 : 2;
            ASSERT_TRUE(node < 2 || id == matteId("node.2"));
            counts[node] += std::round(samples * static_cast<double>(coverage));
            covered += std::round(samples * static_cast<double>(coverage));
        }
        counts[3] += samples - covered;
    }
    std::vector<double> expected;
    for (const double area : areas) {
        expected.push_back(area / 4.0 * samples * static_cast<double>(film.pixels.size()));
    }
    expectCounts("areas of ids", counts, expected, 1);
}

// Through a hole in a mask is what lies behind it; beside it is the mask alone.
TEST(IdentifyTest, HolesOfMasksShowWhatIsBehind)
{
    SceneBuilder builder = cards();
    const auto mask = builder.lambert(glm::vec3(0.5F)), white = builder.lambert(glm::vec3(0.5F), glm::vec3(1.0F), true);
    addCard(builder, -1.0F, 1.0F, 0.0F, mask);
    addCard(builder, -1.0F, 1.0F, -1.0F, white);
    Scene scene = builder.scene();
    scene.materials[mask].alphaMode = AlphaMode::Mask;
    scene.materials[mask].textures[kSlotBaseColor].emplace().nearest = true;
    DecodedImage halves;
    halves.width = 2;
    halves.height = 1;
    halves.rgba8 = {255, 255, 255, 0, 255, 255, 255, 255};
    scene.images.push_back({"halves", halves});
    scene.meshes.change()[0].uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    const auto [film, ids] = identify(prepare(nameParts(scene)), squareSettings(8, 16));
    for (std::size_t pixel = 0; pixel < 64; ++pixel) {
        const std::uint32_t node = pixel % 8 < 4 ? 1 : 0;
        EXPECT_EQ(ids.counts.at("node.X")[pixel], node) << pixel;
        EXPECT_EQ(mattesOf(ids, "CryptoObject", pixel), (std::map<std::uint32_t, float>{{matteId("node." + std::to_string(node)), 1.0F}}));
    }
}

// A floor, balls that share a mesh, glass around the camera, a sphere, a lamp, and cards that are half transparent. Each material has an
// albedo of its own.
Scene yardOfAlbedos()
{
    SceneBuilder builder;
    const auto floor = builder.lambert(glm::vec3(0.125F)), red = builder.lambert(glm::vec3(0.25F));
    const auto card = builder.lambert(glm::vec3(0.375F), glm::vec3(0.0F), true),
               lamp = builder.lambert(glm::vec3(0.5F), glm::vec3(9.0F), true);
    const auto metal = builder.mirror(glm::vec3(0.75F));
    builder.quad({glm::vec3(-6, 0, 6), {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}}, floor)
        .sphere({-2.6F, 0.5F, 0.4F}, 0.5F, red)
        .sphere({0.5F, 4.0F, 7.0F}, 0.8F, card)
        .sphere({1.2F, 2.2F, 0.0F}, 0.3F, lamp)
        .environment(glm::vec3(0.2F, 0.3F, 0.4F))
        .perspective({0.5F, 3.5F, 7.0F}, {0, 0.6F, 0}, 0.6F);
    Scene scene = builder.scene();
    scene.materials[card].alphaMode = AlphaMode::Blend;
    scene.materials[card].alpha = 0.5F;
    addMesh(scene, icosphere(2), metal);
    addMesh(scene, strips(3, 5), card);
    scene.instances.resize(1);
    for (int i = 0; i < 9; ++i) {
        addInstance(scene, 1, {i % 3 - 1.0, 0.4, 1.5 - i / 3}, 0.3 * i, {0.4, 0.3, i % 2 == 0 ? 0.4 : -0.4});
    }
    addInstance(scene, 2, {-2.0, 1.2, 1.6}, 0.5, glm::dvec3(0.4));
    addInstance(scene, 2, {2.2, 1.0, 1.4}, 2.0, {0.3, -0.5, 0.4});
    return scene;
}

// The film's alpha and albedo are means over the same samples, made by other kernels. Mattes of other samples would differ by the noise.
void expectSameSamples(const Identified& identified, const Scene& scene)
{
    std::map<std::uint32_t, float> albedos;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        albedos[matteId("material." + std::to_string(i))] = scene.materials[i].baseColor.r;
    }
    std::size_t mixed = 0;
    for (std::size_t i = 0; i < identified.film.pixels.size(); ++i) {
        const PixelMoments& pixel = identified.film.pixels[i];
        float alpha = 0.0F, albedo = 0.0F;
        const auto mattes = mattesOf(identified.ids, "CryptoMaterial", i);
        for (const auto& [id, coverage] : mattes) {
            alpha += coverage;
            albedo += coverage * albedos.at(id);
        }
        mixed += mattes.size() > 1 ? 1 : 0;
        // Sums of at most 4096 samples in float32.
        EXPECT_NEAR(alpha, pixel.alpha, 1e-5) << "pixel " << i;
        EXPECT_NEAR(albedo, pixel.albedo.r, 1e-5) << "pixel " << i;
    }
    EXPECT_GT(mixed, identified.film.pixels.size() / 8);
}

TEST(IdentifyTest, SamplesAreThoseOfThePicture)
{
    const Scene scene = yardOfAlbedos();
    Lens lens;
    lens.radius = 0.05F;
    lens.focalDistance = 6.0F;
    for (const std::uint64_t maxFlatTriangles : {std::uint64_t{kMaxFlatTriangles}, std::uint64_t{0}}) {
        const PreparedScene prepared = prepare(nameParts(scene), maxFlatTriangles);
        EXPECT_EQ(prepared.primitives.placements.empty(), maxFlatTriangles > 0);
        RenderSettings settings = squareSettings(24, 40);
        settings.seed = 3;
        settings.sampleBegin = 7;
        for (const Schedule schedule : {Schedule::Wavefront, Schedule::Persistent}) {
            settings.schedule = schedule;
            expectSameSamples(identify(prepared, settings, lens), scene);
        }
    }
}

// The rule of the course stops each pixel after samples of its own number.
TEST(IdentifyTest, SamplesOfPixelsThatStopAreThoseOfThePicture)
{
    Scene scene = yardOfAlbedos();
    for (Material& material : scene.materials) {
        material.alphaMode = AlphaMode::Opaque;  // which the course does not know
    }
    RenderSettings settings = squareSettings(24, 512);
    settings.adaptive = Adaptive::Course;
    settings.sampler = Sampler::Independent;
    settings.course.tolerance = 0.1F;
    settings.bounces = 1;
    scene.spheres.erase(scene.spheres.begin() + 1);  // around the camera
    const Identified identified = identify(prepare(nameParts(scene)), settings);
    const auto [least, most] = std::ranges::minmax(identified.film.pixels, {}, &PixelMoments::count);
    EXPECT_LT(least.count, most.count);
    expectSameSamples(identified, scene);
}

// --adaptive neighbours takes its later samples from elsewhere: coverage is that of as many samples.
TEST(IdentifyTest, AdaptivePixelsHaveSharesOfTheirCounts)
{
    RenderSettings settings = squareSettings(24, 256);
    settings.adaptive = Adaptive::Neighbours;
    const auto [film, ids] = identify(prepare(nameParts(yardOfAlbedos())), settings);
    bool uneven = false;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        uneven = uneven || film.pixels[i].count != film.pixels[0].count;
        for (const auto& [id, coverage] : mattesOf(ids, "CryptoObject", i)) {
            const double samples = static_cast<double>(coverage) * film.pixels[i].count;
            EXPECT_NEAR(samples, std::round(samples), 1e-4);
        }
    }
    EXPECT_TRUE(uneven);
}

TEST(IdentifyTest, PixelsWithoutSamplesShowNothing)
{
    const PreparedScene prepared = prepare(nameParts(yardOfAlbedos()));
    const FlatCamera camera = flattenCamera(prepared.scene.cameras.front(), 1.0F);
    const RenderSettings settings = squareSettings(16, 8);
    Renderer renderer(testDevice(), prepared.flat, camera, settings);
    Film film = renderer.render([](const RenderProgress&) { return true; });
    Identifier identifier(renderer, prepared, camera);
    const Image whole = identifier.rows(film, 0, 16);
    film.pixels[200].count = 0;
    film.pixels[201].count = 3;
    const Image part = identifier.rows(film, 11, 3);
    for (const auto& [name, plane] : whole.channels) {
        ASSERT_EQ(part.channels.at(name).size(), 48U);
        for (std::size_t i = 0; i < 48; ++i) {
            const std::size_t pixel = 11 * 16 + i;
            if (pixel != 201) {
                EXPECT_EQ(part.channels.at(name)[i], pixel == 200 ? 0.0F : plane[pixel]) << name << ' ' << pixel;
            }
        }
    }
    EXPECT_EQ(part.counts.at("node.X")[200 - 11 * 16], kNoIndex);
}

// All ids of both: nodes that share a mesh are told apart. Rounding takes a few rays past an edge.
TEST(IdentifyTest, SharedMeshesAreIdentifiedAsFlattenedOnes)
{
    Scene scene = yardOfAlbedos();
    for (Material& material : scene.materials) {
        material.alphaMode = AlphaMode::Opaque;  // else it is the primitives' ids that decide what a sample sees
    }
    scene.spheres.erase(scene.spheres.begin() + 1);
    const RenderSettings settings = squareSettings(64, 16);
    const Image flat = identify(prepare(nameParts(scene)), settings).ids, shared = identify(prepare(nameParts(scene), 0), settings).ids;
    std::size_t different = 0;
    std::set<std::uint32_t> nodes;
    for (std::size_t i = 0; i < 64 * 64; ++i) {
        const auto mattes = mattesOf(flat, "CryptoObject", i);
        different += mattes == mattesOf(shared, "CryptoObject", i) ? 0 : 1;
        nodes.insert(flat.counts.at("node.X")[i]);
        if (mattes.size() == 1) {
            EXPECT_EQ(flat.counts.at("node.X")[i], shared.counts.at("node.X")[i]);
        }
    }
    std::printf("%zu of 4096 pixels differ\n", different);
    EXPECT_LE(different, 2U);
    EXPECT_GE(nodes.size(), 12U);
}

TEST(IdentifyTest, PointsAreTheNodeOfTheirCloud)
{
    SceneBuilder builder = cards();
    const auto grey = builder.lambert(glm::vec3(0.5F)), red = builder.lambert(glm::vec3(0.5F));
    builder.sphere({-0.5F, 0.5F, 0.0F}, 0.49F, grey);
    Scene scene = builder.scene();
    Mesh cloud;
    cloud.isCloud = true;
    cloud.positions = {{0.5, 0.5, 0.0}, {0.5, -0.5, 0.0}};
    cloud.pointRadius = 0.49;
    cloud.material = red;
    scene.meshes.change().push_back(cloud);
    scene.instances.push_back({"cloud", 0});
    scene.spheres[0].name = "ball";
    const auto [film, ids] = identify(prepare(nameParts(scene)), squareSettings(4, 16));
    const auto nodesAt = [&ids = ids](std::size_t x, std::size_t y) { return mattesOf(ids, "CryptoObject", 4 * y + x); };
    EXPECT_EQ(ids.counts.at("node.X"),
              (std::vector<std::uint32_t>{1, 1, 0, 0, 1, 1, 0, 0, kNoIndex, kNoIndex, 0, 0, kNoIndex, kNoIndex, 0, 0}));
    EXPECT_EQ(ids.counts.at("material.X")[2], red);
    EXPECT_EQ(ids.counts.at("mesh.X")[2], 0U);
    EXPECT_TRUE(nodesAt(2, 3).contains(matteId("cloud")));
    EXPECT_TRUE(nodesAt(1, 1).contains(matteId("ball")));
}

// From within milk the ids are those of clear water: rays that only ask what is ahead are not scattered.
TEST(IdentifyTest, VolumesDoNotScatterRaysThatAskForIds)
{
    const auto idsWithin = [](float scattering) {
        SceneBuilder builder = cards();
        addCard(builder, -1.0F, 0.3F, 1.0F, builder.lambert(glm::vec3(0.5F)));
        builder.sphere({0, 0, 0}, 9.0F, builder.glass(1.3F)).environment(glm::vec3(1.0F));
        Scene scene = builder.scene();
        scene.materials[1].scattering = glm::vec3(scattering);
        scene.materials[1].absorption = glm::vec3(0.1F);
        const PreparedScene prepared = prepare(nameParts(scene));
        const FlatCamera camera = placeInMedia(flattenCamera(prepared.scene.cameras.front(), 1.0F), prepared.flat);
        Renderer renderer(testDevice(), prepared.flat, camera, squareSettings(8, 4));
        const Film film = renderer.render([](const RenderProgress&) { return true; });
        return Identifier(renderer, prepared, camera).rows(film, 0, 8).channels;
    };
    EXPECT_EQ(idsWithin(2.0F), idsWithin(0.0F));
}

}  // namespace
}  // namespace glim
