// What might mislead path guiding: a picture of one pixel, lamps that were dark to the paths that learned, more lamps than any cell can
// know, and light that comes by way of a mirror alone.
#include "host/flatten/flatten_scene.hpp"
#include "host/render/learn_guide.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

Scene committed(const char* name) { return loadGltf(std::string(GLIM_SOURCE_DIR "/scenes/") + name + ".gltf"); }

std::shared_ptr<const Guide> learnFor(const Scene& scene, const RenderSettings& settings)
{
    return learnGuide(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings).guide;
}

// Without a guide, then with one that is learned in `learned`, by other samples.
void expectTheMeanWithoutIt(const std::string& name, const Scene& scene, const Scene& learned, RenderSettings settings)
{
    const Film plain = renderScene(scene, settings);
    settings.seed = 1;
    settings.guide = learnFor(learned, settings);
    EXPECT_GT(settings.guide->cells, 0U);
    expectSameMean(name, renderScene(scene, settings), plain);
}

TEST(GuideAdversaryTest, APictureOfOnePixel)
{
    const Scene scene = committed("closed_room");
    expectTheMeanWithoutIt("one pixel", scene, scene, squareSettings(1, 1U << 15U));
}

TEST(GuideAdversaryTest, LightByWayOfAMirrorAlone)
{
    const Scene scene = committed("mirror_room");
    expectTheMeanWithoutIt("mirror room", scene, scene, squareSettings(32, 1024));
}

// Two rooms with a slit between them, of which the one without the camera has triangles that emit under its ceiling, each a light, instead
// of a lamp.
Scene manyLamps(std::uint32_t count)
{
    constexpr std::uint32_t kShades = 16;
    Scene scene = committed("door_ajar");
    const auto lamp = std::find_if(scene.instances.begin(), scene.instances.end(), [](const MeshInstance& i) { return i.name == "lamp"; });
    scene.instances.erase(lamp);
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(count)));
    const float step = 3.6F / static_cast<float>(columns);
    const Triangle triangle = {{glm::vec3(0.0F), {step, 0.0F, 0.0F}, {step, 0.0F, step}}};
    const auto firstMesh = static_cast<std::uint32_t>(scene.meshes.size());
    for (std::uint32_t shade = 0; shade < kShades; ++shade) {
        scene.materials.push_back(makeLambert(glm::vec3(0.0F), glm::vec3(0.5F * std::exp2(0.25F * static_cast<float>(shade)))));
        addMesh(scene, {triangle}, static_cast<std::uint32_t>(scene.materials.size() - 1));
        scene.instances.pop_back();
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        glm::dmat4 worldFromMesh(1.0);
        worldFromMesh[3] =
            glm::dvec4(4.3F + step * static_cast<float>(i % columns), 2.95F, 0.2F + step * static_cast<float>(i / columns), 1);
        scene.instances.push_back({"", firstMesh + (i * 2654435761U >> 20U) % kShades, worldFromMesh});
    }
    return scene;
}

TEST(GuideAdversaryTest, ManyEmittersBehindADoor)
{
    const Scene scene = manyLamps(samplesFor(50000, 20));
    expectTheMeanWithoutIt("many emitters", scene, scene, squareSettings(16, 1024));
}

enum class Hidden { Point, Spot, Ball, BehindAMirror };

// A room with a lamp, and on its floor a lantern with a brighter one. The guide is learned while the lantern's lid is on: it knows neither
// the lamp in it nor what that shines on. Point and spot lights are found by light sampling alone, the lamp over the mirror by BSDF
// sampling alone.
Scene withLantern(Hidden hidden, bool lid)
{
    using Corners = std::array<glm::vec3, 4>;
    SceneBuilder b;
    const std::uint32_t wall = b.lambert(glm::vec3(0.6F)), tin = b.lambert(glm::vec3(0.6F), glm::vec3(0.0F), true);
    const auto emitting = [&](float radiance) { return b.lambert(glm::vec3(0.0F), glm::vec3(radiance)); };
    const auto level = [](float half, float x, float y) {
        return Corners{glm::vec3(x - half, y, half), {x + half, y, half}, {x + half, y, -half}, {x - half, y, -half}};
    };
    const auto turned = [](const Corners& corners) { return Corners{corners[3], corners[2], corners[1], corners[0]}; };
    b.cube(1.0F, wall, true).quad(turned(level(0.2F, -0.6F, 0.98F)), emitting(0.5F));
    const Corners floor = level(0.3F, 0.0F, -0.99F), top = level(0.3F, 0.0F, -0.5F);
    for (int i = 0; i < 4; ++i) {
        b.quad({floor[i], floor[(i + 1) % 4], top[(i + 1) % 4], top[i]}, tin);
    }
    if (lid) {
        b.quad(top, tin);
    }
    switch (hidden) {
    case Hidden::Point: b.light({"", PunctualLight::Kind::Point, {0, -0.9F, 0}, {0, 0, -1}, glm::vec3(3.0F)}); break;
    case Hidden::Spot: b.light({"", PunctualLight::Kind::Spot, {0, -0.9F, 0}, {0, 1, 0}, glm::vec3(30.0F), 0.005F, 0.01F}); break;
    case Hidden::Ball: b.sphere({0, -0.8F, 0}, 0.02F, emitting(2000.0F)); break;
    case Hidden::BehindAMirror: b.quad(floor, b.mirror(glm::vec3(0.9F))).quad(turned(level(0.15F, 0, -0.7F)), emitting(300.0F)); break;
    }
    b.perspective({0.0F, 0.0F, 0.95F}, {0.0F, -0.1F, -1.0F}, 1.3F);
    return b.scene();
}

class HiddenLampTest : public testing::TestWithParam<Hidden> {};

TEST_P(HiddenLampTest, ShinesThoughItWasDarkToTheGuide)
{
    const Scene open = withLantern(GetParam(), false), closed = withLantern(GetParam(), true);
    RenderSettings settings = squareSettings(24, 512);
    settings.caustics = false;
    expectTheMeanWithoutIt("hidden lamp", open, closed, settings);
    settings.sampleEnd = 64;
    EXPECT_GT(meanOf(renderScene(open, settings)).mean.g, 2.0 * meanOf(renderScene(closed, settings)).mean.g);
}

INSTANTIATE_TEST_SUITE_P(Lamps, HiddenLampTest, testing::Values(Hidden::Point, Hidden::Spot, Hidden::Ball, Hidden::BehindAMirror),
                         [](const testing::TestParamInfo<Hidden>& hidden) {
                             return std::string(std::array{"point", "spot", "ball", "behindAMirror"}[static_cast<int>(hidden.param)]);
                         });

}  // namespace
}  // namespace glim
