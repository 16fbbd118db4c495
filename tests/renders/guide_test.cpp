// Path guiding keeps its promises: the same mean, the same bits by any schedule, samples, seed and rows, and less noise where light comes
// through a gap.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/start_media.hpp"
#include "host/render/aov.hpp"
#include "host/render/build_guide.hpp"
#include "host/render/learn_guide.hpp"
#include "host/render/replay.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/guide_records.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glim {
namespace {

constexpr std::uint32_t kSide = 24;

// Two rooms with a wall between them, whose lower part has a slit of 12 cm. The lamp is in one room, the camera in the other.
Scene doorAjar()
{
    SceneBuilder b;
    const std::uint32_t wall = b.lambert(glm::vec3(0.7F)), lamp = b.lambert(glm::vec3(0.0F), glm::vec3(10.0F));
    const auto box = [&](const glm::vec3& low, const glm::vec3& high, bool inwards) {
        const auto corner = [&](int i) { return glm::vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z); };
        for (std::array<int, 4> face : {std::array{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
            if (inwards) {
                std::reverse(face.begin(), face.end());
            }
            b.quad({corner(face[0]), corner(face[1]), corner(face[2]), corner(face[3])}, wall);
        }
    };
    box({0, 0, 0}, {8.1F, 3, 4}, true);
    box({4, 0, 0}, {4.1F, 3, 1.94F}, false);
    box({4, 0, 2.06F}, {4.1F, 3, 4}, false);
    box({4, 2, 1.94F}, {4.1F, 3, 2.06F}, false);
    b.quad({glm::vec3(5.6F, 2.95F, 1.5F), {6.6F, 2.95F, 1.5F}, {6.6F, 2.95F, 2.5F}, {5.6F, 2.95F, 2.5F}}, lamp)
        .perspective({0.4F, 1.5F, 0.4F}, {3.2F, 1, 3.2F}, 1.2F);
    return b.scene();
}

std::shared_ptr<const Guide> learnFor(const Scene& scene, const RenderSettings& settings)
{
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    return learnGuide(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), aspect, {}), settings).guide;
}

struct Films {
    Film plain, guided;
    std::shared_ptr<const Guide> guide;
};

// By both schedules, without a guide and with one.
Films expectTheSameMean(const std::string& name, const FlatScene& flat, const Camera& camera, RenderSettings settings)
{
    Films films;
    films.plain = renderFlat(flat, camera, settings);
    settings.seed = 1;
    settings.guide = learnGuide(testDevice(), flat, flattenCamera(camera, 1.0F), settings).guide;
    films.guide = settings.guide;
    EXPECT_GT(settings.guide->cells, 20U);
    films.guided = renderFlat(flat, camera, settings);
    expectSameMean(name, films.guided, films.plain);
    return films;
}

double varianceOf(const Film& film)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        const glm::dvec3 variance = glm::dvec3(computeVarianceOfMean(pixel));
        const glm::dvec3 mean = glm::dvec3(pixel.mean);
        sum += variance.g / (mean.g * mean.g + 1e-12);
    }
    return sum / static_cast<double>(film.pixels.size());
}

void expectLessNoise(const Films& films)
{
    const double ratio = varianceOf(films.plain) / varianceOf(films.guided);
    std::printf("relative variance of a pixel, plain over guided: %.2f\n", ratio);
    EXPECT_GT(ratio, 1.5);
}

TEST(GuideRenderTest, HasTheSameMeanAndLessNoiseBehindADoor)
{
    const Scene scene = doorAjar();
    expectLessNoise(expectTheSameMean("door ajar", flattened(scene), scene.cameras.front(), squareSettings(2 * kSide, 1024)));
}

// Balls that share a mesh, each turned and stretched otherwise. What is learned of them is of points and normals in the room.
TEST(GuideRenderTest, HasTheSameMeanAndLessNoiseWithInstances)
{
    Scene scene = doorAjar();
    addMesh(scene, icosphere(2));
    scene.instances.pop_back();
    for (int i = 0; i < 6; ++i) {
        addInstance(scene, static_cast<std::uint32_t>(scene.meshes.size() - 1), {1.2 + 0.4 * i, 0.5 + 0.4 * (i % 3), 3.5 - 0.5 * i}, i,
                    {0.2, 0.3 + 0.05 * i, 0.35});
    }
    const Primitives primitives = makePrimitives(scene, 0);
    const FlatScene flat = flattenScene(scene, primitives, buildSceneBvh(primitives));
    ASSERT_NE(flat.features & kFeatureInstances, 0U);
    expectLessNoise(expectTheSameMean("instances", flat, scene.cameras.front(), squareSettings(kSide, 1024)));
}

// Glossy metal, rough glass and a leaf in the room without the lamp; before half of the slit, a curtain of the leaf's material.
TEST(GuideRenderTest, HasTheSameMeanOfGlossBehindADoor)
{
    Scene scene = doorAjar();
    const auto add = [&](auto change) {
        Material material;
        material.baseColor = glm::vec3(0.9F, 0.8F, 0.7F);
        change(material);
        scene.materials.push_back(material);
        return static_cast<std::uint32_t>(scene.materials.size() - 1);
    };
    const std::uint32_t leaf = add([](Material& m) { m.metallic = 0.0F, m.diffuseTransmission = 0.7F; });
    const std::uint32_t materials[] = {
        add([](Material& m) { m.roughness = 0.15F; }), add([](Material& m) { m.roughness = 0.5F; }),
        add([](Material& m) { m.metallic = 0.0F, m.roughness = 0.5F, m.transmission = 1.0F, m.thick = m.solid = true; }), leaf};
    for (int i = 0; i < 4; ++i) {
        scene.spheres.push_back({"", {1.2F + 0.8F * static_cast<float>(i), 0.8F, 3.4F - 0.9F * static_cast<float>(i)}, 0.4F, materials[i]});
    }
    addMesh(
        scene,
        {{{{3.9F, 0.0F, 1.8F}, {3.9F, 1.0F, 1.8F}, {3.9F, 1.0F, 2.2F}}}, {{{3.9F, 0.0F, 1.8F}, {3.9F, 1.0F, 2.2F}, {3.9F, 0.0F, 2.2F}}}},
        leaf);
    RenderSettings settings = squareSettings(kSide, 1024);
    settings.caustics = false;
    expectTheSameMean("gloss behind a door", flattened(scene), scene.cameras.front(), settings);
}

// A ball of a medium without a boundary.
void addFog(Scene& scene, const glm::vec3& center, float radius, float extinction, float anisotropy)
{
    Material fog;
    fog.metallic = fog.roughness = 0.0F;
    fog.transmission = fog.ior = 1.0F;
    fog.solid = true;
    fog.scattering = glm::vec3(0.95F * extinction);
    fog.absorption = glm::vec3(0.05F * extinction);
    fog.scatterAnisotropy = anisotropy;
    scene.materials.push_back(fog);
    scene.spheres.push_back({"", center, radius, static_cast<std::uint32_t>(scene.materials.size() - 1)});
}

// For as much noise, paths by a guide of scatterings have fewer rays.
TEST(GuideRenderTest, HasTheSameMeanInFogBehindADoor)
{
    Scene scene = doorAjar();
    addFog(scene, {2.2F, 1.5F, 2.0F}, 1.45F, 0.5F, 0.0F);
    const Films films = expectTheSameMean("fog behind a door", flattened(scene), scene.cameras.front(), squareSettings(kSide, 1024));
    EXPECT_TRUE(guideScatterings(films.guide->texels));
}

// Light comes from everywhere, and a guide would add its noise to the phase function, which has none.
TEST(GuideRenderTest, LeavesScatteringsOfADenseBallAlone)
{
    SceneBuilder b;
    b.environment(glm::vec3(1.0F)).perspective({0.0F, 0.0F, 3.0F}, {0.0F, 0.0F, 0.0F}, 0.6F);
    Scene scene = b.scene();
    addFog(scene, glm::vec3(0.0F), 1.0F, 30.0F, 0.3F);
    EXPECT_FALSE(guideScatterings(learnFor(scene, squareSettings(kSide, 64))->texels));
}

// Mirror, glass, a punctual light and an environment, so that every path through the kernels runs.
TEST(GuideRenderTest, HasTheSameMeanInAMixedScene)
{
    const Scene scene = mixedScene();
    RenderSettings settings = squareSettings(kSide, 1024);
    settings.caustics = false;
    expectTheSameMean("mixed scene", flattened(scene), scene.cameras.front(), settings);
}

// Coats, metals of two roughnesses, rough glass, cloth and a leaf: the guide leaves narrow lobes to the BSDF.
TEST(GuideRenderTest, HasTheSameMeanWithEveryLobe)
{
    SceneBuilder b;
    const auto add = [&](auto change) {
        Material material;
        material.baseColor = glm::vec3(0.7F, 0.6F, 0.5F);
        material.metallic = 0.0F;
        material.roughness = 0.6F;
        change(material);
        return b.add(material);
    };
    b.cube(1.0F, b.lambert(glm::vec3(0.6F)), true)
        .quad({glm::vec3(-0.3F, 0.98F, -0.3F), {0.3F, 0.98F, -0.3F}, {0.3F, 0.98F, 0.3F}, {-0.3F, 0.98F, 0.3F}},
              b.lambert(glm::vec3(0.0F), glm::vec3(8.0F)));
    const std::uint32_t materials[] = {add([](Material& m) { m.metallic = 1.0F; }),
                                       add([](Material& m) { m.metallic = 1.0F, m.roughness = 0.2F; }),
                                       add([](Material& m) { m.clearcoat = 1.0F; }),
                                       add([](Material& m) { m.transmission = 1.0F, m.roughness = 0.4F, m.thick = m.solid = true; }),
                                       add([](Material& m) { m.sheenColor = glm::vec3(0.9F), m.sheenRoughness = 0.5F; }),
                                       add([](Material& m) { m.diffuseTransmission = 0.6F; })};
    for (int i = 0; i < 6; ++i) {
        b.sphere({static_cast<float>(i % 3 - 1) * 0.6F, static_cast<float>(i / 3) * 0.8F - 0.5F, -0.3F}, 0.27F, materials[i]);
    }
    b.perspective({0.0F, 0.0F, 0.95F}, {0.0F, -0.1F, -1.0F}, 1.3F);
    expectTheSameMean("every lobe", flattened(b.scene()), b.scene().cameras.front(), squareSettings(kSide, 1024));
}

TEST(GuideRenderTest, DependsOnSceneCameraAndSizeAlone)
{
    const Scene scene = doorAjar();
    RenderSettings settings = squareSettings(kSide, 64);
    const std::string digest = learnFor(scene, settings)->digest;
    EXPECT_EQ(learnFor(scene, settings)->digest, digest) << "again";
    RenderSettings other = settings;
    other.seed = 7;
    other.sampleBegin = 256;
    other.sampleEnd = 4096;
    other.rows = {4, 9};
    other.schedule = Schedule::Wavefront;
    other.pathCapacity = 1024;
    other.adaptive = Adaptive::Neighbours;
    EXPECT_EQ(learnFor(scene, other)->digest, digest);
    other.width = 2 * kSide;
    EXPECT_NE(learnFor(scene, other)->digest, digest);
}

// The camera is in fog, where paths are put aside before they meet a surface.
TEST(GuideRenderTest, DependsOnNoQueueInFog)
{
    Scene scene = doorAjar();
    addFog(scene, {1.7F, 1.5F, 1.7F}, 1.9F, 0.4F, 0.0F);
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = placeInMedia(flattenCamera(scene.cameras.front(), 1.0F, {}), flat);
    RenderSettings settings = squareSettings(kSide, 64);
    const std::shared_ptr<const Guide> guide = learnGuide(testDevice(), flat, camera, settings).guide;
    EXPECT_TRUE(guideScatterings(guide->texels));
    for (const std::uint32_t capacity : {1024U, 5000U}) {
        settings.pathCapacity = capacity;
        EXPECT_EQ(learnGuide(testDevice(), flat, camera, settings).guide->digest, guide->digest);
    }
}

TEST(GuideRenderTest, FilmsByOtherGuidesAreOthers)
{
    const Scene scene = doorAjar();
    RenderSettings settings = squareSettings(8, 64);
    const std::string plain = renderScene(scene, settings).identity.settings;
    EXPECT_EQ(findSetting(plain, "guide"), "");
    settings.guide = learnFor(scene, settings);
    EXPECT_EQ(findSetting(renderScene(scene, settings).identity.settings, "guide"), settings.guide->digest);
}

// It knows a ball that is not there, and that the room with the lamp is the dark one.
TEST(GuideRenderTest, AWrongGuideChangesNoMean)
{
    Random random(9);
    std::vector<GuideRecord> records = recordsOfBall(100000, random);
    for (GuideRecord& record : records) {
        record.point = vec3(4.05F, 1.5F, 2.0F) * (1.0F + record.point);
        record.direct = packDirect(1.0F, 0, record.point.x < 4.0F);
    }
    const Scene scene = doorAjar();
    RenderSettings settings = squareSettings(kSide, 4096);
    const Film plain = renderScene(scene, settings);
    settings.seed = 1;
    settings.guide = std::make_shared<const Guide>(guideOf(records));
    expectSameMean("a wrong guide", renderScene(scene, settings), plain);
}

// It knows a ball beside the fog that is not there.
TEST(GuideRenderTest, AWrongGuideOfScatteringsChangesNoMean)
{
    Random random(12);
    std::vector<GuideRecord> records = recordsOfBall(200000, random);
    for (std::size_t i = 0; i < records.size(); i += 2) {
        records[i].normal = kNoReceiverNormal;
    }
    SceneBuilder b;
    b.cube(1.2F, b.lambert(glm::vec3(0.5F)), true)
        .quad({glm::vec3(-0.3F, 1.15F, -0.3F), {0.3F, 1.15F, -0.3F}, {0.3F, 1.15F, 0.3F}, {-0.3F, 1.15F, 0.3F}},
              b.lambert(glm::vec3(0.0F), glm::vec3(8.0F)))
        .perspective({0.0F, 0.0F, 1.15F}, {0.0F, 0.0F, -1.0F}, 1.2F);
    Scene scene = b.scene();
    addFog(scene, glm::vec3(0.0F), 0.9F, 2.0F, 0.4F);
    RenderSettings settings = squareSettings(kSide, 2048);
    const Film plain = renderScene(scene, settings);
    settings.seed = 1;
    settings.guide = std::make_shared<const Guide>(guideOf(records, true));
    expectSameMean("a wrong guide of scatterings", renderScene(scene, settings), plain);
}

// It knows that two of three lamps, which are large and near, are never seen, and that light samples bring next to nothing.
TEST(GuideRenderTest, AWrongSightChangesNoMean)
{
    SceneBuilder b;
    const std::uint32_t wall = b.lambert(glm::vec3(0.5F));
    b.cube(1.0F, wall, true);
    for (const float z : {-0.8F, 0.0F, 0.7F}) {
        b.quad({glm::vec3(-0.8F, 0.9F, z), {0.8F, 0.9F, z}, {0.8F, 0.9F, z + 0.15F}, {-0.8F, 0.9F, z + 0.15F}},
               b.lambert(glm::vec3(0.0F), glm::vec3(5.0F + 4.0F * z)));
    }
    b.environment(glm::vec3(0.3F)).perspective({0.0F, 0.0F, 0.9F}, {0.0F, 0.1F, -1.0F}, 1.3F);
    Random random(10);
    std::vector<GuideRecord> records = recordsOfBall(100000, random);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const std::uint32_t lights = i % 4 == 3 ? kSightOfInfinite : i % 4;
        records[i].direct = packDirect(0.1F, lights, lights == 1 || lights == kSightOfInfinite);
    }
    const Scene scene = b.scene();
    RenderSettings settings = squareSettings(kSide, 4096);
    const Film plain = renderScene(scene, settings);
    settings.seed = 1;
    settings.guide = std::make_shared<const Guide>(guideOf(records));
    expectSameMean("a wrong sight", renderScene(scene, settings), plain);
}

// A wall and a floor; the guide knows the directions from the wall to a ball.
TEST(GuideRenderTest, TheViewShowsDirectionsAndHowConcentratedTheyAre)
{
    Random random(11);
    std::vector<GuideRecord> records = recordsOfBall(200000, random);
    for (GuideRecord& record : records) {
        record.normal = encodeDirection({0.0, 0.0, 1.0});
    }
    constexpr float kWall = -0.5F, kCamera = 0.7F, kFloor = -0.3F, kTan = 0.5F;
    SceneBuilder b;
    const std::uint32_t grey = b.lambert(glm::vec3(0.5F));
    b.quad({glm::vec3(-9, kFloor, kWall), {9, kFloor, kWall}, {9, 9, kWall}, {-9, 9, kWall}}, grey)
        .quad({glm::vec3(-9, kFloor, 9), {9, kFloor, 9}, {9, kFloor, kWall}, {-9, kFloor, kWall}}, grey)
        .perspective({0, 0, kCamera}, {0, 0, 0}, 2.0F * std::atan(kTan));
    RenderSettings settings = squareSettings(kSide, 1);
    settings.aov = Aov::Guide;
    settings.guide = std::make_shared<const Guide>(guideOf(records));
    const Film film = renderScene(b.scene(), settings);
    double cosines = 0.0;
    int wall = 0, floor = 0;
    for (std::uint32_t pixel = 0; pixel < film.pixels.size(); ++pixel) {
        const PixelMoments& shown = film.pixels[pixel];
        if (shown.normal.y > 0.5F) {
            EXPECT_EQ(shown.mean, glm::vec3(0.0F));
            EXPECT_EQ(displayColor(shown, Aov::Guide, {}, {}), Rgb8{});
            ++floor;
            continue;
        }
        const glm::vec2 film2 = (glm::vec2(pixel % kSide, pixel / kSide) + 0.5F) * 2.0F / static_cast<float>(kSide) - 1.0F;
        const glm::vec3 point(kTan * (kCamera - kWall) * glm::vec2(film2.x, -film2.y), kWall);
        const float length = glm::length(shown.mean);
        cosines += static_cast<double>(glm::dot(shown.mean / length, glm::normalize(glm::vec3(1.6F, 0.3F, -0.4F) - point)));
        EXPECT_GT(length, 10.0F) << "the ball is less than 1/100 of all directions";
        ++wall;
    }
    std::printf("mean cosine to the ball %.4f\n", cosines / wall);
    EXPECT_GT(wall, 200);
    EXPECT_GT(floor, 50);
    EXPECT_GT(cosines / wall, 0.95);
}

TEST(GuideRenderTest, TheViewsColoursAreDirectionsByTheirConcentration)
{
    const auto colorOf = [](const glm::vec3& mean, float alpha) {
        PixelMoments pixel{};
        pixel.mean = mean;
        pixel.alpha = alpha;
        return displayColor(pixel, Aov::Guide, {}, {});
    };
    EXPECT_EQ(colorOf({8.0F, 0.0F, 0.0F}, 1.0F), (Rgb8{128, 64, 64})) << "three of six bits";
    EXPECT_EQ(colorOf({0.0F, -4.0F, 0.0F}, 0.5F), (Rgb8{64, 0, 64})) << "half of the pixel";
    EXPECT_EQ(colorOf({0.0F, 0.0F, 1000.0F}, 1.0F), (Rgb8{128, 128, 255}));
    EXPECT_EQ(colorOf(glm::vec3(0.0F), 1.0F), Rgb8{});
}

struct GuidedVertices {
    int all = 0, byGuide = 0, rouletted = 0;
    double surplus = 0.0, variance = 0.0;  // of choices by the guide; where it is likelier, they count more
};

// By the vertex's own numbers. All surfaces are Lambert.
void checkGuided(const PathVertex& vertex, const PathVertex* next, GuidedVertices& sums)
{
    const PathNote& note = vertex.bsdf;
    sums.rouletted += vertex.end == PathEnd::Roulette ? 1 : 0;
    EXPECT_EQ(vertex.end == PathEnd::Roulette, next == nullptr && note.continuation > 0.0F) << "a path with light to bring goes on";
    if (!(note.guideShare > 0.0F)) {
        return;
    }
    const double share = static_cast<double>(note.guideShare), bsdf = static_cast<double>(note.nextBsdfPdf);
    const double mixed = share * static_cast<double>(note.guidePdf) + (1.0 - share) * bsdf;
    EXPECT_NEAR(static_cast<double>(note.nextPdf), bsdf > 0.0 ? mixed : 0.0, 1e-6 * mixed);
    ++sums.all;
    sums.byGuide += static_cast<int>(note.isByGuide);
    const double likely = share * static_cast<double>(note.guidePdf) / mixed;  // that the guide chose it, by Bayes
    sums.surplus += likely * (static_cast<double>(note.isByGuide) - likely);
    sums.variance += likely * likely * likely * (1.0 - likely);
    if (next == nullptr) {
        return;
    }
    EXPECT_EQ(next->before.pdf, note.nextPdf);
    const float cosine = glm::dot(next->ray.direction, note.ns);
    EXPECT_NEAR(note.nextBsdfPdf, cosine * glm::one_over_pi<float>(), 1e-6F);
    EXPECT_NEAR(note.weight.g, note.baseColor.g * note.nextBsdfPdf / note.nextPdf, 1e-5F * note.weight.g);
    EXPECT_NEAR(next->before.throughput.g, vertex.before.throughput.g / (vertex.bounce > 0 ? note.arrival : 1.0F) * note.weight.g,
                1e-5F * next->before.throughput.g);
}

TEST(GuideRenderTest, ReplaysSayWhoChoseADirectionAndHowLikelyItWas)
{
    const Scene scene = doorAjar();
    RenderSettings settings = squareSettings(kSide, 2);
    settings.guide = learnFor(scene, settings);
    const Film film = renderScene(scene, settings);
    const FlatScene flat = flattened(scene);
    Replay replay(testDevice(), flat, flattenCamera(scene.cameras.front(), 1.0F, {}), settings);
    GuidedVertices sums;
    for (std::uint32_t pixel = 0; pixel < kSide * kSide; pixel += 5) {
        const ReplayedPath a = replay.trace(pixel, 0), b = replay.trace(pixel, 1);
        EXPECT_NEAR(film.pixels[pixel].mean.g, 0.5F * (a.radiance.radiance.g + b.radiance.radiance.g), 1e-6F * film.pixels[pixel].mean.g);
        for (std::size_t i = 0; i < a.vertices.size(); ++i) {
            checkGuided(a.vertices[i], i + 1 < a.vertices.size() ? &a.vertices[i + 1] : nullptr, sums);
        }
    }
    std::printf("%d directions, %d by the guide (z = %.2f); %d paths ended by roulette\n", sums.all, sums.byGuide,
                sums.surplus / std::sqrt(sums.variance), sums.rouletted);
    EXPECT_GT(sums.all, 200);
    EXPECT_GT(sums.rouletted, 10);
    EXPECT_GT(sums.byGuide, 100);
    EXPECT_NEAR(sums.surplus, 0.0, 4.0 * std::sqrt(sums.variance));
}

}  // namespace
}  // namespace glim
