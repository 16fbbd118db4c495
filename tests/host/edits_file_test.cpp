// --edits: which options a file may give, and which win.
#include "host/cli/bench_options.hpp"
#include "host/cli/command.hpp"
#include "host/job/render_job.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace glim {
namespace {

using test::Parts;

class EditsFileTest : public ::testing::Test {
protected:
    // "render x.gltf -o x.exr" by the file `json`, and with other options, separated by spaces.
    RenderJob parse(const std::string& json, const std::string& options = "") const
    {
        test::writeText(file(), json);
        CommandLine line("", "", "");
        RenderJob job;
        addJobOptions(line.addCommand("render", ""), job);
        std::vector<std::string> words{"render", "x.gltf", "-o", "x.##.exr"};
        std::istringstream stream(options + " --edits " + file().string());
        for (std::string word; stream >> word;) {
            words.push_back(word);
        }
        line.run(words);
        return job;
    }
    void expectRefused(const std::string& json, MessageId id, Parts parts, const std::string& options = "") const
    {
        SCOPED_TRACE(json);
        parts.file = parts.file.empty() ? file().string() : parts.file;
        test::expectRefusal<UsageError>([&] { parse(json, options); }, id, parts);
    }
    std::filesystem::path file() const { return folder_ / "edits.json"; }
    std::string beside(const char* name) const { return (folder_ / name).string(); }

    test::ScratchFolder folder_;
};

TEST_F(EditsFileTest, GivesOptionsByNameAsProgramsDo)
{
    const RenderJob job = parse(
        R"({"sun": [30, 45, 1000], "environment": "studio", "look_from": "0,1,4", "look-at": [0, 1, 0], "size": [64, 48], "at": 0.5,
            "--variant": "red", "confine": true, "environment_background": false, "catcher": ["a", "b"], "zoom": null, "exposure": 1,
            "set": {"/nodes/lamp/translation": [0, 2, 0], "/materials/0/alphaMode": "BLEND"}})");
    EXPECT_EQ(job.sun, (Sun{30, 45, 1000}));
    EXPECT_EQ(job.environment, EnvironmentChoice(BuiltInEnvironment::Studio));
    EXPECT_EQ(job.pose->from, glm::dvec3(0, 1, 4));
    EXPECT_EQ(job.size, glm::uvec2(64, 48));
    EXPECT_EQ(job.at, 0.5);
    EXPECT_EQ(job.variant, "red");
    EXPECT_TRUE(job.confined);
    EXPECT_FALSE(job.environmentBackground);
    EXPECT_EQ(job.catchers, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(job.look.exposure, 1.0) << "though there is no picture to look at";
    EXPECT_EQ(job.edits, (std::vector<Edit>{{"/nodes/lamp/translation", "[0.0,2.0,0.0]"}, {"/materials/0/alphaMode", "\"BLEND\""}}));
}

TEST_F(EditsFileTest, WhatIsGivenBesidesWins)
{
    const std::string file = R"({"sun": [1, 2, 3], "fov": 20, "look-from": [0, 0, 1], "look-at": [0, 0, 0], "camera": "a", "at": 2,
        "animation": "walk", "confine": true, "lens-radius": 0.5, "focal-distance": 2, "set": {"/x": 1}, "catcher": "first"})";
    EXPECT_EQ(parse(file, "--sun 4,5,6").sun, (Sun{4, 5, 6}));
    EXPECT_EQ(parse(file, "--set /x=2 --set /y=3 --catcher then").edits, (std::vector<Edit>{{"/x", "1.0"}, {"/x", "2.0"}, {"/y", "3.0"}}));
    EXPECT_EQ(parse(file, "--catcher then").catchers, (std::vector<std::string>{"first", "then"}));
    EXPECT_FALSE(parse(file, "--confine=false").confined);
    EXPECT_TRUE(parse(file).confined);
    EXPECT_EQ(parse(file, "--look-from 0,5,0").pose->from, glm::dvec3(0, 5, 0));
    EXPECT_EQ(parse(file, "--look-from 0,5,0").pose->at, glm::dvec3(0, 0, 0));
    // And what excludes it.
    EXPECT_EQ(parse(file, "--pose-gltf 1,0,0,7,0,1,0,0,0,0,1,0").pose->from.x, 7.0);
    EXPECT_FALSE(parse(file, "--turntable 3").camera);
    EXPECT_FALSE(parse(file, "--turntable 3").pose);
    EXPECT_EQ(parse(file, "--frames 1:2").animation, "walk");
    EXPECT_FALSE(parse(file, "--frames 1:2").at);
    const RenderJob around = parse(file, "--projection equirectangular");
    EXPECT_FALSE(around.field.degrees || around.lens.radius > 0.0F);
    const RenderJob focused = parse(file, "--focus 3,4");
    EXPECT_TRUE(focused.lens.radius == 0.5F && focused.focus);
}

TEST_F(EditsFileTest, NamesOfFilesBeginBesideIt)
{
    const RenderJob job = parse(
        R"({"environment": "sky.hdr", "add": ["a/floor.glb@0,-1,0", "/b/lamp.glb"],
            "set": {"a/floor.glb#/materials/0/alphaCutoff": 1, "floor.glb#/x/y": 2, "/b/lamp.glb#/x/y": 3, "/images/0/uri": "oak.png"}})",
        "--add here.glb --set here.glb#/x/y=4");
    EXPECT_EQ(job.environment, EnvironmentChoice(std::filesystem::path(beside("sky.hdr"))));
    ASSERT_EQ(job.additions.size(), 3U);
    EXPECT_EQ(job.additions[0].file, beside("a/floor.glb"));
    EXPECT_EQ(job.additions[0].worldFromFile[3].y, -1.0);
    EXPECT_EQ(job.additions[1].file, "/b/lamp.glb");
    EXPECT_EQ(job.additions[2].file, "here.glb");
    ASSERT_EQ(job.edits.size(), 5U);
    EXPECT_EQ(job.edits[0].pointer, beside("a/floor.glb#/materials/0/alphaCutoff"));
    EXPECT_EQ(job.edits[1].pointer, "floor.glb#/x/y");
    EXPECT_EQ(job.edits[2].pointer, "/b/lamp.glb#/x/y");
    EXPECT_EQ(job.edits[3].value, "\"oak.png\"");
    EXPECT_EQ(parse(R"({"add": {"a.glb": [1, 2, 3]}})").additions[0].file, beside("a.glb"));
    EXPECT_EQ(parse(R"({"add": "a.glb"})").additions[0].file, beside("a.glb"));
    EXPECT_EQ(parse(R"({"environment": "none"})").environment, EnvironmentChoice(BuiltInEnvironment::None));
    EXPECT_EQ(parse(R"({"environment": "1,1,1"})").environment, EnvironmentChoice(glm::vec3(1.0F)));
}

TEST_F(EditsFileTest, RefusesWhatIsNotOfThePicture)
{
    using Id = MessageId;
    for (const char* text : {"", "{", "[]", "3", "{\"sun\": }", "{\"sun\": [1,2,3]} x"}) {
        expectRefused(text, Id::Malformed, {.expected = "a JSON object of options"});
    }
    expectRefused(R"({"sunn": [1, 2, 3]})", Id::UnknownName, {.value = "sunn", .expected = "scene, camera, lens, time or look"});
    for (const auto& [name, option] : {std::pair("spp", "--spp"),
                                       {"samples", "--samples"},
                                       {"seed", "--seed"},
                                       {"device", "--device"},
                                       {"output", "--output"},
                                       {"png", "--image"},
                                       {"stats", "--stats"},
                                       {"bounces", "--bounces"},
                                       {"denoise", "--denoise"},
                                       {"frames", "--frames"},
                                       {"view", "--view"},
                                       {"rows", "--rows"},
                                       {"file", "SCENE"},
                                       {"edits", "--edits"}}) {
        expectRefused(std::string("{\"") + name + "\": 1}", Id::Unsupported,
                      {.place = option, .expected = "scene, camera, lens, time or look"});
    }
    expectRefused(R"({"sun": [1, 2]})", Id::Malformed, {.place = "--sun", .value = "1,2", .expected = "30,45,1000"});
    expectRefused(R"({"fov": "wide"})", Id::Malformed, {.place = "--fov", .value = "wide", .expected = "0.01 to 179"});
    expectRefused(R"({"size": {"x": 1}})", Id::WrongType, {.value = R"({"x":1})"});
    expectRefused(R"({"confine": 2})", Id::WrongType, {.place = "--confine", .expected = "true or false"});
    expectRefused(R"({"set": {"x": 1}})", Id::Malformed, {.place = "--set"});
    expectRefused(R"({"environment": [1, 2]})", Id::Malformed, {.place = "--environment", .value = "1,2"});
    expectRefused(R"({"look-at": [0, 0, 0], "look_at": [0, 0, 0]})", Id::Duplicate, {.place = "--look-at"});
    expectRefused(R"({"look-from": [0, 0, 0]})", Id::Requires, {.place = "--look-from", .expected = "--look-at"});
    expectRefused(R"({"fov": 20, "projection": "equirectangular"})", Id::Conflict, {.place = "--fov", .value = "--projection"});
}

TEST_F(EditsFileTest, RefusesFilesThatCannotBeRead)
{
    const auto expectUnread = [](const std::string& name, MessageId id, const std::string& expected) {
        CommandLine line("", "", "");
        RenderJob job;
        addJobOptions(line.addCommand("render", ""), job);
        test::expectRefusal<UsageError>(
            [&] {
                line.run({"render", "x.gltf", "-o", "x.exr", "--edits", name});
            },
            id, {.file = name, .place = "--edits", .expected = expected});
    };
    expectUnread(beside("missing.json"), MessageId::FileMissing, "");
    expectUnread(folder_.path(), MessageId::WrongType, "a file of JSON");
    test::writeText(file(), "{}");
    std::filesystem::resize_file(file(), (std::uintmax_t{16} << 20U) + 1);
    expectUnread(file(), MessageId::TooLarge, "at most 16 MiB");
    std::filesystem::resize_file(file(), std::uintmax_t{16} << 20U);
    test::expectRefusal<UsageError>([&] { parse("{}", "--edits a.json"); }, MessageId::Duplicate, {.place = "--edits"});
}

// A bench compares the options of its pictures, and may render them again elsewhere.
TEST_F(EditsFileTest, ABenchTakesWhatTheFileSays)
{
    test::writeText(file(), R"({"sun": [1, 2, 3], "environment": "sky.hdr", "set": {"/x": [1, 2]}})");
    CommandLine line("", "", "");
    BenchOptions options;
    addBenchOptions(line.addCommand("bench", ""), options);
    line.run({"bench", "x.gltf", "--edits", file(), "--set", "/y=3"});
    EXPECT_EQ(options.words, (std::vector<std::string>{"--environment=" + beside("sky.hdr"), "--sun=1,2,3", "--set=/x=1,2", "--set=/y=3"}));
}

}  // namespace
}  // namespace glim
