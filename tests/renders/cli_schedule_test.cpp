// --schedule auto: measured once, in a render that is long enough, and kept.
#include "host/render/settings.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Rendered {
    std::string err, schedule;
};

class AutoScheduleTest : public testing::Test {
protected:
    // 64x64 pixels of as many samples as were asked for, the first 32 of which are good enough.
    Rendered render(const std::string& samples, const std::vector<std::string>& more = {})
    {
        GlimCall call;
        call.arguments = {"render", sceneFile("cornell.gltf"), "-o",  "x.exr",   "--size", "64x64", "--spp",
                          samples,  "--target-rmse",           "90%", "--stats", "s.json"};
        call.arguments.insert(call.arguments.end(), more.begin(), more.end());
        call.environment["GLIM_CACHE_DIR"] = cache_.string();
        call.folder = folder_.path();
        const GlimRun run = runGlim(call);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return {run.err, json::parse(bytesOfFile(folder_ / "s.json")).at("schedule")};
    }

    json kept() const { return json::parse(bytesOfFile(cache_ / "schedules.json")); }

    ScratchFolder folder_;
    fs::path cache_ = folder_ / "some" / "cache";
    const std::string few_ = "64", many_ = "4096";  // 2^24 over 64x64 pixels
    const std::string said_ = "glim: measured once on this device: persistent ";
};

TEST_F(AutoScheduleTest, ALongRenderMeasuresItOnce)
{
    EXPECT_EQ(render(few_).err.find(said_), std::string::npos);
    EXPECT_FALSE(fs::exists(cache_));
    EXPECT_EQ(render(many_, {"--schedule", "wavefront"}).err.find(said_), std::string::npos);
    EXPECT_EQ(render(many_, {"--accelerator", "none"}).err.find(said_), std::string::npos);
    EXPECT_EQ(render("4095").err.find(said_), std::string::npos);
    EXPECT_FALSE(fs::exists(cache_));

    const Rendered first = render(many_);
    EXPECT_NE(first.err.find(said_), std::string::npos) << first.err;
    const json file = kept();
    ASSERT_EQ(file.size(), 1U) << file;
    const json& entry = *file.begin();
    const double wavefront = entry.at("samplesPerSecond").at("wavefront"), persistent = entry.at("samplesPerSecond").at("persistent");
    EXPECT_GT(std::min(wavefront, persistent), 1e3);
    EXPECT_EQ(entry.at("fastest"), nameOf(persistent > wavefront ? Schedule::Persistent : Schedule::Wavefront));
    EXPECT_EQ(first.schedule, entry.at("fastest"));

    const Rendered second = render(many_);
    EXPECT_EQ(second.err.find(said_), std::string::npos) << second.err;
    EXPECT_EQ(second.schedule, first.schedule);
    EXPECT_EQ(kept(), file);
}

TEST_F(AutoScheduleTest, WhatIsKeptDecidesExceptWhatCannotBe)
{
    render(many_);
    json file = kept();
    for (const char* fastest : {"wavefront", "persistent"}) {
        file.begin()->at("fastest") = fastest;
        writeText(cache_ / "schedules.json", file.dump());
        EXPECT_EQ(render(few_).schedule, fastest);
    }
    EXPECT_EQ(render(few_, {"--accelerator", "none"}).schedule, "wavefront");
    EXPECT_EQ(render(few_, {"--schedule", "wavefront"}).schedule, "wavefront");
}

TEST_F(AutoScheduleTest, AFileThatIsNoneIsMeasuredAgain)
{
    fs::create_directories(cache_);
    for (const char* text : {"{", "[]"}) {
        writeText(cache_ / "schedules.json", text);
        EXPECT_NE(render(many_).err.find(said_), std::string::npos) << text;
        EXPECT_EQ(kept().size(), 1U) << text;
    }
    const json entries[] = {"text", {{"fastest", 7}}};
    const std::string key = kept().begin().key();
    json older = kept().at(key);
    older.at("version") = "glim 0.0.1";
    for (const json& entry : {entries[0], entries[1], older}) {
        writeText(cache_ / "schedules.json", json{{"another device", 1}, {key, entry}}.dump());
        EXPECT_NE(render(many_).err.find(said_), std::string::npos) << entry;
        EXPECT_TRUE(kept().at(key).is_object()) << entry;
        EXPECT_EQ(kept().at("another device"), 1);
    }
}

TEST_F(AutoScheduleTest, NothingIsMeasuredThatCannotBeKept)
{
    writeText(folder_ / "file", "");
    cache_ = folder_ / "file" / "cache";
    EXPECT_EQ(render(many_).err.find(said_), std::string::npos);
    cache_ = "";
    EXPECT_EQ(render(many_).err.find(said_), std::string::npos);
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
            return json::parse(bytesOfFile(folder / "s.json")).at("digest").get<std::string>();
        };
        const std::string usual = digest({});
        for (const char* capacity : {"129", "2097152"}) {
            EXPECT_EQ(digest({"--path-capacity", capacity}), usual) << schedule << ' ' << capacity;
        }
    }
}

}  // namespace
}  // namespace glim::test
