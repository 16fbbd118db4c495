// A bench that is written and read is the same, and a file that is no bench is refused.
#include "host/bench/bench_file.hpp"

#include "host/error.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/simulated_bench.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace glim {
namespace {

using test::expectRefusal;
using test::readFileBytes;
using test::writeText;

SceneBench someBench()
{
    SceneBench bench = test::simulateBench(test::Flaw::None, 3);
    bench.picture = "camera=0";
    bench.device = "a device";
    bench.version = "glim 1";
    bench.reference = "noise.exr";
    bench.options = {"--size=8x8", "--sampler=independent"};
    bench.startUp = {0.1, 0.2, 0.3, 0.4};
    return bench;
}

TEST(BenchFile, WhatIsReadIsWhatWasWritten)
{
    const test::ScratchFolder folder;
    const std::string text = benchJson({someBench(), test::simulateBench(test::Flaw::Bias, 4)});
    writeText(folder / "bench.json", text);
    const std::vector<SceneBench> benches = readBenches(folder / "bench.json");
    EXPECT_EQ(benchJson(benches), text);
    ASSERT_EQ(benches.size(), 2U);
    EXPECT_EQ(benches[0].scene, "scenes/\"noise\".gltf");
    EXPECT_EQ(benches[0].points[6].relMse, someBench().points[6].relMse);
    EXPECT_EQ(benches[0].points[6].mean, someBench().points[6].mean);
    EXPECT_EQ(benches[0].startUp.compile, 0.4);
    EXPECT_EQ(benches[0].options, someBench().options);
    EXPECT_FALSE(benches[1].options);
    EXPECT_EQ(benches[0].points[6].cpuSeconds, someBench().points[6].cpuSeconds);
    auto older = nlohmann::json::parse(text);
    for (auto& point : older["scenes"][0]["points"]) {
        point.erase("cpuSeconds");
    }
    older["scenes"][0].erase("options");
    writeText(folder / "bench.json", older.dump());
    EXPECT_FALSE(readBenches(folder / "bench.json")[0].options);
    EXPECT_EQ(readBenches(folder / "bench.json")[0].points[6].cpuSeconds, std::vector<double>(16, 0.0));
    EXPECT_EQ(benches[0].bias.squared, someBench().bias.squared);
}

TEST(BenchFile, CsvHasALineForEveryRenderOfEveryPoint)
{
    const std::string text = benchCsv({someBench()});
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 16 * 7);
    EXPECT_EQ(text.rfind("scene,width,height,settings,seed,samples,seconds,", 0), 0U);
    const std::size_t second = text.find('\n') + 1;
    const std::string line = text.substr(second, text.find('\n', second) - second);
    EXPECT_EQ(line.rfind("\"scenes/\"\"noise\"\".gltf\",16,16,\"seed=0 bounces=64\",0,1,", 0), 0U) << line;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 14) << line;
}

TEST(BenchFile, OtherFilesAreRefused)
{
    const test::ScratchFolder folder;
    const auto file = folder / "x.json";
    const auto refuse = [&](const std::string& text, MessageId id, test::Parts parts = {}) {
        writeText(file, text);
        parts.file = "x.json";
        expectRefusal<InputError>([&] { readBenches(file); }, id, parts);
    };
    expectRefusal<InputError>([&] { readBenches(folder / "none.json"); }, MessageId::FileMissing, {.file = "none.json"});
    refuse("{", MessageId::UnknownFormat);
    refuse("{\"scenes\": []}", MessageId::UnknownFormat);
    refuse("{\"glim:bench\": 7, \"scenes\": []}", MessageId::UnknownFormat, {.place = "format", .value = "7", .expected = "2"});
    auto json = nlohmann::json::parse(benchJson({someBench()}));
    json["scenes"][0]["points"][2]["mse"].erase(0);
    refuse(json.dump(), MessageId::Mismatch, {.place = "mse", .value = "15", .expected = "16"});
    json["scenes"][0]["points"] = nlohmann::json::array();
    refuse(json.dump(), MessageId::Missing, {.value = "16 seeds and 0 points"});
}

}  // namespace
}  // namespace glim
