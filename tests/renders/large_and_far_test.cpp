// H51, H52: large triangles beside small things, and parts that lie far from the rest.
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/primitives.hpp"
#include "host/render/renderer.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glim {
namespace {

using nlohmann::json;

constexpr std::uint32_t kSide = 8;
constexpr float kSizes[] = {1e-3F, 1e3F, 1e7F};  // those between were measured once (MEASUREMENTS.md)

// A square ground at y = 0, turned about y so that its diagonal does not lie along an axis.
std::array<glm::vec3, 4> ground(float half)
{
    const float a = 0.8F * half, b = 0.6F * half;
    return {glm::vec3(-a, 0, b), {b, 0, a}, {a, 0, -b}, {-b, 0, -a}};
}

double worstOf(const Film& film, double truth)
{
    double worst = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        worst = std::max(worst, std::abs(static_cast<double>(pixel.mean.g) / truth - 1.0));
    }
    return worst;
}

// A point lamp of pi h^2 W/sr at height h: straight below it, albedo .5 gives .5.
TEST(LargeTest, H51ALampOverALargeGround)
{
    for (const float half : kSizes) {
        const float h = std::min(1.0F, half / 8.0F), x = 0.3F * h, z = 0.2F * h;
        SceneBuilder builder;
        builder.quad(ground(half), builder.lambert(glm::vec3(0.5F)));
        builder.light({"", PunctualLight::Kind::Point, {x, h, z}, {0, 0, -1}, glm::vec3(3.14159265F * h * h)});
        builder.orthographic({x, 2.0F * h, z}, {x, 0, z}, 1e-3F * h);
        RenderSettings settings = squareSettings(kSide, 16);
        settings.bounces = 1;
        const double worst = worstOf(renderScene(builder.scene(), settings), 0.5);
        printHardCase("H51", "a lamp 1 m above a ground of +-" + figure(static_cast<double>(half)) + " m", kSide * kSide * 16,
                      "radiance off by at most " + figure(worst));
        // cos^4 of an angle of 1e-3 sqrt(2) is 4e-6 below 1; from the smallest ground, which is not large, the point is lifted by 4.6e-6 h.
        EXPECT_LE(worst, half < 1.0F ? 1e-5 : 4e-6) << half;
    }
}

// A card of a metre, a centimetre above a ground: it sees nothing but sky.
TEST(LargeTest, H51ACardAboveALargeGround)
{
    for (const float half : kSizes) {
        const float s = std::min(1.0F, half / 8.0F);
        SceneBuilder builder;
        builder.quad(ground(half), builder.lambert(glm::vec3(0.5F)));
        const std::uint32_t white = builder.lambert(glm::vec3(0.5F));
        builder.quad({glm::vec3(-0.5F * s, 0.01F * s, 0.5F * s),
                      {0.5F * s, 0.01F * s, 0.5F * s},
                      {0.5F * s, 0.01F * s, -0.5F * s},
                      {-0.5F * s, 0.01F * s, -0.5F * s}},
                     white);
        builder.environment(glm::vec3(1.0F));
        builder.orthographic({0.3F * s, s, 0.1F * s}, {0, 0.01F * s, 0}, 0.2F * s);
        expectEverywhere(renderScene(builder.scene(), squareSettings(kSide, 64)), glm::dvec3(0.5), 2);
    }
}

// The file's camera is far from a ground of 2,000 km; another one, as of --look-from or the window, is 2 m above it and looks at it
// obliquely.
TEST(LargeTest, H51ACameraThatComesNear)
{
    SceneBuilder builder;
    builder.quad(ground(1e6F), builder.lambert(glm::vec3(0.5F))).environment(glm::vec3(1.0F));
    builder.orthographic({0, 1e6F, 0}, {0, 0, 0}, 1e5F);
    builder.orthographic({0.3F, 2.0F, 0.2F}, {8.3F, 0.0F, 0.2F}, 1e-4F);
    FlatScene flat = flattened(builder.scene());
    ASSERT_EQ(flat.features & kFeatureLargeTriangles, 0U);
    RenderSettings settings = squareSettings(kSide, 1);
    settings.aov = Aov::Depth;
    const auto render = [&] { return renderFlat(flat, builder.scene().cameras.back(), settings); };
    const double truth = std::sqrt(68.0), off = worstOf(render(), truth);
    flat.largest.clear();
    const double naive = worstOf(render(), truth);
    printHardCase("H51", "depth of a ground of +-1e6 m from 2 m above it", kSide * kSide, "off by at most " + figure(off),
                  "without care: " + figure(naive));
    EXPECT_LT(off, 6e-5);  // across the window: 1e-4 / tan(14 degrees) of 8.2 m
    EXPECT_GT(naive, 1e-3);
}

// As the window does it: kernels change with the camera, and those before come back with theirs.
TEST(LargeTest, H51ARendererFollowsItsCamera)
{
    SceneBuilder builder;
    builder.quad(ground(1e6F), builder.lambert(glm::vec3(0.5F))).environment(glm::vec3(1.0F));
    builder.orthographic({0, 1e6F, 0}, {0, 0, 0}, 1e5F);
    builder.orthographic({0.3F, 2.0F, 0.2F}, {8.3F, 0.0F, 0.2F}, 1e-4F);
    const FlatScene flat = flattened(builder.scene());
    const FlatCamera far = flattenCamera(builder.scene().cameras.front(), 1.0F), near = flattenCamera(builder.scene().cameras.back(), 1.0F);
    RenderSettings settings = squareSettings(kSide, 1);
    settings.aov = Aov::Depth;
    Renderer renderer(testDevice(), flat, far, settings);
    const auto render = [&](const FlatCamera& camera) {
        renderer.adapt(flat, camera);
        renderer.restart(camera, kSide, kSide);
        return renderer.render([](const RenderProgress&) { return true; });
    };
    const Film before = render(far);
    for (int i = 0; i < 2; ++i) {
        EXPECT_LT(worstOf(render(near), std::sqrt(68.0)), 6e-5);
        EXPECT_TRUE(sameBits(render(far), before));
    }
}

std::vector<float> toFloats(const std::vector<glm::vec3>& vectors)
{
    std::vector<float> floats;
    for (const glm::vec3& v : vectors) {
        floats.insert(floats.end(), {v.x, v.y, v.z});
    }
    return floats;
}

// A smooth ball of .1 m under a sun, seen from the front; and, if `distance` is not 0, a card of a metre so far away.
Scene ballAndCard(double distance)
{
    test::GltfBuilder builder;
    builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.8, 0.8, 1}}, {"metallicFactor", 0}}}});
    const std::vector<glm::vec3> normals = listVertices(icosphere(3));
    std::vector<float> positions = toFloats(normals);
    std::transform(positions.begin(), positions.end(), positions.begin(), [](float x) { return 0.1F * x; });
    const json attributes = {{"POSITION", builder.addVec3(positions)}, {"NORMAL", builder.addVec3(toFloats(normals))}};
    builder.addNode({{"mesh", builder.addMesh({{"attributes", attributes}, {"material", 0}})}});
    builder.append("cameras",
                   {{"type", "orthographic"}, {"orthographic", {{"xmag", 0.15}, {"ymag", 0.15}, {"znear", 0.01}, {"zfar", 100}}}});
    builder.addNode({{"camera", 0}, {"translation", {0, 0, 5}}});
    if (distance > 0.0) {
        builder.addNode({{"mesh", builder.addTriangleMesh()}, {"translation", {distance, 0, 0}}});
    }
    Scene scene = test::load(builder);
    scene.lights.push_back({"", PunctualLight::Kind::Directional, {}, glm::normalize(glm::vec3(-0.5F, -0.6F, -0.7F)), glm::vec3(3.0F)});
    return scene;
}

Film renderBall(const Scene& scene)
{
    RenderSettings settings = squareSettings(48, 16);
    settings.bounces = 1;
    return renderScene(scene, settings);
}

// The largest difference of two pixels.
double differenceOf(const Film& a, const Film& b)
{
    double worst = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        worst = std::max(worst, std::abs(static_cast<double>(a.pixels[i].mean.g) - static_cast<double>(b.pixels[i].mean.g)));
    }
    return worst;
}

// What the centre of the scene's box makes of it.
Scene movedTo(Scene scene, const glm::dvec3& origin)
{
    const glm::dvec3 step = scene.origin - origin;
    scene.origin = origin;
    for (Camera& camera : scene.cameras) {
        camera.position = glm::dvec3(camera.position) + step;
    }
    return scene;
}

TEST(FarTest, H52AStrayPartLeavesTheRestAsItIs)
{
    const Film alone = renderBall(ballAndCard(0.0));
    for (const double distance : {1e4, 1e7}) {
        const Scene scene = ballAndCard(distance);
        const double off = differenceOf(renderBall(scene), alone);
        const double naive = differenceOf(renderBall(movedTo(scene, {0.5 * distance, 0.0, 0.0})), alone);
        printHardCase("H52", "a ball of .1 m and a card " + figure(distance) + " m away", 48.0 * 48.0 * 16.0,
                      "the ball's pixels differ by at most " + figure(off), "origin in the box's centre: " + figure(naive));
        EXPECT_LT(off, 1e-4) << distance;
        EXPECT_GT(naive, 0.05) << distance;
    }
}

TEST(FarTest, WarnsOnceOfWhatFloat32CannotHold)
{
    const auto warningsOf = [](double distance) {
        std::vector<Message> found;
        std::ranges::copy_if(ballAndCard(distance).warnings, std::back_inserter(found),
                             [](const Message& warning) { return warning.id == MessageId::FarPart; });
        return found;
    };
    EXPECT_EQ(warningsOf(0.0).size(), 0U);
    EXPECT_EQ(warningsOf(1e4).size(), 0U);
    const std::vector<Message> warnings = warningsOf(1e6);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].place, "nodes[2] (steps of 0.0625 m, parts of 1 m)");
}

}  // namespace
}  // namespace glim
