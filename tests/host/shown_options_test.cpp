// What a window shows, as a command line and as a file of --edits: both read back as the same.
#include "host/job/shown_options.hpp"
#include "host/cli/command.hpp"
#include "host/job/render_job.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace glim {
namespace {

// Every member of LoadOptions is another than by default.
ShownPicture everything()
{
    ShownPicture shown;
    LoadOptions& load = shown.load;
    load.scene = 1;
    load.environment = std::filesystem::path("maps/night sky's.exr");
    load.environmentRotation = -33.3F;
    load.environmentStrength = 0.1F;
    load.environmentBackground = false;
    load.sun = Sun{30.0, 45.5, 0.1F};
    load.showsBackFaces = true;
    load.pointRadius = 0.01;
    load.lineRadius = 1e-7;
    load.missingTextures = MissingTextures::Grey;
    load.confined = true;
    load.maxTexture = 512;
    load.variant = "sunny $HOME";
    load.at = 1.0 / 3.0;
    load.shutter = Shutter{-0.01, 0.02};
    load.animation = "walk";
    load.aspectRatio = 1.25F;
    load.yfov = glm::radians(35.5F);
    load.framed = true;
    load.floor = SceneFloor{-0.5, {0.1F, 0.2F, 0.3F}, 0.25F, 90.0};
    load.lightGroups = {{{"key", {"Lamp", "Bulb*"}}, {"sky", {"environment"}}}, true};
    load.catchers = {"table", "wall `2`"};
    load.edits = {{"/materials/paint/pbrMetallicRoughness/baseColorFactor", "[1.0,0.5,0.25,1.0]"},
                  {"/materials/0/alphaMode", "\"BLEND\""},
                  {"/materials/0/alphaCutoff", "0.5"},
                  {"/materials/0/doubleSided", "true"},
                  {"/nodes/a b/translation", "[1e-07,0.0,-2.0]"},
                  {"/meshes/0/weights", "[0.5]"},
                  {"/images/0/uri", "\"5\""},
                  {"props/lamp.glb#/materials/0/alphaCutoff", "0.25"}};
    load.additions = {{"props/lamp.glb"}, {"props/lamp.glb", glm::dmat4(0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, -2, 3, 1)}};
    shown.camera = "framed";
    shown.pose = Pose{{0.1, -1e-7, 3}, {1.0 / 3.0, 0, 0}, {0, 1, 0}, 2.5};
    shown.field.degrees = 35.5;
    shown.lens = {0.05F, 3.1F};
    shown.projection.shift = {0.1, -0.2};
    shown.size = {640, 512};
    shown.look = {-1.5, Tone::Agx};
    return shown;
}

RenderJob parse(std::vector<std::string> words)
{
    CommandLine line("", "", "");
    RenderJob job;
    addJobOptions(line.addCommand("render", ""), job);
    words.insert(words.begin(), {"render", "x.gltf", "-o", "x.png"});
    line.run(words);
    return job;
}

// The words that a shell makes of a command line.
std::vector<std::string> split(const std::string& line)
{
    std::vector<std::string> words;
    FILE* shell = popen(("printf '%s\\n' " + line).c_str(), "r");
    for (char word[4096]; std::fgets(word, sizeof word, shell) != nullptr;) {
        words.emplace_back(word, std::char_traits<char>::length(word) - 1);
    }
    EXPECT_EQ(pclose(shell), 0);
    return words;
}

void expectShows(const RenderJob& job, const ShownPicture& shown)
{
    const LoadOptions load = makeLoadOptions(job);
    EXPECT_EQ(load.edits, shown.load.edits);
    EXPECT_EQ(load.additions, shown.load.additions);
    EXPECT_EQ(load.lightGroups, shown.load.lightGroups);
    EXPECT_TRUE(load == shown.load);
    EXPECT_EQ(job.camera, shown.camera);
    EXPECT_EQ(job.pose->from, shown.pose->from);
    EXPECT_EQ(job.pose->at, shown.pose->at);
    EXPECT_EQ(job.pose->up, shown.pose->up);
    EXPECT_EQ(job.pose->zoom * job.field.zoom, shown.pose->zoom * shown.field.zoom);
    EXPECT_EQ(job.field.degrees, shown.field.degrees);
    EXPECT_EQ(job.lens.radius, shown.lens.radius);
    EXPECT_EQ(job.lens.focalDistance, shown.lens.focalDistance);
    EXPECT_EQ(job.projection, shown.projection);
    EXPECT_EQ(job.size, shown.size);
    EXPECT_EQ(job.look.exposure, shown.look.exposure);
    EXPECT_EQ(job.look.tone, shown.look.tone);
}

TEST(ShownOptions, ReadBackFromACommandLineAndFromAFile)
{
    ShownPicture shown = everything();
    const test::ScratchFolder folder;
    for (int kind = 0; kind < 3; ++kind) {
        SCOPED_TRACE(kind);
        expectShows(parse(split(toCommandLine(listShownOptions(shown)))), shown);
        test::writeText(folder / "edits.json", toEdits(listShownOptions(shown)).dump(2));
        ShownPicture there = shown;  // names of files begin beside it
        for (Addition& addition : there.load.additions) {
            addition.file = folder.path() / addition.file;
        }
        if (auto* const map = std::get_if<std::filesystem::path>(&*there.load.environment)) {
            *map = folder.path() / *map;
        }
        there.load.edits.back().pointer.insert(0, folder.path().string() + "/");
        expectShows(parse({"--edits", folder / "edits.json"}), there);
        shown.load.environment = kind == 0 ? EnvironmentChoice(glm::vec3(0.1F, 2.0F, 1e-9F)) : BuiltInEnvironment::None;
        shown.load.floor->height.reset();
        shown.load.lightGroups.each = kind == 0;
        shown.load.environmentRotation = 0.0F;
        shown.load.environmentStrength = 1.0F;
        shown.look.exposure.reset();
    }
}

TEST(ShownOptions, AreNoMoreThanWhatDiffers)
{
    ShownPicture shown;
    shown.camera = "0";
    shown.size = {96, 72};
    shown.load.animation = "walk";  // at rest
    EXPECT_EQ(toCommandLine(listShownOptions(shown)), "--camera 0 --size 96x72");
    EXPECT_EQ(toEdits(listShownOptions(shown)).dump(), R"({"camera":0,"size":"96x72"})");
    shown.load.sun = Sun{30, 45, 1000};
    shown.load.edits = {{"/nodes/0/translation", "[0,1,0]"}, {"/materials/0/alphaCutoff", "1.0"}, {"/nodes/0/translation", "[0,2,0]"}};
    EXPECT_EQ(toCommandLine(listShownOptions(shown)),
              "--camera 0 --size 96x72 --sun 30,45,1000 --set /materials/0/alphaCutoff=1 --set /nodes/0/translation=0,2,0");
    EXPECT_EQ(toEdits(listShownOptions(shown)).dump(),
              R"({"camera":0,"size":"96x72","sun":[30,45,1000],"set":{"/materials/0/alphaCutoff":1,"/nodes/0/translation":[0,2,0]}})");
}

}  // namespace
}  // namespace glim
