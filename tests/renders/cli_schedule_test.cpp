// --schedule auto on a software device, and how schedules are measured.
#include "host/flatten/flatten_scene.hpp"
#include "host/render/measure_schedules.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/test_device.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

// A busy moment had made it the wavefront for good.
TEST(AutoScheduleTest, ASoftwareDeviceTakesThePersistentOneWhateverIsKept)
{
    const ScratchFolder folder;
    const auto render = [&](const std::vector<std::string>& more) {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell.gltf"), "-o",  "x.exr",   "--size", "64x64", "--spp",
                          "4096",   "--target-rmse",           "90%", "--stats", "s.json"};
        call.arguments.insert(call.arguments.end(), more.begin(), more.end());
        call.environment["GLIM_CACHE_DIR"] = (folder / "cache").string();
        call.folder = folder.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_EQ(run.err.find("measured"), std::string::npos) << run.err;
        return json::parse(readFileBytes(folder / "s.json"));
    };
    const json first = render({});
    EXPECT_EQ(first.at("schedule"), "persistent");
    EXPECT_FALSE(std::filesystem::exists(folder / "cache")) << "nothing is measured or kept";
    const std::string device = first.at("device").at("name"), driver = first.at("device").at("driver");
    std::filesystem::create_directories(folder / "cache");
    const GlimRun version = runGlim({"--version"});
    writeText(
        folder / "cache" / "schedules.json",
        json{{device + ", " + driver, {{"version", version.out.substr(0, version.out.find('\n'))}, {"fastest", "wavefront"}}}}.dump());
    EXPECT_EQ(render({}).at("schedule"), "persistent");
    EXPECT_EQ(render({"--schedule", "wavefront"}).at("schedule"), "wavefront");
    EXPECT_EQ(render({"--accelerator", "none"}).at("schedule"), "wavefront");
}

TEST(AutoScheduleTest, RatesAreThoseOfTheDevicesClock)
{
    const Scene scene = mixedScene();
    RenderSettings settings = squareSettings(64, 4096);
    settings.schedule = Schedule::Auto;
    const ScheduleRates rates = measureSchedules(testDevice(), flattened(scene), flattenCamera(scene.cameras.front(), 1.0F), settings);
    ASSERT_EQ(rates.wavefront.size(), 5U);
    ASSERT_EQ(rates.persistent.size(), 5U);
    for (const std::vector<double>* each : {&rates.wavefront, &rates.persistent}) {
        for (const double rate : *each) {
            EXPECT_GT(rate, 1e3);
            EXPECT_LT(rate, 1e12);
        }
    }
}

// In a scene whose caustics are by light paths. 2097152 is beyond the default.
TEST(PathCapacityTest, ChangesNoBit)
{
    const ScratchFolder folder;
    for (const char* schedule : {"wavefront", "persistent"}) {
        const auto digest = [&](const std::vector<std::string>& more) {
            GlimCall call;
            call.arguments = {"render",     sceneFile("cornell_mirror_glass.gltf"),
                              "-o",         "x.exr",
                              "--size",     "16x16",
                              "--spp",      "64",
                              "--schedule", schedule,
                              "--stats",    "s.json"};
            call.arguments.insert(call.arguments.end(), more.begin(), more.end());
            call.folder = folder.path();
            const GlimRun run = runGlim(call);
            EXPECT_EQ(run.exitCode, 0) << run.err;
            return json::parse(readFileBytes(folder / "s.json")).at("digest").get<std::string>();
        };
        const std::string usual = digest({});
        for (const char* capacity : {"129", "2097152"}) {
            EXPECT_EQ(digest({"--path-capacity", capacity}), usual) << schedule << ' ' << capacity;
        }
    }
}

}  // namespace
}  // namespace glim::test
