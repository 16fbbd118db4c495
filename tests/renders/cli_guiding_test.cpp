// --guiding: the film knows its guide, and whatever ends or divides a render, the bits are those of one run.
#include "host/image/exr.hpp"
#include "host/render/film_file.hpp"
#include "host/render/settings.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

namespace glim::test {
namespace {

using nlohmann::json;

class CommandLineGuidingTest : public ::testing::Test {
protected:
    GlimCall call(const std::vector<std::string>& arguments) const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile(scene_), "--size", size_};
        call.arguments.insert(call.arguments.end(), arguments.begin(), arguments.end());
        call.folder = folder_.path();
        return call;
    }
    GlimRun run(const std::vector<std::string>& arguments) const
    {
        GlimRun run = runGlim(call(arguments));
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return run;
    }
    json guideIn(const char* stats) const { return json::parse(readFileBytes(folder_ / stats)).at("guide"); }
    std::string digestOf(const char* film) const { return computeDigest(readFilm(folder_ / film)); }

    ScratchFolder folder_;
    std::string scene_ = "cornell.gltf", size_ = "12x12";
};

TEST_F(CommandLineGuidingTest, KilledItGoesOnWithTheSameBits)
{
    run({"-o", "whole.exr", "--spp", "3000", "--guiding", "on"});
    int kills = 0;
    bool isKept = false;
    for (std::size_t lines = 1;; ++lines) {
        isKept = std::filesystem::exists(folder_ / "film.exr") && readStoredFilm(folder_ / "film.exr").checkpoint;
        GlimCall killed = call({"-o", "film.exr", "--spp", "3000", "--guiding", "on", "--resume", "--checkpoint", "0.01s", "--progress",
                                "json", "--stats", "film.json"});
        killed.signalWhen = [lines](const std::string& err) {
            return countLines(err) > lines && contains(err, "\"samples\":");  // after the learning
        };
        killed.signal = lines % 2 == 0 ? SIGTERM : SIGKILL;
        const GlimRun ended = runGlim(killed);
        EXPECT_EQ(contains(ended.err, "\"learned\":"), !isKept) << "the checkpoint has the guide";
        if (ended.exitCode == 0) {
            break;
        }
        ASSERT_LT(++kills, 30);
    }
    EXPECT_GT(kills, 0);
    EXPECT_EQ(digestOf("film.exr"), digestOf("whole.exr"));
    EXPECT_EQ(guideIn("film.json").at("kept").get<bool>(), isKept);
    EXPECT_TRUE(isKept);
}

TEST_F(CommandLineGuidingTest, GoesOnByTheGuideOfTheCheckpoint)
{
    run({"-o", "film.exr", "--guiding", "on", "--resume", "--spp", "64", "--stats", "first.json"});
    run({"-o", "film.exr", "--guiding", "on", "--resume", "--spp", "128", "--stats", "second.json"});
    EXPECT_FALSE(guideIn("first.json").at("kept").get<bool>());
    json kept = guideIn("second.json");
    EXPECT_TRUE(kept.at("kept").get<bool>());
    kept["kept"] = false;
    EXPECT_EQ(kept, guideIn("first.json"));
    const GlimRun other =
        runForMessages(call({"-o", "film.exr", "--guiding", "on", "--resume", "--spp", "256", "--bounces", "3", "--progress", "json"}));
    expectRefused(other, 1, MessageId::Mismatch, {.place = "setting", .value = "\"bounces=64\"", .expected = "\"bounces=3\""});
    EXPECT_FALSE(contains(other.err, "\"learned\":")) << "it is refused at once";
    run({"-o", "whole.exr", "--guiding", "on", "--spp", "128"});
    EXPECT_EQ(digestOf("film.exr"), digestOf("whole.exr"));
    EXPECT_FALSE(readGuide(folder_ / "whole.exr")) << "it has no checkpoint";
}

// One that would render another picture.
TEST_F(CommandLineGuidingTest, ADamagedGuideIsRefused)
{
    run({"-o", "film.exr", "--guiding", "on", "--resume", "--spp", "64"});
    Image image = readExr(folder_ / "film.exr");
    std::get<OpaqueBytes>(image.attributes.at("glim:guideTexels")).front() ^= std::byte{1};
    writeExr(folder_ / "film.exr", image);
    const std::string before = readFileBytes(folder_ / "film.exr");
    expectRefused(runForMessages(call({"-o", "film.exr", "--guiding", "on", "--resume", "--spp", "128"})), 1, MessageId::FileDamaged,
                  {.file = "film.exr", .place = "guide"});
    EXPECT_EQ(readFileBytes(folder_ / "film.exr"), before);
}

TEST_F(CommandLineGuidingTest, LearningSaysHowFarItIsAndCanBeEnded)
{
    size_ = "96x96";  // which takes seconds to learn
    GlimCall stopped = call({"-o", "film.exr", "--spp", "64", "--guiding", "on", "--progress", "json"});
    stopped.signalWhen = [](const std::string& err) { return countLines(err) > 2; };
    stopped.signal = SIGINT;
    const GlimRun run = runForMessages(stopped);
    EXPECT_EQ(run.exitCode, 128 + SIGINT);
    EXPECT_NE(run.err.find("nothing was rendered or written"), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "film.exr"));
    std::istringstream lines(run.err);
    double learned = -1.0;
    for (std::string line; std::getline(lines, line) && line.starts_with("{\"picture\"");) {
        const double now = json::parse(line).at("learned").get<double>();
        EXPECT_GE(now, learned);
        learned = now;
    }
    EXPECT_GT(learned, 0.0) << run.err;
    EXPECT_LT(learned, 1.0);
}

// In a box with a lamp under its ceiling a picture is done before learning pays.
TEST_F(CommandLineGuidingTest, AutoGoesWithoutAGuideThatWouldNotPay)
{
    run({"-o", "off.exr", "--spp", "64"});
    const GlimRun without = run({"-o", "auto.exr", "--spp", "64", "--guiding", "auto", "--stats", "auto.json", "--resume"});
    EXPECT_NE(without.out.find("without a guide, which would not pay"), std::string::npos) << without.out;
    EXPECT_TRUE(guideIn("auto.json").is_null());
    EXPECT_EQ(digestOf("auto.exr"), digestOf("off.exr"));
    const GlimRun resumed = run({"-o", "auto.exr", "--spp", "128", "--guiding", "auto", "--resume"});
    EXPECT_NE(resumed.out.find("would not pay (from the checkpoint)"), std::string::npos) << resumed.out;
}

TEST_F(CommandLineGuidingTest, AutoSaysWhatItGains)
{
    scene_ = "door_ajar.gltf";
    size_ = "48x48";
    const GlimRun guided = run({"-o", "auto.exr", "--spp", "64", "--guiding", "auto", "--resume", "--stats", "auto.json"});
    const double gain = guideIn("auto.json").at("gain").get<double>();
    EXPECT_GT(gain, 1.0);
    EXPECT_NE(guided.out.find("times less noise in the same time"), std::string::npos) << guided.out;
    run({"-o", "auto.exr", "--spp", "128", "--guiding", "auto", "--resume", "--stats", "auto.json"});
    EXPECT_TRUE(guideIn("auto.json").at("kept").get<bool>());
    EXPECT_EQ(guideIn("auto.json").at("gain").get<double>(), gain);
}

TEST_F(CommandLineGuidingTest, PartsAreMergedToTheBitsOfOneRun)
{
    run({"-o", "whole.exr", "--spp", "512", "--guiding", "on", "--stats", "whole.json"});
    run({"-o", "a.exr", "--samples", "0:256", "--guiding", "on", "--schedule", "wavefront"});
    run({"-o", "b.exr", "--samples", "256:512", "--guiding", "on", "--schedule", "persistent"});
    GlimCall merge;
    merge.arguments = {"merge", "a.exr", "b.exr", "-o", "merged.exr"};
    merge.folder = folder_.path();
    const GlimRun merged = runGlim(merge);
    EXPECT_EQ(merged.exitCode, 0) << merged.err;
    EXPECT_EQ(digestOf("merged.exr"), digestOf("whole.exr"));
    const json guide = guideIn("whole.json");
    EXPECT_EQ(guide.at("digest").get<std::string>(), findSetting(readFilm(folder_ / "whole.exr").identity.settings, "guide"));
    EXPECT_GT(guide.at("cells").get<int>(), 0);
    EXPECT_GT(guide.at("paths").get<int>(), 0);
}

// A ball slides away, and takes its shadow with it.
TEST_F(CommandLineGuidingTest, FramesLearnWhatTheyLearnAlone)
{
    scene_ = "product.gltf";
    run({"-o", "frame#.exr", "--spp", "64", "--guiding", "on", "--frames", "0:1", "--fps", "1"});
    std::vector<std::string> guides;
    for (const std::string second : {"0", "1"}) {
        run({"-o", "alone.exr", "--spp", "64", "--guiding", "on", "--at", second});
        EXPECT_EQ(digestOf(("frame" + second + ".exr").c_str()), digestOf("alone.exr")) << second << " s";
        guides.push_back(findSetting(readFilm(folder_ / "alone.exr").identity.settings, "guide"));
    }
    EXPECT_NE(guides[0], guides[1]);
}

// The guide of a checkpoint is of the film that is there, and --guiding asks for one that pays, for any or for none.
TEST_F(CommandLineGuidingTest, NoFilmGoesOnWithoutItsGuide)
{
    const auto expectOther = [&](std::vector<std::string> guiding) {
        guiding.insert(guiding.end(), {"-o", "film.exr", "--spp", "128", "--resume"});
        const GlimRun refused = runForMessages(call(guiding));
        EXPECT_EQ(refused.exitCode, 1);
        EXPECT_NE(refused.err.find("guide="), std::string::npos) << refused.err;
    };
    run({"-o", "film.exr", "--spp", "64", "--guiding", "on", "--resume"});
    expectOther({});
    expectOther({"--guiding", "auto"});
    std::filesystem::remove(folder_ / "film.exr");
    run({"-o", "film.exr", "--spp", "64", "--guiding", "auto", "--resume"});
    expectOther({"--guiding", "on"});
}

TEST_F(CommandLineGuidingTest, SequencesKeepAGuideOfTheSamePictureAlone)
{
    const auto turn = [&](const std::string& film, const std::string& bounces) {
        return run({"-o", film, "--spp", "64", "--guiding", "on", "--turntable", "1", "--checkpoint", "1h", "--bounces", bounces,
                    "--progress", "json"});
    };
    turn("film#.exr", "2");
    turn("film#.exr", "3");
    turn("other#.exr", "3");
    EXPECT_EQ(digestOf("film0.exr"), digestOf("other0.exr"));
    const GlimRun kept = turn("film#.exr", "3");
    EXPECT_NE(kept.out.find("is whole and was kept"), std::string::npos) << kept.out;
    EXPECT_FALSE(contains(kept.err, "\"learned\":")) << kept.err;
}

TEST_F(CommandLineGuidingTest, ReplayHasTheBitsOfTheFilm)
{
    run({"-o", "film.exr", "--samples", "5:6", "--guiding", "on"});
    const glm::vec3 expected = readFilm(folder_ / "film.exr").pixels[11 * 12 + 6].mean;
    const GlimRun replayed = run({"--guiding", "on", "--replay", "6,11,5", "--stats", "path.json"});
    EXPECT_NE(replayed.out.find("that of BSDF and guide"), std::string::npos) << replayed.out;
    const json path = json::parse(readFileBytes(folder_ / "path.json")), &radiance = path.at("radiance");
    EXPECT_EQ(glm::vec3(radiance.at(0).get<float>(), radiance.at(1).get<float>(), radiance.at(2).get<float>()), expected);
}

// It is the guide of the render with the same options. In the corner that the camera looks at light paths do not pay.
TEST_F(CommandLineGuidingTest, TheViewIsOfTheRendersGuide)
{
    const auto guideOf = [&](const std::vector<std::string>& more) {
        GlimCall made;
        made.arguments = {"render",      sceneFile("cornell_mirror_glass.gltf"),
                          "--size",      "12x12",
                          "-o",          "film.exr",
                          "--guiding",   "on",
                          "--spp",       "1",
                          "--look-from", "0.9,1.9,0.9",
                          "--look-at",   "0.9,2,-1"};
        made.arguments.insert(made.arguments.end(), more.begin(), more.end());
        made.folder = folder_.path();
        const GlimRun run = runGlim(made);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        return findSetting(readFilm(folder_ / "film.exr").identity.settings, "guide");
    };
    const std::string guide = guideOf({});
    EXPECT_EQ(guideOf({"--view", "guide"}), guide);
    EXPECT_NE(guideOf({"--view", "guide", "--caustics", "on"}), guide);
    EXPECT_NE(guideOf({"--view", "guide", "--bounces", "2"}), guide);
}

// What is printed of the directions that were sampled with a guide, in text and JSON.
TEST_F(CommandLineGuidingTest, ReplaySaysWhoChoseADirection)
{
    static const std::regex kLine(R"(direction chosen by the (guide|BSDF), guide's share ([^:]+): )"
                                  R"(pdf of the guide ([^ ]+) per sr, of the BSDF ([^,]+), mixed ([^\n]+)\n)");
    std::map<std::string, int> choices;
    for (int sample = 0; sample < 3; ++sample) {
        const GlimRun replayed =
            run({"--guiding", "on", "--replay", "6,11," + std::to_string(sample), "--spp", "3", "--stats", "path.json"});
        const json path = json::parse(readFileBytes(folder_ / "path.json"));
        std::sregex_iterator line(replayed.out.begin(), replayed.out.end(), kLine);
        for (const json& vertex : path.at("vertices")) {
            const json& guide = vertex.at("guide");
            if (guide.is_null()) {
                continue;
            }
            ASSERT_NE(line, std::sregex_iterator()) << replayed.out;
            EXPECT_EQ(guide.at("chose").get<bool>(), (*line)[1] == "guide");
            const char* const kNumbers[] = {"share", "guidePdf", "bsdfPdf", "pdf"};
            for (std::size_t k = 0; k < 4; ++k) {
                EXPECT_EQ(guide.at(kNumbers[k]).get<float>(), std::stof((*line)[2 + k])) << kNumbers[k];
            }
            if (!vertex.at("next").is_null()) {
                EXPECT_EQ(vertex.at("next").at("pdf"), guide.at("pdf"));
                EXPECT_EQ(vertex.at("next").at("lobe"), guide.at("chose").get<bool>() ? json() : json("diffuse"));
            }
            ++choices[(*line)[1]];
            ++line;
        }
        EXPECT_EQ(line, std::sregex_iterator()) << replayed.out;
    }
    EXPECT_GT(choices["guide"], 0);
    EXPECT_GT(choices["BSDF"], 0);
    run({"--replay", "6,11,0", "--stats", "path.json"});
    const json plain = json::parse(readFileBytes(folder_ / "path.json"));
    for (const json& vertex : plain.at("vertices")) {
        EXPECT_TRUE(vertex.at("guide").is_null());
    }
}

TEST_F(CommandLineGuidingTest, IsRefusedWhereItDoesNothing)
{
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--view", "normal"}, {"--direct", "bsdf"}}) {
        std::vector<std::string> arguments{"-o", "film.exr", "--guiding", "on"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        expectRefused(runForMessages(call(arguments)), 2, MessageId::Conflict, {.place = "--guiding"});
    }
}

}  // namespace
}  // namespace glim::test
