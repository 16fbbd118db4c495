// What a render reports of its tree, its samples per pixel and its steps, in words and as JSON; what compare reports of such
// films.
#include "host/render/film_file.hpp"
#include "shaders/shared/limits.h"
#include "tests/support/decode_png.hpp"
#include "tests/support/run_glim.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_film.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace glim::test {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

class Workplace {
public:
    // Renders scenes/cornell.gltf at 16x16 to x.exr; fails the test unless that succeeds. The summary, and --stats.
    std::pair<std::string, json> render(const Arguments& options) const
    {
        Arguments arguments{"render", sceneFile("cornell.gltf"), "-o", "x.exr", "--size", "16x16", "--stats", "s.json"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const GlimRun run = call(arguments);
        EXPECT_EQ(run.exitCode, 0) << run.err;
        EXPECT_EQ(countLines(run.out), 1U) << run.out;
        return {run.out, json::parse(readFileBytes(folder_ / "s.json"))};
    }
    GlimRun call(const Arguments& arguments) const
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = folder_.path();
        return runGlim(call);
    }
    std::filesystem::path file(const char* name) const { return folder_ / name; }

private:
    ScratchFolder folder_;
};

void expectText(const std::string& text, const char* pattern)
{
    EXPECT_TRUE(std::regex_search(text, std::regex(pattern))) << text << "lacks: " << pattern;
}

// Which the film's file has, or which are computed for the report alone.
TEST(CommandLineTest, ReportsHaveTheFilmsDigestsWhateverIsWritten)
{
    const Workplace workplace;
    const json written = workplace.render({"--spp", "2"}).second;
    const Film film = readFilm(workplace.file("x.exr"));
    EXPECT_EQ(written.at("digest"), computeDigest(film));
    EXPECT_EQ(written.at("pixelsDigest"), computePixelsDigest(film));
    const GlimRun run =
        workplace.call({"render", sceneFile("cornell.gltf"), "-o", "x.png", "--size", "16x16", "--spp", "2", "--stats", "p.json"});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    const json drawn = json::parse(readFileBytes(workplace.file("p.json")));
    for (const char* same : {"digest", "pixelsDigest", "estimate", "rmseOfMeanBound"}) {
        EXPECT_EQ(drawn.at(same), written.at(same)) << same;
    }
}

TEST(CommandLineTest, ReportsDescribeTheTree)
{
    const Workplace workplace;
    std::vector<double> costs;
    for (const std::string rule : {"sah", "mean", "median"}) {
        const json bvh = workplace.render({"--spp", "1", "--split", rule}).second.at("bvh");
        EXPECT_EQ(bvh.at("split"), rule);
        EXPECT_GT(bvh.at("nodes"), 2);
        EXPECT_GT(bvh.at("depth"), 1);
        costs.push_back(bvh.at("cost"));
    }
    EXPECT_LT(costs[0], costs[1]);
    EXPECT_LT(costs[0], costs[2]);
    EXPECT_EQ(workplace.render({"--spp", "1"}).second.at("bvh").at("cost"), costs[0]);
    EXPECT_TRUE(workplace.render({"--spp", "1", "--accelerator", "none"}).second.at("bvh").is_null());
}

TEST(CommandLineTest, PlainReportsHaveNeitherRuleNorSteps)
{
    const Workplace workplace;
    const json stats = workplace.render({"--spp", "1"}).second;
    EXPECT_TRUE(stats.at("adaptive").is_null());
    EXPECT_TRUE(stats.at("steps").is_null());
}

TEST(CommandLineTest, RatesAreAPictureAndARange)
{
    const Workplace workplace;
    const std::string summary = workplace.render({"--spp", "2", "--rates", "r.png"}).first;
    expectText(summary, "^x\\.exr: 16x16, 2 samples per pixel \\(2 to 2\\) in ");
    EXPECT_EQ(decodePng(workplace.file("r.png")), (std::vector<Rgb>(16 * 16, {0, 0, 255})));
}

TEST(CommandLineTest, AdaptiveReportsCountPixels)
{
    const Workplace workplace;
    const auto [summary, stats] = workplace.render({"--adaptive", "course", "--max-spp", "64", "--tolerance", "0.25"});
    const json adaptive = stats.at("adaptive");
    EXPECT_EQ(adaptive.at("rule"), "course");
    EXPECT_EQ(adaptive.at("tolerance"), 0.25);
    EXPECT_EQ(adaptive.at("batch"), 32);
    EXPECT_EQ(adaptive.at("maxSpp"), 64);
    std::uint64_t samples = 0, atMost = 0;
    for (const PixelMoments& pixel : readFilm(workplace.file("x.exr")).pixels) {
        samples += pixel.count;
        atMost += pixel.count == 64 ? 1 : 0;
        EXPECT_GE(pixel.count, adaptive.at("leastSpp"));
        EXPECT_LE(pixel.count, adaptive.at("mostSpp"));
    }
    EXPECT_EQ(adaptive.at("pixelsAtMost"), atMost);
    EXPECT_DOUBLE_EQ(adaptive.at("meanSpp"), static_cast<double>(samples) / (16 * 16));
    EXPECT_EQ(stats.at("stopReason"), atMost == 0 ? "tolerance" : "samples");
    expectText(summary, " samples per pixel \\([0-9]+ to [0-9]+\\) in .*, [0-9.]+ % fewer samples than 64 everywhere, ");
    const std::size_t unknown = stats.at("pixelsWithoutEstimate");
    EXPECT_GT(unknown, 0U) << "pixels that stop after one block";
    EXPECT_TRUE(stats.at("estimate").is_null());
    expectText(summary, (", error unknown: " + std::to_string(unknown) + " pixels have too few samples, bias ").c_str());
}

TEST(CommandLineTest, ATargetEndsARender)
{
    const Workplace workplace;
    const auto [summary, stats] = workplace.render({"--target-rmse", "15%"});
    const json estimate = stats.at("estimate");
    EXPECT_EQ(stats.at("stopReason"), "target");
    EXPECT_LE(estimate.at("rmseOfMean"), 0.15);
    EXPECT_LT(estimate.at("rmseOfMean95")[0], estimate.at("rmseOfMean"));
    EXPECT_GT(estimate.at("rmseOfMean95")[1], estimate.at("rmseOfMean"));
    EXPECT_LT(estimate.at("relmse95")[0], estimate.at("relmse"));
    EXPECT_GT(estimate.at("relmse95")[1], estimate.at("relmse"));
    const std::uint32_t samples = stats.at("sampleRange")[1];
    EXPECT_EQ(samples % blockSamples(samples - 1), 0U) << "blocks are whole";
    EXPECT_EQ(stats.at("samples"), std::uint64_t{samples} * 16 * 16);
    EXPECT_TRUE(readFilmHeader(workplace.file("x.exr")).complete);
    expectText(summary, ", estimated relMSE [0-9.e-]+ \\[[0-9.e-]+, [0-9.e-]+\\], RMSE [0-9.]+ % \\[[0-9.]+, [0-9.]+\\] of the mean");
    if (samples > 64) {
        const json before = workplace.render({"--spp", std::to_string(samples / 2 / 64 * 64)}).second;
        EXPECT_GT(before.at("estimate").at("rmseOfMean"), 0.15) << "no sooner";
    }
    const double reached = estimate.at("relmse");
    const json same = workplace.render({"--target-relmse", std::to_string(1.01 * reached)}).second;
    EXPECT_EQ(same.at("stopReason"), "target");
    EXPECT_LE(same.at("estimate").at("relmse"), 1.01 * reached);
    EXPECT_EQ(workplace.render({"--target-relmse", "1e-9", "--spp", "64"}).second.at("stopReason"), "samples");
    EXPECT_EQ(workplace.render({"--target-relmse", "1e-9", "--time", "0.3"}).second.at("stopReason"), "time");
}

TEST(CommandLineTest, TargetsWithoutMeaningAreRefused)
{
    const Workplace workplace;
    const auto refuses = [&](const Arguments& options, const char* sentence) {
        Arguments arguments{"render", sceneFile("cornell.gltf"), "-o", "x.exr"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        const GlimRun run = workplace.call(arguments);
        EXPECT_EQ(run.exitCode, 2) << run.err;
        EXPECT_NE(run.err.find(sentence), std::string::npos) << run.err;
    };
    for (const char* text : {"1", "%", "0%", "-1%", "nan%", "1001%", "one%"}) {
        refuses({"--target-rmse", text}, "percent of the mean");
    }
    refuses({"--target-relmse", "0"}, "--target-relmse");
    refuses({"--target-relmse", "0.1", "--spp", "63"}, "estimated from 64 samples on");
    refuses({"--target-relmse", "0.1", "--samples", "64:100"}, "estimated from 192 samples on");
    refuses({"--target-relmse", "0.1", "--view", "normal"}, "has no effect with");
    refuses({"--target-rmse", "1%", "--adaptive", "course"}, "a rule of its own");
    EXPECT_FALSE(std::filesystem::exists(workplace.file("x.exr")));
}

// A film's file says all that is needed to make the picture again.
TEST(CommandLineTest, ViewAndLensAreAmongTheSettings)
{
    const Workplace workplace;
    const json stats =
        workplace.render({"--spp", "1", "--lens-radius", "0.1", "--focal-distance", "3", "--look-from", "0,1,2", "--look-at", "0,1,0"})
            .second;
    const std::string settings = stats.at("settings");
    expectText(settings, " look-from=0,1,2 look-at=0,1,0 look-up=0,1,0 lens-radius=0\\.1 focal-distance=3$");
    EXPECT_EQ(readFilm(workplace.file("x.exr")).identity.settings, settings);
    const std::string plain = workplace.render({"--spp", "1"}).second.at("settings");
    EXPECT_EQ(plain.find("lens"), std::string::npos);
    EXPECT_EQ(plain.find("look"), std::string::npos);
}

TEST(CommandLineTest, NeighboursReportTheirSamplesAndTheBiasOfTheirControl)
{
    const Workplace workplace;
    const auto [summary, stats] = workplace.render({"--adaptive", "neighbours", "--spp", "96", "--bounces", "2"});
    expectText(summary, "^x\\.exr: 16x16, 9[5-7](\\.[0-9]+)? samples per pixel \\(64 to [0-9]+\\) in ");
    expectText(summary, ", bias [-+][0-9.]+ % \\[[-+][0-9.]+, [-+][0-9.]+\\] by [0-9]+ control pixels, on ");
    EXPECT_EQ(summary.find("bias of the stopping rule"), std::string::npos);
    const json adaptive = stats.at("adaptive");
    EXPECT_EQ(adaptive.at("rule"), "neighbours");
    EXPECT_FALSE(adaptive.contains("tolerance"));
    EXPECT_GE(adaptive.at("bias").at("pixels"), 16);
    EXPECT_LT(adaptive.at("bias").at("ofMean95")[0], adaptive.at("bias").at("ofMean95")[1]);
    EXPECT_EQ(stats.at("stopReason"), "samples");
    const Film film = readFilm(workplace.file("x.exr"));
    std::uint64_t samples = 0;
    for (const PixelMoments& pixel : film.pixels) {
        samples += pixel.count;
    }
    EXPECT_EQ(stats.at("samples"), samples);
    EXPECT_DOUBLE_EQ(adaptive.at("meanSpp"), static_cast<double>(samples) / (16 * 16));
    EXPECT_NE(film.identity.settings.find(" adaptive=neighbours"), std::string::npos);
}

TEST(CommandLineTest, NeighboursStopAtATargetOrInTime)
{
    const Workplace workplace;
    json stats = workplace.render({"--adaptive", "neighbours", "--target-relmse", "0.02", "--bounces", "2"}).second;
    EXPECT_EQ(stats.at("stopReason"), "target");
    EXPECT_LE(stats.at("estimate").at("relmse"), 0.02);
    stats = workplace.render({"--adaptive", "neighbours:absolute", "--time", "0.5"}).second;
    EXPECT_EQ(stats.at("stopReason"), "time");
    EXPECT_EQ(stats.at("adaptive").at("rule"), "neighbours:absolute");
}

TEST(CommandLineTest, TimeEndsAnAdaptiveRender)
{
    const Workplace workplace;
    const Arguments endless{"--adaptive", "course:literal", "--max-spp", "2000000000", "--tolerance", "1e-30", "--time", "0.3"};
    const json stats = workplace.render(endless).second;
    EXPECT_EQ(stats.at("stopReason"), "time");
    EXPECT_EQ(stats.at("adaptive").at("rule"), "course:literal");
}

TEST(CommandLineTest, StepsAreReportedForTheirViewAlone)
{
    const Workplace workplace;
    const auto [summary, stats] = workplace.render({"--view", "bvh-steps"});
    const json steps = stats.at("steps");
    EXPECT_GT(steps.at("nodesPerRay"), 0.0);
    EXPECT_GT(steps.at("primitivesPerRay"), 0.0);
    EXPECT_GE(steps.at("mostNodes"), steps.at("nodesPerRay"));
    EXPECT_TRUE(stats.at("estimate").is_null());
    EXPECT_EQ(stats.at("samples"), 16 * 16 * 4);
    expectText(summary, ", [0-9.]+ node visits per ray, at most [0-9.]+ in a pixel, on ");
    const auto [normals, other] = workplace.render({"--view", "normal"});
    EXPECT_TRUE(other.at("steps").is_null());
    EXPECT_EQ(normals.find("error unknown"), std::string::npos) << normals;
}

TEST(CommandLineTest, AdaptiveFilmsAreNotTakenForUnfinishedOnes)
{
    const Workplace workplace;
    const Arguments adaptive{"--adaptive", "course:literal", "--tolerance", "0.5", "--max-spp", "64"};
    workplace.render(adaptive);
    EXPECT_TRUE(readFilmHeader(workplace.file("x.exr")).complete);
    EXPECT_EQ(workplace.call({"compare", "x.exr", "x.exr"}).err, "");
    Arguments cut{"--adaptive", "course", "--max-spp", "1000000", "--tolerance", "1e-6", "--time", "0.5"};
    workplace.render(cut);
    EXPECT_FALSE(readFilmHeader(workplace.file("x.exr")).complete);
    EXPECT_NE(workplace.call({"compare", "x.exr", "x.exr"}).err.find("stopped early"), std::string::npos);
}

}  // namespace
}  // namespace glim::test
