// `glim bench` as a user runs it: files, the reference that is used again, baselines, and what is refused.
#include "host/bench/bench_file.hpp"
#include "host/bench/summarize_bench.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>

namespace glim::test {
namespace {

using Arguments = std::vector<std::string>;
using Id = MessageId;

GlimRun bench(const Arguments& more)
{
    Arguments arguments{"bench", sceneFile("cornell_spheres.gltf"), "--size", "8x8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runGlim(arguments);
}

// Exits with 1, or with 2 of a mistake in the options.
void expectBadInput(const Arguments& arguments, MessageId id, const Parts& parts)
{
    expectRefused(runForMessages(arguments), 1, id, parts);
}
void expectUsage(const Arguments& arguments, MessageId id, const Parts& parts) { expectRefused(runForMessages(arguments), 2, id, parts); }

TEST(BenchCommandTest, MeasuresWritesAndComparesWithAnEarlierBench)
{
    const ScratchFolder folder;
    const std::string first = (folder / "a.json").string(), second = (folder / "b.json").string();
    const std::string reference = (folder / "a.cornell_spheres.exr").string();
    GlimRun run = bench({"--spp", "64", "-o", first});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(countLines(run.out), 11U) << run.out;
    for (const char* part :
         {"cornell_spheres.gltf: 8x8, relMSE ", "(64 samples per pixel, 16 seeds), slope -", "efficiency ", " s to start, on "}) {
        EXPECT_TRUE(contains(run.out, part)) << run.out << "lacks: " << part;
    }
    const std::vector<SceneBench> benches = readBenches(first);
    ASSERT_EQ(benches.size(), 1U);
    EXPECT_EQ(benches[0].points.size(), 7U);
    EXPECT_EQ(benches[0].seeds.size(), 16U);
    EXPECT_TRUE(benches[0].floor.known);
    EXPECT_GT(benches[0].startUp.compile, 0.0);
    EXPECT_GT(benches[0].points.back().kernelSeconds[0], 0.0);
    EXPECT_GT(benches[0].points.back().seconds[0], benches[0].points.back().kernelSeconds[0]);
    EXPECT_EQ(readFileBytes(folder / "a.csv"), benchCsv(benches));

    const std::string bytes = readFileBytes(reference);
    run = bench({"--spp", "64", "-o", second, "--direct", "hemisphere", "--reference", reference, "--against", first});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(readFileBytes(reference), bytes);
    EXPECT_FALSE(std::filesystem::exists(folder / "b.cornell_spheres.exr"));
    EXPECT_TRUE(contains(run.out, "after 64 samples, seeds paired, by turns")) << run.out;
    EXPECT_TRUE(contains(run.out, "\n  not excluded: a load that slows one of the two more than the other")) << run.out;
    EXPECT_FALSE(contains(run.out, "by CPU seconds x  unknown")) << run.out;
    const std::size_t place = run.out.find("  efficiency x ");
    ASSERT_NE(place, std::string::npos);
    const std::string line = run.out.substr(place, run.out.find('\n', place) - place);
    EXPECT_TRUE(contains(line, ", excludes 1")) << line;  // hemisphere sampling of a small light is many times worse

    // Points of 64 samples and less share every sample with the uniform render, so that their means are the same.
    run = bench({"--spp", "128", "-o", second, "--adaptive", "neighbours", "--reference", reference, "--against", first});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_TRUE(contains(run.out, "after 128 samples, seeds paired, by turns")) << run.out;
    const SceneBench adaptive = readBenches(second)[0];
    EXPECT_EQ(adaptive.points.back().samples, 128U);
    EXPECT_TRUE(contains(adaptive.settings, " adaptive=neighbours")) << adaptive.settings;
    EXPECT_EQ(adaptive.points[6].relMse, benches[0].points[6].relMse);

    // What cannot be rendered by turns says so: the same options, and other light.
    run = bench({"--spp", "64", "-o", second, "--reference", reference, "--against", first});
    EXPECT_TRUE(contains(run.out, ", not by turns:\n  mean x              1 [1, 1], does not exclude 1\n  MSE x               1 [1, 1]"))
        << run.out;
    const std::size_t times = run.out.find("  samples a second x  ");
    EXPECT_EQ(run.out.find("exclude 1", times), std::string::npos) << "what is not by turns decides nothing about times: " << run.out;
    EXPECT_TRUE(contains(run.out, ", because it has the same options. CPU seconds suffer less")) << run.out;
    EXPECT_TRUE(contains(bench({"--spp", "64", "-o", second, "--bounces", "2", "--against", first}).out,
                         "because its options ask for other light"));

    // An existing reference is used again, and two runs differ only in times.
    run = bench({"--spp", "64", "-o", first});
    EXPECT_EQ(readFileBytes(reference), bytes);
    EXPECT_EQ(readBenches(first)[0].points.back().relMse, benches[0].points.back().relMse);

    const std::string spheres = sceneFile("cornell_spheres.gltf"), cornell = sceneFile("cornell.gltf");
    const auto with = [&](const std::string& scene, const std::string& size, const Arguments& more) {
        Arguments arguments{"bench", scene, "--size", size, "-o", second};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    const std::string had = "cornell_spheres.gltf at 8x8 with camera=0";
    expectBadInput(with(cornell, "8x8", {"--against", first}), Id::Mismatch, {"a.json", {}, had, "cornell.gltf at 8x8 with camera=0"});
    expectBadInput(with(spheres, "8x9", {"--against", first}), Id::Mismatch,
                   {"a.json", {}, had, "cornell_spheres.gltf at 8x9 with camera=0"});
    expectBadInput(with(spheres, "8x9", {"--reference", reference}), Id::Mismatch, {reference, {}, "8x8", "8x9"});
    expectBadInput(with(cornell, "8x8", {"--reference", reference}), Id::Mismatch, {.file = reference, .place = "scene or camera"});
    expectBadInput(with(spheres, "8x8", {"--reference", reference, "--seed", "2147483640"}), Id::Conflict,
                   {.file = reference, .place = "seed", .value = "2147483648"});
}

TEST(BenchCommandTest, RefusesBeforeAnyWork)
{
    const ScratchFolder folder;
    const std::string output = (folder / "x.json").string();
    const auto with = [&](Arguments more) {
        more.insert(more.begin(), {"bench", "no-such-scene.gltf", "-o", output});
        return more;
    };
    expectUsage({"bench"}, Id::Missing, {.place = "SCENE"});
    expectUsage(with({"--seeds", "15"}), Id::OutOfRange, {{}, "--seeds", "15", "16 to 1024"});
    expectUsage(with({"--spp", "63"}), Id::OutOfRange, {{}, "--spp", "63", "64 to "});
    expectUsage(with({"--spp", "96"}), Id::OutOfRange, {{}, "--spp", "96", "a power of two"});
    expectUsage(with({"--spp", "64", "--adaptive", "neighbours"}), Id::OutOfRange, {{}, "--spp", "64", "more"});
    expectUsage(with({"--adaptive", "course"}), Id::UnknownName, {{}, "--adaptive", "course", "off or neighbours or neighbours:absolute"});
    expectUsage(with({"--seconds", "0"}), Id::OutOfRange, {{}, "--seconds", "0", "0.001"});
    expectUsage(with({"--seconds", "1", "--spp", "64"}), Id::Conflict, {.place = "--seconds", .value = "--spp"});
    expectUsage(with({"--reference", "r.exr", "--make-reference"}), Id::Conflict, {.place = "--reference", .value = "--make-reference"});
    expectUsage(with({"other.gltf", "--reference", "r.exr"}), Id::Conflict, {{}, "--reference", "r.exr", "one SCENE"});
    expectUsage(with({"folder/no-such-scene.glb"}), Id::Duplicate, {.place = "SCENE", .value = "folder/no-such-scene.glb"});
    expectUsage(with({"--light-samples", "4"}), Id::Requires, {{}, "--light-samples", "4", "--direct lights"});
    expectBadInput(with({"--against", (folder / "none.json").string()}), Id::FileMissing, {.file = "none.json"});
    expectBadInput(with({"--against", output}), Id::FileMissing, {.file = "x.json"});
    expectUsage({"bench", "x.gltf", "-o", (folder / "x.txt").string()}, Id::UnknownFormat, {.file = "x.txt", .expected = ".json"});
    expectBadInput(with({}), Id::FileMissing, {.file = "no-such-scene.gltf"});
    EXPECT_EQ(folder.entries(), 0);
}

TEST(BenchCommandTest, AnInterruptWritesNoFigures)
{
    const ScratchFolder folder;
    GlimCall call;
    call.arguments = {"bench", sceneFile("cornell_spheres.gltf"), "--size",     "64x64", "--spp", "4096",
                      "-o",    (folder / "x.json").string(),      "--progress", "json"};
    call.signalWhen = hasLine;
    call.signal = SIGINT;
    const GlimRun run = runForMessages(call);
    EXPECT_EQ(run.exitCode, 130);
    expectSaid(run, Id::StoppedBySignal, {.value = "SIGINT"});
    EXPECT_EQ(folder.entries(), 0);
}

TEST(BenchKernelsTest, TellsWhichVariantIsFastest)
{
    const ScratchFolder folder;
    const std::string file = (folder / "kernels.json").string();
    const GlimRun run = runGlim({"bench", "--kernels", sceneFile("cornell_spheres.gltf"), "--size", "32x32", "-o", file});
    ASSERT_EQ(run.exitCode, 0) << run.err;
    EXPECT_EQ(run.err, "");
    const auto table = nlohmann::json::parse(readFileBytes(file)).at(0);
    EXPECT_EQ(table.at("spheres"), 2);
    std::map<std::string, std::size_t> variants, best;
    for (const auto& rate : table.at("rates")) {
        ++variants[rate.at("rays")];
        best[rate.at("rays")] += rate.at("ofBest") == 1.0 ? 1 : 0;
        const auto& spread = rate.at("raysPerSecond");
        EXPECT_GT(spread.at("low"), 0.0);
        EXPECT_LE(spread.at("low"), spread.at("median"));
        EXPECT_LE(spread.at("median"), spread.at("high"));
        EXPECT_LE(rate.at("ofBest"), 1.0);
        EXPECT_TRUE(rate.at("rays") != "primary" || rate.at("count") == 32 * 32);
    }
    for (const char* rays : {"primary", "diffuse", "shadow"}) {
        EXPECT_EQ(variants[rays], 6U);
        EXPECT_GE(best[rays], 1U);
    }
    const auto& picture = table.at("picture");
    EXPECT_EQ(picture.at("samples"), 32 * 32 * 8);
    EXPECT_GE(picture.at("rays").at("closest"), 32 * 32 * 8);
    EXPECT_LT(picture.at("rays").at("shadow"), picture.at("rays").at("closest"));
    EXPECT_GT(picture.at("traceSeconds"), 0.0);
    EXPECT_NEAR(picture.at("traceShare").get<double>() * picture.at("seconds").at("median").get<double>(),
                picture.at("traceSeconds").get<double>(), 1e-9);
    EXPECT_TRUE(contains(run.out, "\npicture, 8 samples per pixel, ")) << run.out;
    EXPECT_EQ(countLines(run.out), 2U + 18U + 1U) << run.out;
}

// The course's kernels do not know them.
TEST(CommandLineTest, KernelRatesOfTransparentSurfacesLeaveTheCourseOut)
{
    const GlimRun run = runGlim({"bench", "--kernels", sceneFile("alpha.gltf"), "--size", "16x16"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_NE(run.out.find("as rendered"), std::string::npos) << run.out;
    EXPECT_EQ(run.out.find("Moller"), std::string::npos) << run.out;
}

TEST(BenchKernelsTest, NeedsNoScene)
{
    const GlimRun run = runGlim({"bench", "--kernels", "--size", "16x16"});
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_TRUE(contains(run.out, "hills made in memory: 204802 triangles")) << run.out;
    expectBadInput({"bench", "--kernels", "--camera", "x"}, Id::UnknownName, {.file = "hills made in memory", .value = "x"});
    expectBadInput({"bench", "--kernels", sceneFile("alpha.gltf"), "--size", "65535x65535"}, Id::DeviceLimit,
                   {.place = "--size", .value = "65535x65535"});
    expectUsage({"bench", "--kernels", "--spp", "64"}, Id::Conflict, {.place = "--spp", .value = "--kernels"});
    expectBadInput({"bench", "--kernels", "--size", "16x16", "-o", "/nowhere/k.json"}, Id::FileMissing, {.file = "/nowhere/k.json"});
}

}  // namespace
}  // namespace glim::test
