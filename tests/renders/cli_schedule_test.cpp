// --schedule, --path-capacity and --caustics.
#include "tests/harness/test_device.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

TEST(AutoScheduleTest, IsThatOfTheDevicesClass)
{
    const ScratchFolder folder;
    const auto scheduleOf = [&](const std::vector<std::string>& more) {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell.gltf"), "-o", "x.exr", "--size", "16x16", "--spp", "1", "--stats", "s.json"};
        call.arguments.insert(call.arguments.end(), more.begin(), more.end());
        call.folder = folder.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return json::parse(readFileBytes(folder / "s.json")).at("schedule").get<std::string>();
    };
    const bool persistent = rulesOf(testDevice().description().deviceClass).persistent;
    EXPECT_EQ(scheduleOf({}), persistent ? "persistent" : "wavefront");
    EXPECT_EQ(scheduleOf({"--schedule", "persistent"}), "persistent");
    EXPECT_EQ(scheduleOf({"--schedule", "wavefront"}), "wavefront");
    EXPECT_EQ(scheduleOf({"--accelerator", "none"}), "wavefront");
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

// By default the paths with less noise find caustics; the film is that of a render which is told so.
TEST(CausticsChoiceTest, GivesTheFilmOfWhatItChooses)
{
    const ScratchFolder folder;
    const auto statisticsOf = [&](const std::vector<std::string>& more) {
        GlimCall call;
        call.arguments = {"render", sceneFile("sun_glass.gltf"), "-o", "x.exr", "--size", "16x16", "--spp", "64", "--stats", "s.json"};
        call.arguments.insert(call.arguments.end(), more.begin(), more.end());
        call.folder = folder.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return json::parse(readFileBytes(folder / "s.json"));
    };
    const json automatic = statisticsOf({}), on = statisticsOf({"--caustics", "on"}), off = statisticsOf({"--caustics", "off"});
    EXPECT_EQ(automatic.at("digest"), on.at("digest"));
    EXPECT_EQ(automatic.at("rays"), on.at("rays"));  // those of the small picture are not among them
    EXPECT_NE(automatic.at("digest"), off.at("digest"));
    EXPECT_NE(off.at("settings").get<std::string>().find("caustics=off"), std::string::npos);
    EXPECT_EQ(on.at("settings").get<std::string>().find("caustics"), std::string::npos);
}

}  // namespace
}  // namespace glim::test
