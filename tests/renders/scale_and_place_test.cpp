// H7, H8: the same scene at any scale and place gives the same picture.
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/primitives.hpp"
#include "host/measure/z_test.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <utility>

namespace glim {
namespace {

using nlohmann::json;

constexpr std::uint32_t kRoomSide = 32;
constexpr double kScales[] = {1e-4, 1e-2, 1.0, 1e2, 1e5};
constexpr double kShifts[] = {0.0, 1e4, 1e6, 1e9};

json lambert(double albedo, double emission)
{
    return {{"pbrMetallicRoughness", {{"baseColorFactor", {albedo, 0.5, albedo, 1}}, {"metallicFactor", 0}}},
            {"emissiveFactor", {emission, emission, emission}},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

std::size_t addMesh(test::GltfBuilder& builder, const Scene& scene, std::size_t material)
{
    std::vector<float> positions;
    for (const Triangle& triangle : makePrimitives(scene).triangles) {
        for (const glm::vec3& v : triangle.vertices) {
            positions.insert(positions.end(), {v.x, v.y, v.z});
        }
    }
    return builder.addMesh({{"attributes", {{"POSITION", builder.addVec3(positions)}}}, {"material", material}});
}

// The meshes of a closed room, of a box and of a lamp, with materials 0, 1 and 2; and a camera.
struct RoomMeshes {
    test::GltfBuilder builder;
    std::size_t room, box, lamp;
};

RoomMeshes meshesOfRoom(double wallEmission)
{
    SceneBuilder room, box, lamp;
    for (SceneBuilder* builder : {&room, &box, &lamp}) {
        builder->lambert(glm::vec3(0.5F));
    }
    room.cube(1.0F, 0, true);
    box.cube(0.3F, 0, false);
    lamp.quad({glm::vec3(-0.4F, 0.9F, -0.4F), {0.4F, 0.9F, -0.4F}, {0.4F, 0.9F, 0.4F}, {-0.4F, 0.9F, 0.4F}}, 0);
    RoomMeshes meshes{};
    meshes.builder.append("materials", lambert(0.7, wallEmission));
    meshes.builder.append("materials", lambert(0.4, 0.0));
    meshes.builder.append("materials", lambert(0.0, 1.0));
    meshes.builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    meshes.room = addMesh(meshes.builder, room.scene(), 0);
    meshes.box = addMesh(meshes.builder, box.scene(), 1);
    meshes.lamp = addMesh(meshes.builder, lamp.scene(), 2);
    return meshes;
}

// A closed room of albedo .7 whose walls emit a little, with a lamp, a tilted box and a ball; all of it under one root node.
Scene roomAt(double scale, double shift)
{
    auto [builder, room, box, lamp] = meshesOfRoom(0.125);
    builder.append("nodes", {{"mesh", room}});
    builder.append("nodes", {{"mesh", box}, {"translation", {-0.375, -0.5625, -0.3125}}, {"rotation", {0.1, 0.3, 0.05, 0.9}}});
    builder.append("nodes", {{"mesh", lamp}});
    builder.append("nodes", {{"translation", {0.4375, -0.625, 0.125}}, {"extras", {{"sphere", {{"radius", 0.35}, {"material", 1}}}}}});
    builder.append("nodes", {{"translation", {0, 0, 0.9375}}, {"camera", 0}});
    builder.addNode({{"children", {0, 1, 2, 3, 4}}, {"translation", {shift, -shift, shift}}, {"scale", {scale, scale, scale}}});
    return test::load(builder);
}

Film renderRoom(const Scene& scene, std::uint32_t seed)
{
    constexpr std::size_t kRays = 8;  // of a path of four bounces
    RenderSettings settings = squareSettings(
        kRoomSide, static_cast<std::uint32_t>(hardTrials(kRoomSide * kRoomSide * samplesFor(64), kRays) / (kRoomSide * kRoomSide)));
    settings.bounces = 4;
    settings.seed = seed;
    settings.sampler = Sampler::Independent;
    return renderScene(scene, settings);
}

double samplesOf(const Film& film) { return 1.0 * kRoomSide * kRoomSide * film.sampleRanges.back().second; }

ZTest compare(const Film& film, const Film& reference) { return zTest(makePicture(film), makePicture(reference), 1e-3 / 200.0); }

std::string describe(const ZTest& z)
{
    return "z of means " + figure(z.meanZ[0]) + ", worst block " + figure(z.worstZ) + " of " + figure(z.blockLimit);
}

bool sameGeometry(const Scene& a, const Scene& b)
{
    const std::vector<Triangle> here = makePrimitives(a).triangles, there = makePrimitives(b).triangles;
    return here.size() == there.size() && std::memcmp(here.data(), there.data(), here.size() * sizeof(Triangle)) == 0 &&
           a.spheres[0].center == b.spheres[0].center && a.cameras[0].position == b.cameras[0].position;
}

TEST(ScaleAndPlaceTest, H7EveryScaleGivesThePicture)
{
    const Film unit = renderRoom(roomAt(1.0, 0.0), 0);
    std::uint32_t seed = 1;
    for (const double scale : kScales) {
        const Film film = renderRoom(roomAt(scale, 0.0), seed++);
        const ZTest z = compare(film, unit);
        printHardCase("H7", "room at scale " + figure(scale), samplesOf(film), describe(z));
        EXPECT_TRUE(z.agrees()) << scale << ": " << describe(z);
    }
}

TEST(ScaleAndPlaceTest, H7PowersOfTwoGiveTheBits)
{
    const Film unit = renderRoom(roomAt(1.0, 0.0), 0);
    for (const double scale : {0x1p-13, 0x1p17}) {
        Film film = renderRoom(roomAt(scale, 0.0), 0);
        for (std::size_t i = 0; i < film.pixels.size(); ++i) {  // depths are in metres
            EXPECT_EQ(film.pixels[i].depth, unit.pixels[i].depth * static_cast<float>(scale)) << i;
            film.pixels[i].depth = unit.pixels[i].depth;
        }
        EXPECT_TRUE(sameBits(film, unit)) << scale;
    }
}

// The loader recentres in double, so that what is rendered is the same; without that, 1e6 m from the origin floats are .06 m apart.
TEST(ScaleAndPlaceTest, H8EveryPlaceGivesThePicture)
{
    // At these scales nodes stand at multiples of 1/16, exact in double, and the origin's grid of about scale / 128 divides all shifts.
    for (const double scale : {1.0, 1e2}) {
        for (const double shift : kShifts) {
            EXPECT_TRUE(sameGeometry(roomAt(scale, shift), roomAt(scale, 0.0))) << scale << " at " << shift;
        }
    }
    const Film unit = renderRoom(roomAt(1.0, 0.0), 0);
    EXPECT_TRUE(sameBits(renderRoom(roomAt(1.0, 1e9), 0), unit));
    Scene naive = roomAt(1.0, 0.0);
    for (MeshInstance& instance : naive.instances) {
        instance.worldFromMesh[3] += glm::dvec4(1e6, 1e6, 1e6, 0.0);
    }
    naive.spheres[0].center += 1e6F;
    naive.cameras[0].position += 1e6F;
    const ZTest z = compare(renderRoom(naive, 1), unit);
    printHardCase("H8", "room at 0 to 1e9", samplesOf(unit), "the same bits", "coordinates of 1e6 in float: " + describe(z));
    EXPECT_FALSE(z.agrees());
}

// 1e9 m from the origin doubles are 1.2e-7 m apart, .1 % of the smallest room: pictures are the same within their error. With the same
// random numbers, so that noise, which they share, neither hides nor feigns a difference.
TEST(ScaleAndPlaceTest, H8SmallOrLargeAndFarAway)
{
    std::uint32_t seed = 2;
    for (const auto& [scale, shift] : {std::pair{1e-4, 1e9}, {1e-2, 1e6}, {1e5, 1e4}}) {
        const Film unit = renderRoom(roomAt(1.0, 0.0), seed);
        const ZTest z = compare(renderRoom(roomAt(scale, shift), seed++), unit);
        printHardCase("H8", "room of " + figure(scale) + " at " + figure(shift), samplesOf(unit), describe(z));
        EXPECT_TRUE(z.agrees()) << scale << " at " << shift << ": " << describe(z);
    }
}

// A closed room and a box in it, each of a mesh that has another instance outside, under a sky that is a million times as bright as the
// lamp's light on the walls. The nodes stand below one with this scale and place.
Scene roomOfInstances(const glm::dvec3& scale, double shift)
{
    auto [builder, walls, body, lamp] = meshesOfRoom(0.0);
    const json turn = {0.1, 0.3, 0.05, 0.9};
    builder.append("nodes", {{"mesh", walls}});
    builder.append("nodes", {{"mesh", walls}, {"translation", {3, 0.5, 0}}, {"rotation", turn}});
    builder.append("nodes", {{"mesh", body}, {"translation", {-0.375, -0.5625, -0.3125}}, {"rotation", turn}});
    builder.append("nodes", {{"mesh", body}, {"translation", {0.4, -0.7, 0.2}}, {"scale", {1, -0.5, 0.7}}});
    builder.append("nodes", {{"mesh", lamp}});
    builder.append("nodes", {{"translation", {0, 0, 0.9375}}, {"camera", 0}});
    builder.addNode({{"children", {0, 1, 2, 3, 4, 5}}, {"translation", {shift, -shift, shift}}, {"scale", {scale.x, scale.y, scale.z}}});
    LoadOptions options;
    options.environment = glm::vec3(1e5F);
    return test::load(builder, options);
}

Film renderShared(const Scene& scene, std::uint64_t maxFlatTriangles, std::uint32_t seed)
{
    const Primitives primitives = makePrimitives(scene, maxFlatTriangles);
    const FlatScene flat = flattenScene(scene, primitives, buildSceneBvh(primitives));
    EXPECT_EQ((flat.features & kFeatureInstances) != 0, maxFlatTriangles == 0);
    RenderSettings settings = squareSettings(kRoomSide, samplesFor(64));
    settings.bounces = 4;
    settings.seed = seed;
    settings.sampler = Sampler::Independent;
    return renderFlat(flat, scene.cameras.front(), settings);
}

// A ray that leaves the room meets the sky, and one such sample is seen.
TEST(ScaleAndPlaceTest, H1H7H8RoomsThatAreInstances)
{
    std::uint32_t seed = 0;
    for (const auto& [scale, shift] : {std::pair{glm::dvec3(1.0), 0.0},
                                       {glm::dvec3(-1.0, 1.0, 1.0), 0.0},
                                       {glm::dvec3(4.0, 1.0, 0.02), 0.0},
                                       {glm::dvec3(1e-4), 1e3},
                                       {glm::dvec3(1e4), 0.0},
                                       {glm::dvec3(1.0, -1.5, 1.0), 1e9},
                                       {glm::dvec3(1e4), 1e9}}) {
        const Scene scene = roomOfInstances(scale, shift);
        const Film shared = renderShared(scene, 0, seed++), flat = renderShared(scene, 1U << 20U, seed++);
        const ZTest z = compare(shared, flat);
        const std::string name = "shared room of " + figure(scale.x) + ", " + figure(scale.z) + " at " + figure(shift);
        printHardCase("H1, H7, H8", name, samplesOf(shared), describe(z));
        EXPECT_TRUE(z.agrees()) << name << ": " << describe(z);
        for (const PixelMoments& pixel : shared.pixels) {
            EXPECT_LT(pixel.mean.g, 10.0F) << name << ": a ray left the room";
        }
    }
}

// A convex object under a constant sky is albedo times sky everywhere unless it shadows itself (T1).
TEST(ScaleAndPlaceTest, H7NothingShadowsItself)
{
    double pixels = 0.0;
    for (const double scale : kScales) {
        const auto s = static_cast<float>(scale);
        SceneBuilder ball, box;
        ball.sphere({0, 0, 0}, s, ball.lambert(glm::vec3(0.5F))).environment(glm::vec3(1.0F));
        ball.perspective({0, 0, 5 * s}, {0, 0, 0}, 0.2F);
        box.cube(s, box.lambert(glm::vec3(0.5F)), false).environment(glm::vec3(1.0F));
        box.perspective({3 * s, 4 * s, 5 * s}, {0, 0, 0}, 0.1F);
        for (const SceneBuilder* builder : {&ball, &box}) {
            const auto spp = static_cast<std::uint32_t>(hardTrials(kRoomSide * kRoomSide * 64, 2) / (kRoomSide * kRoomSide));
            expectEverywhere(renderScene(builder->scene(), squareSettings(kRoomSide, spp)), glm::dvec3(0.5), 2);
            pixels += 1.0 * kRoomSide * kRoomSide * spp;
        }
    }
    printHardCase("H7", "ball and box under a sky, scale 1e-4 to 1e5", pixels, "every pixel exact");
}

}  // namespace
}  // namespace glim
