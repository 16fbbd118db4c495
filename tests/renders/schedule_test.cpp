// Whatever a render is asked for, the persistent schedule gives the bits and the rays of the wavefront, or refuses.
#include "host/error.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/render_resources.hpp"
#include "host/render/replay.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace glim {
namespace {

struct Rendered {
    Film film;
    RenderStatistics statistics;
};

Rendered renderBy(Schedule schedule, const FlatScene& flat, const FlatCamera& camera, RenderSettings settings)
{
    settings.schedule = schedule;
    Renderer renderer(testDevice(), flat, camera, settings);
    Film film = renderer.render([](const RenderProgress&) { return true; });
    return {std::move(film), renderer.statistics()};
}

// Returns the persistent one.
Rendered expectSame(const FlatScene& flat, const FlatCamera& camera, const RenderSettings& settings)
{
    const Rendered wavefront = renderBy(Schedule::Wavefront, flat, camera, settings);
    Rendered persistent = renderBy(Schedule::Persistent, flat, camera, settings);
    EXPECT_TRUE(sameBits(wavefront.film, persistent.film));
    EXPECT_EQ(wavefront.statistics.cameraAndBounceRays, persistent.statistics.cameraAndBounceRays);
    EXPECT_EQ(wavefront.statistics.shadowRays, persistent.statistics.shadowRays);
    EXPECT_EQ(wavefront.statistics.nonFinite, persistent.statistics.nonFinite);
    EXPECT_EQ(wavefront.statistics.kernels.count("trace_paths"), 0U);
    EXPECT_EQ(persistent.statistics.kernels.count("trace_closest"), 0U);
    return persistent;
}

struct Variant {
    const char* name;
    std::function<void(RenderSettings&)> change;
    Lens lens = {};
};

void PrintTo(const Variant& variant, std::ostream* out) { *out << variant.name; }

class ScheduleTest : public testing::TestWithParam<Variant> {};

TEST_P(ScheduleTest, ChangesNoBit)
{
    const Scene scene = mixedScene();
    RenderSettings settings = squareSettings(1, 40);
    settings.width = 37;
    settings.height = 23;
    GetParam().change(settings);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 37.0F / 23.0F, GetParam().lens);
    const Rendered rendered = expectSame(flattened(scene), camera, settings);
    EXPECT_GT(rendered.statistics.cameraAndBounceRays, 0U);
}

const Variant kVariants[] = {
    {"Plain", [](RenderSettings&) {}},
    {"Independent", [](RenderSettings& s) { s.sampler = Sampler::Independent; }},
    {"Lens", [](RenderSettings&) {}, {0.1F, 4.0F}},
    {"Clamp", [](RenderSettings& s) { s.clampIndirect = 0.5F; }},
    {"NoBounces", [](RenderSettings& s) { s.bounces = 0; }},
    {"OneBounce", [](RenderSettings& s) { s.bounces = 1; }},
    {"Emission", [](RenderSettings& s) { s.paths = PathParts::Emission; }},
    {"Direct", [](RenderSettings& s) { s.paths = PathParts::Direct; }},
    {"Indirect", [](RenderSettings& s) { s.paths = PathParts::Indirect; }},
    {"Normals",
     [](RenderSettings& s) {
         s.aov = Aov::Normal;
         s.bounces = 0;
     }},
    {"Steps",
     [](RenderSettings& s) {
         s.aov = Aov::BvhSteps;
         s.bounces = 0;
     }},
    {"Suspects", [](RenderSettings& s) { s.suspects = 3; }},
    {"Course",
     [](RenderSettings& s) {
         s.adaptive = Adaptive::Course;
         s.sampler = Sampler::Independent;
         s.sampleEnd = 128;
     }},
    {"Neighbours",
     [](RenderSettings& s) {
         s.adaptive = Adaptive::Neighbours;
         s.sampleEnd = 160;
     }},
    {"LaterSamples",
     [](RenderSettings& s) {
         s.sampleBegin = 70;
         s.sampleEnd = 141;
         s.seed = 7;
     }},
    {"SmallGroups", [](RenderSettings& s) { s.workgroup = 32; }},
    {"LargeGroups", [](RenderSettings& s) { s.workgroup = 128; }},
    {"FewPathsAtOnce", [](RenderSettings& s) { s.pathCapacity = 1U << 8; }},
    {"OddPathsAtOnce", [](RenderSettings& s) { s.pathCapacity = 3001; }},
    {"Tiles", [](RenderSettings& s) { s.tilePixels = 300; }},
};

INSTANTIATE_TEST_SUITE_P(Settings, ScheduleTest, testing::ValuesIn(kVariants),
                         [](const testing::TestParamInfo<Variant>& variant) { return std::string(variant.param.name); });

FlatScene closedBox(SceneBuilder& builder, float albedo)
{
    builder.cube(1.0F, builder.lambert(glm::vec3(albedo), glm::vec3(1.0F)), true).perspective({0, 0, 0.5F}, {0, 0, 0}, 1.0F);
    return flattened(builder.scene());
}

TEST(PersistentTest, FeaturesThatTheSceneDoesNotNeed)
{
    SceneBuilder builder;
    FlatScene flat = closedBox(builder, 0.9F);
    const FlatCamera camera = flattenCamera(builder.scene().cameras.front(), 1.0F);
    const Film lean = expectSame(flat, camera, squareSettings(16, 16)).film;
    flat.features |= kFeatureSpheres | kFeatureMirror | kFeatureDielectric | kFeatureSphereLights | kFeaturePunctualLights;
    EXPECT_TRUE(sameBits(lean, expectSame(flat, camera, squareSettings(16, 16)).film));
}

// Roulette spares white paths, so that nothing ends these: each takes more steps than a dispatch may.
TEST(PersistentTest, LongPathsTakeSeveralDispatches)
{
    SceneBuilder builder;
    const FlatScene flat = closedBox(builder, 1.0F);
    RenderSettings settings = squareSettings(9, 2);
    settings.bounces = 1500;
    const RenderStatistics statistics = expectSame(flat, flattenCamera(builder.scene().cameras.front(), 1.0F), settings).statistics;
    EXPECT_GT(statistics.kernels.at("trace_paths").dispatches, 2 * statistics.kernels.at("generate_rays").dispatches);
}

TEST(PersistentTest, PathsAreReplayedByTheWavefront)
{
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);
    RenderSettings settings = squareSettings(16, 8);
    settings.schedule = Schedule::Persistent;
    Renderer renderer(testDevice(), flat, camera, settings);
    Replay replay(testDevice(), flat, camera, settings);
    for (std::uint32_t pixel = 3; pixel < 256; pixel += 50) {
        const ReplayedPath path = replay.trace(pixel, 5);
        EXPECT_FALSE(path.vertices.empty());
        EXPECT_EQ(traceSample(renderer.resources(), pixel, 5).radiance, path.radiance.radiance);
    }
}

TEST(ScheduleChoiceTest, AutoIsTheFasterOneWhereThatCan)
{
    DeviceDescription software, other;
    software.deviceClass = DeviceClass::Llvmpipe;
    other.deviceClass = DeviceClass::DiscreteGpu;
    RenderSettings settings;
    settings.schedule = Schedule::Auto;
    EXPECT_EQ(chooseSchedule(settings, software, 0), Schedule::Persistent);
    EXPECT_EQ(chooseSchedule(settings, other, 0), Schedule::Wavefront);
    EXPECT_EQ(chooseSchedule(settings, software, kAllFeatures & ~kFeatureScattering), Schedule::Persistent);
    EXPECT_EQ(chooseSchedule(settings, software, kFeatureScattering), Schedule::Wavefront);
    for (const auto& ofCourse : {std::function([](RenderSettings& s) { s.course.accelerator = Accelerator::None; }),
                                 std::function([](RenderSettings& s) { s.course.intersector = Intersector::MollerTrumbore; }),
                                 std::function([](RenderSettings& s) { s.course.direct = DirectLight::Bsdf; }),
                                 std::function([](RenderSettings& s) { s.course.roulette = Roulette::None; })}) {
        RenderSettings course = settings;
        ofCourse(course);
        EXPECT_EQ(chooseSchedule(course, software, 0), Schedule::Wavefront);
    }
    for (const Schedule asked : {Schedule::Wavefront, Schedule::Persistent}) {
        settings.schedule = asked;
        EXPECT_EQ(chooseSchedule(settings, software, 0), asked);
        EXPECT_EQ(chooseSchedule(settings, other, 0), asked);
    }
}

TEST(PersistentTest, RefusesWhatOneKernelDoesNot)
{
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);
    for (const auto& ofCourse : {std::function([](RenderSettings& s) { s.course.accelerator = Accelerator::None; }),
                                 std::function([](RenderSettings& s) { s.course.direct = DirectLight::Lights; }),
                                 std::function([](RenderSettings& s) { s.course.roulette = Roulette::Fixed; })}) {
        RenderSettings settings = squareSettings(4, 1);
        ofCourse(settings);
        settings.schedule = Schedule::Persistent;
        test::expectRefusal<InputError>([&] { const Renderer renderer(testDevice(), flat, camera, settings); }, MessageId::Conflict,
                                        {.place = "--schedule", .value = "persistent", .expected = "--schedule wavefront"});
    }
}

}  // namespace
}  // namespace glim
