// Renders cut short and put together: merging, time limits, signals, repeatability, progress.
#include "host/measure/compare_images.hpp"
#include "host/render/film_file.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>
#include <tuple>

namespace glim::test {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

class Films {
public:
    // Renders scenes/SCENE to NAME; fails the test unless that succeeds.
    void render(const std::string& name, const Arguments& options, const std::string& scene = "cornell.gltf") const
    {
        const GlimRun run = runGlim(call(name, options, scene));
        EXPECT_EQ(run.exitCode, 0) << run.err;
    }
    GlimCall call(const std::string& name, const Arguments& options, const std::string& scene = "cornell.gltf") const
    {
        GlimCall call;
        call.arguments = {"render", sceneFile(scene), "-o", name};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        if (std::find(options.begin(), options.end(), "--size") == options.end()) {
            call.arguments.insert(call.arguments.end(), {"--size", "16x16"});
        }
        call.folder = folder_.path();
        return call;
    }
    GlimRun merge(const Arguments& options) const
    {
        GlimCall call;
        call.arguments = {"merge"};
        call.arguments.insert(call.arguments.end(), options.begin(), options.end());
        call.folder = folder_.path();
        return runForMessages(call);
    }
    Film film(const char* name) const { return readFilm(folder_ / name); }
    json statistics(const char* name) const { return json::parse(readFileBytes(folder_ / name)); }
    std::filesystem::path folder() const { return folder_.path(); }
    bool exists(const char* name) const { return std::filesystem::exists(folder_ / name); }

private:
    ScratchFolder folder_;
};

std::vector<json> linesOf(const std::string& text)
{
    std::vector<json> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(json::parse(line));
    }
    return lines;
}

TEST(CommandLineTest, MergedPagesAreTheBitsOfTheSingleRun)
{
    const Films films;
    films.render("a.exr", {"--samples", "0:256"});
    films.render("b.exr", {"--samples", "256:512"});
    films.render("whole.exr", {"--samples", "0:512"});
    const GlimRun run = films.merge({"b.exr", "a.exr", "-o", "c.exr"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_NE(run.err.find("bit-identical to a single run"), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(sameBits(films.film("c.exr").pixels, films.film("whole.exr").pixels));
    EXPECT_FALSE(sameBits(films.film("c.exr").pixels, films.film("a.exr").pixels));
    const GlimRun inPlace = films.merge({"a.exr", "b.exr", "-o", "b.exr"});  // the output may replace an input
    EXPECT_EQ(inPlace.exitCode, 0) << inPlace.err;
    EXPECT_TRUE(sameBits(films.film("b.exr").pixels, films.film("whole.exr").pixels));
}

// The gems' scene has light paths.
TEST(CommandLineTest, MergedBandsOfRowsAreTheBitsOfTheSingleRun)
{
    const Films films;
    films.render("whole.exr", {"--samples", "0:300"}, "cornell_gems.gltf");
    Arguments names;
    for (const char* rows : {"3:4", "4:16", "0:3"}) {
        for (const char* samples : {"256:300", "0:256"}) {
            names.push_back("film" + std::to_string(names.size()) + ".exr");
            films.render(names.back(), {"--samples", samples, "--rows", rows}, "cornell_gems.gltf");
        }
    }
    names.insert(names.end(), {"-o", "merged.exr"});
    const GlimRun run = films.merge(names);
    EXPECT_NE(run.err.find("bit-identical to a single run"), std::string::npos) << run.err;
    EXPECT_FALSE(films.film("whole.exr").splats.empty());
    EXPECT_EQ(computeDigest(films.film("merged.exr")), computeDigest(films.film("whole.exr")));
    const GlimRun two = films.merge({"film5.exr", "film4.exr", "film0.exr", "film1.exr", "-o", "two.exr"});
    EXPECT_EQ(two.exitCode, 0) << two.err;
    const Film part = films.film("two.exr"), whole = films.film("whole.exr");
    EXPECT_EQ(std::tuple(part.rowsAbove, part.height, part.rowsBelow), std::tuple(0U, 4U, 12U));
    EXPECT_TRUE(sameBits(part.pixels, {whole.pixels.begin(), whole.pixels.begin() + 64}));
}

TEST(CommandLineTest, RowsThatAreNotInThePictureAreRefused)
{
    const Films films;
    for (const auto& [rows, id, expected] :
         {std::tuple("0:17", MessageId::OutOfRange, "16 rows"), std::tuple("16:17", MessageId::OutOfRange, "16 rows"),
          std::tuple("3:3", MessageId::OutOfRange, "BEGIN:END"), std::tuple("-1:2", MessageId::Malformed, "BEGIN:END"),
          std::tuple("0:99999999999", MessageId::Malformed, "BEGIN:END")}) {
        expectRefused(runForMessages(films.call("a.exr", {"--spp", "1", "--rows", rows})), 2, id,
                      {.place = "--rows", .value = rows, .expected = expected});
    }
}

TEST(CommandLineTest, MergeRefusesWhatDoesNotBelongTogether)
{
    const Films films;
    films.render("a.exr", {"--samples", "0:32"});
    films.render("overlap.exr", {"--samples", "31:64"});
    films.render("seed.exr", {"--samples", "32:64", "--seed", "1"});
    films.render("bounces.exr", {"--samples", "32:64", "--bounces", "3"});
    films.render("scene.exr", {"--samples", "32:64"}, "cornell_spheres.gltf");
    films.render("light.exr", {"--samples", "32:64", "--environment", "1,1,1"});
    films.render("size.exr", {"--samples", "32:64", "--size", "8x8"});
    films.render("clamp.exr", {"--samples", "0:32", "--clamp-indirect", "0.1234561"});
    films.render("clamp2.exr", {"--samples", "32:64", "--clamp-indirect", "0.1234564"});
    EXPECT_NE(films.merge({"clamp.exr", "clamp2.exr", "-o", "c.exr"}).exitCode, 0);
    const char* const kScene = "scene, camera or environment";
    const std::pair<MessageId, Parts> cases[] = {
        {MessageId::Duplicate, {"overlap.exr", "samples", "31:32"}},
        {MessageId::Mismatch, {"seed.exr", "seed", "1", "0"}},
        {MessageId::Mismatch, {"bounces.exr", "setting", "\"bounces=3\"", "\"bounces=64\""}},
        {MessageId::Mismatch, {"scene.exr", kScene}},
        {MessageId::Mismatch, {"light.exr", kScene}},
        {MessageId::Mismatch, {"size.exr", "size", "8x8"}},
        {MessageId::FileMissing, {"none.exr"}},
    };
    for (const auto& [id, parts] : cases) {
        expectRefused(films.merge({"a.exr", parts.file, "-o", "c.exr"}), 1, id, parts);
        EXPECT_FALSE(films.exists("c.exr"));
    }
}

TEST(CommandLineTest, TheSameSeedGivesTheSamePixels)
{
    const Films films;
    films.render("a.exr", {"--seed", "5", "--spp", "48"});
    films.render("b.exr", {"--seed", "5", "--spp", "48"});
    films.render("c.exr", {"--seed", "6", "--spp", "48"});
    EXPECT_TRUE(sameBits(films.film("a.exr").pixels, films.film("b.exr").pixels));
    EXPECT_FALSE(sameBits(films.film("a.exr").pixels, films.film("c.exr").pixels));
}

TEST(CommandLineTest, TimeEndsARender)
{
    const Films films;
    films.render("x.exr", {"--time", "0.5", "--stats", "s.json"});
    const json s = films.statistics("s.json");
    EXPECT_EQ(s.at("stopReason"), "time");
    EXPECT_GE(s.at("seconds").at("render"), 0.5);
    EXPECT_LT(s.at("seconds").at("render"), 5.0);  // a pass is far below this even where others use the machine
    EXPECT_GE(films.film("x.exr").pixels[0].count, 1U);
    films.render("x.exr", {"--time", "1000", "--samples", "8:24", "--stats", "s.json"});
    EXPECT_EQ(films.statistics("s.json").at("stopReason"), "samples");
    EXPECT_EQ(films.film("x.exr").pixels[0].count, 16U);
}

TEST(CommandLineTest, PixelsWithoutASampleAreReported)
{
    const Films films;
    const GlimRun run = runForMessages(films.call("x.exr", {"--time", "0.001", "--size", "512x512"}));
    EXPECT_EQ(run.exitCode, 0);
    expectSaid(run, MessageId::PixelsWithoutSamples);
    EXPECT_EQ(countLines(run.err), 1U);
    EXPECT_FALSE(films.film("x.exr").complete);
}

TEST(CommandLineTest, MergeSaysThatAFilmEndedEarly)
{
    const Films films;
    films.render("a.exr", {"--time", "0.001", "--samples", "0:256", "--size", "512x512", "--stats", "s.json"});
    EXPECT_EQ(films.statistics("s.json").at("stopReason"), "time");
    films.render("b.exr", {"--samples", "256:257", "--size", "512x512"});
    const GlimRun run = films.merge({"a.exr", "b.exr", "-o", "c.exr"});
    EXPECT_EQ(run.exitCode, 0);
    EXPECT_NE(run.err.find("some are missing"), std::string::npos) << run.err;
    EXPECT_TRUE(films.film("b.exr").complete);
    EXPECT_FALSE(films.film("c.exr").complete);
}

TEST(CommandLineTest, ComparisonsTestNoNoiseThatIsShared)
{
    const Films films;
    films.render("a.exr", {"--samples", "0:64"});
    films.render("more.exr", {"--samples", "32:128"});
    films.render("other.exr", {"--samples", "64:192"});
    const auto compare = [&](const char* other) {
        GlimCall call;
        call.arguments = {"compare", "a.exr", other, "--json"};
        call.folder = films.folder();
        return json::parse(runGlim(call).out);
    };
    EXPECT_EQ(compare("a.exr").at("relation"), "identical");
    EXPECT_TRUE(compare("a.exr").at("sameBits"));
    EXPECT_FALSE(compare("more.exr").at("sameBits"));
    EXPECT_EQ(compare("more.exr").at("relation"), "shared samples");
    EXPECT_TRUE(compare("more.exr").at("z_test").is_null());
    EXPECT_EQ(compare("other.exr").at("relation"), "independent");
    EXPECT_FALSE(compare("other.exr").at("z_test").is_null());
}

TEST(CommandLineTest, ComparisonsFailByNoiseAndByRmse)
{
    const Films films;
    films.render("a.exr", {"--samples", "0:64"});
    films.render("more.exr", {"--samples", "32:128"});
    films.render("other.exr", {"--samples", "64:192"});
    films.render("brighter.exr", {"--samples", "64:192", "--set", "/materials/0/pbrMetallicRoughness/baseColorFactor=0.99,0.99,0.99,1"});
    films.render("few.exr", {"--samples", "64:80"});
    const auto compare = [&](const Arguments& words) {
        GlimCall call;
        call.arguments = {"compare"};
        call.arguments.insert(call.arguments.end(), words.begin(), words.end());
        call.folder = films.folder();
        return runForMessages(call);
    };
    const auto relativeRmse = [&](const char* picture, const char* reference) {
        const json report = json::parse(compare({picture, reference, "--json"}).out);
        return 100.0 * std::sqrt(report.at("mse").get<double>()) / meanRadiance(makePicture(readFilm(films.folder() / reference)));
    };
    constexpr int kDiffers = 4;
    EXPECT_EQ(compare({"a.exr", "other.exr", "--fail"}).exitCode, 0);
    EXPECT_EQ(compare({"a.exr", "a.exr", "--fail", "--max-rmse", "0.001%"}).exitCode, 0);
    EXPECT_EQ(compare({"a.exr", "brighter.exr"}).exitCode, 0) << "not asked";
    const GlimRun differs = compare({"a.exr", "brighter.exr", "--fail", "--json"});
    EXPECT_EQ(differs.exitCode, kDiffers);
    expectSaid(differs, MessageId::PicturesDiffer, {.file = "a.exr"});
    EXPECT_FALSE(json::parse(differs.out).at("z_test").is_null()) << "the report is printed all the same";
    const double rmse = relativeRmse("a.exr", "other.exr");
    EXPECT_EQ(compare({"a.exr", "other.exr", "--max-rmse", std::to_string(1.01 * rmse) + "%"}).exitCode, 0);
    const std::string less = std::to_string(0.99 * rmse) + "%";
    const GlimRun tooFar = compare({"a.exr", "other.exr", "--max-rmse", less});
    EXPECT_EQ(tooFar.exitCode, kDiffers);
    expectSaid(tooFar, MessageId::PicturesDiffer, {.file = "a.exr", .expected = "at most"});
    expectRefused(compare({"a.exr", "more.exr", "--fail"}), 1, MessageId::Requires, {.place = "--fail", .expected = "another --seed"});
    expectRefused(compare({"few.exr", "a.exr", "--fail"}), 1, MessageId::Requires, {.place = "--fail", .expected = "33 samples"});
    expectRefused(compare({"a.exr", "other.exr", "--max-rmse", "2"}), 2, MessageId::Malformed, {.place = "--max-rmse", .expected = "2%"});
}

TEST(CommandLineTest, AnEarlySignalSparesThePictureThatIsThere)
{
    const Films films;
    films.render("x.exr", {"--spp", "1"});
    GlimCall call = films.call("x.exr", {"--size", "2000x2000", "--spp", "4", "--progress", "json"});
    call.signalWhen = hasLine;
    call.signal = SIGHUP;
    const GlimRun run = runForMessages(call);
    EXPECT_EQ(run.exitCode, 129) << run.err;
    expectSaid(run, MessageId::StoppedBySignal, {.value = "SIGHUP"});
    EXPECT_EQ(films.film("x.exr").width, 16U);
}

TEST(CommandLineTest, SignalsEndARenderThatIsThenWritten)
{
    for (const auto& [signal, name, exitCode] : {std::tuple(SIGINT, "SIGINT", 130), std::tuple(SIGTERM, "SIGTERM", 143)}) {
        const Films films;
        GlimCall call =
            films.call("x.exr", {"--size", "60x60", "--spp", "2000000000", "--progress", "json", "--stats", "s.json", "--png", "x.png"});
        call.signalWhen = hasLine;
        call.signal = signal;
        const GlimRun run = runForMessages(call);
        EXPECT_EQ(run.exitCode, exitCode) << run.err;
        expectSaid(run, MessageId::StoppedBySignal, {.value = name});
        EXPECT_TRUE(films.exists("x.png"));
        const Film film = films.film("x.exr");
        std::uint64_t samples = 0;
        for (const PixelMoments& pixel : film.pixels) {
            samples += pixel.count;
            EXPECT_TRUE(std::isfinite(pixel.mean.r + pixel.mean.g + pixel.mean.b));
        }
        const json s = films.statistics("s.json");
        EXPECT_EQ(s.at("stopReason"), name);
        EXPECT_EQ(s.at("samples"), samples);
        EXPECT_GT(samples, 0U);
        EXPECT_EQ(film.sampleRanges.front().second, s.at("sampleRange").at(1));
        EXPECT_LT(film.sampleRanges.front().second, 2000000000U);
    }
}

TEST(CommandLineTest, ProgressAsJsonGoesUpToOne)
{
    const Films films;
    const GlimRun run = runGlim(films.call("x.exr", {"--spp", "512", "--progress", "json"}));
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const std::vector<json> lines = linesOf(run.err);
    ASSERT_GE(lines.size(), 2U);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const json& before = lines[i == 0 ? 0 : i - 1];
        EXPECT_GE(lines[i].at("done"), before.at("done"));
        EXPECT_GE(lines[i].at("samples"), before.at("samples"));
        EXPECT_GE(lines[i].at("seconds"), before.at("seconds"));
        EXPECT_EQ(lines[i].at("totalSamples"), 16 * 16 * 512);
        const json& remaining = lines[i].at("etaSeconds");
        EXPECT_EQ(remaining.is_null(), lines[i].at("done") == 0.0);
        EXPECT_TRUE(remaining.is_null() || remaining >= 0.0) << remaining;
    }
    EXPECT_EQ(lines.back().at("done"), 1.0);
    EXPECT_EQ(lines.back().at("samples"), 16 * 16 * 512);
}

TEST(CommandLineTest, ResultsAreOnStdoutAndChatterOnStderr)
{
    const Films films;
    for (const Arguments& style : {Arguments{}, Arguments{"--progress", "none"}}) {
        Arguments options{"--spp", "64"};
        options.insert(options.end(), style.begin(), style.end());
        const GlimRun run = runGlim(films.call("x.exr", options));
        EXPECT_EQ(run.err, "");  // no terminal, no bar
        EXPECT_EQ(run.out.rfind("x.exr: 16x16, 64 samples per pixel in ", 0), 0U) << run.out;
        EXPECT_NE(run.out.find(", estimated relMSE "), std::string::npos) << run.out;
        EXPECT_NE(run.out.find(", on "), std::string::npos) << "a software device is named: " << run.out;
        EXPECT_EQ(countLines(run.out), 1U);
    }
    const GlimRun bar = runGlim(films.call("x.exr", {"--spp", "64", "--progress", "bar"}));
    EXPECT_NE(bar.err.find("Msamples/s"), std::string::npos) << bar.err;
    EXPECT_EQ(countLines(bar.out), 1U);
    json scene = json::parse(readFileBytes(sceneFile("cornell.gltf")));
    scene["extensionsUsed"].push_back("VENDOR_toon");
    scene["materials"][0]["extensions"]["VENDOR_toon"] = json::object();
    std::ofstream(films.folder() / "warned.gltf") << scene;
    const GlimRun mapped = runGlim(films.call("x.exr", {"--spp", "1"}, (films.folder() / "warned.gltf").string()));
    EXPECT_GE(countLines(mapped.err), 1U) << "warnings are said";
    EXPECT_EQ(countLines(mapped.out), 1U);
}

}  // namespace
}  // namespace glim::test
