#include "host/bench/bench_file.hpp"

#include "host/bench/summarize_bench.hpp"
#include "host/error.hpp"
#include "host/input_file.hpp"
#include "host/json.hpp"
#include "host/text.hpp"

#include <fstream>
#include <iterator>

namespace glim {
namespace {

constexpr std::uint32_t kFormat = 2;

Json toJson(const Interval& interval) { return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}}; }

Json toJson(const BenchPoint& point, const PointSummary& summary)
{
    return {{"samples", point.samples},
            {"seconds", point.seconds},
            {"cpuSeconds", point.cpuSeconds},
            {"kernelSeconds", point.kernelSeconds},
            {"mean", point.mean},
            {"mse", point.mse},
            {"relMse", point.relMse},
            {"trimmedRelMse", point.trimmedRelMse},
            {"summary",
             {{"seconds", summary.seconds},
              {"kernelSeconds", summary.kernelSeconds},
              {"mse", toJson(summary.mse)},
              {"relMse", toJson(summary.relMse)},
              {"trimmedRelMse", summary.trimmedRelMse},
              {"floorLimited", summary.floorLimited}}}};
}

Json toJson(const BenchSummary& summary)
{
    const SlopeTest& test = summary.slopeTest;
    return {{"slope", toJson(summary.slope)},
            {"fit", {{"factor", summary.fit.factor}, {"power", toJson(summary.fit.power)}, {"rest", toJson(summary.fit.rest)}}},
            {"slopeTest",
             {{"holds", test.holds()},
              {"slopeHolds", test.slopeHolds()},
              {"slopeMargin", test.slopeMargin},
              {"biasHolds", test.biasHolds()},
              {"biasLimit", test.biasLimit}}},
            {"efficiency", toJson(summary.efficiency)},
            {"kernelEfficiency", toJson(summary.kernelEfficiency)},
            {"samplesPerSecond", summary.samplesPerSecond}};
}

Json toJson(const SceneBench& bench)
{
    const BenchSummary summary = summarizeBench(bench);
    Json points = Json::array();
    for (std::size_t i = 0; i < bench.points.size(); ++i) {
        points.append(toJson(bench.points[i], summary.points[i]));
    }
    const StartUp& start = bench.startUp;
    return {{"scene", bench.scene},
            {"picture", bench.picture},
            {"settings", bench.settings},
            {"options", bench.options ? Json(*bench.options) : Json(nullptr)},
            {"device", bench.device},
            {"version", bench.version},
            {"schedule", bench.schedule},
            {"size", Json::array({bench.width, bench.height})},
            {"startUpSeconds", {{"load", start.load}, {"build", start.build}, {"upload", start.upload}, {"compile", start.compile}}},
            {"reference",
             {{"file", bench.reference},
              {"known", bench.floor.known},
              {"mse", bench.floor.mse},
              {"relMse", bench.floor.relMse},
              {"relMseError", bench.floor.relMseError}}},
            {"seeds", bench.seeds},
            {"points", points},
            {"bias", {{"squared", bench.bias.squared}, {"error", bench.bias.error}}},
            {"summary", toJson(summary)}};
}

std::vector<double> numbersOf(const Json& json)
{
    std::vector<double> numbers;
    for (const Json& element : json.elements()) {
        numbers.push_back(element.number());
    }
    return numbers;
}

BenchPoint pointOf(const Json& json, std::size_t seeds)
{
    BenchPoint point;
    point.samples = json.at("samples").count();
    const std::pair<const char*, std::vector<double>&> series[] = {
        {"seconds", point.seconds}, {"cpuSeconds", point.cpuSeconds}, {"kernelSeconds", point.kernelSeconds}, {"mean", point.mean},
        {"mse", point.mse},         {"relMse", point.relMse},         {"trimmedRelMse", point.trimmedRelMse}};
    for (const auto& [name, values] : series) {
        const bool isOlder = &values == &point.cpuSeconds && json.find(name) == nullptr;
        values = isOlder ? std::vector<double>(seeds, 0.0) : numbersOf(json.at(name));
        if (values.size() != seeds) {
            throw InputError(MessageId::Mismatch, {"its ", part::place(name), " after ", std::to_string(point.samples), " samples are ",
                                                   part::value(std::to_string(values.size())), " numbers, expected ",
                                                   part::expected(std::to_string(seeds)), ", one for each seed"});
        }
    }
    return point;
}

SceneBench benchOf(const Json& json)
{
    SceneBench bench;
    bench.scene = json.at("scene").text();
    bench.picture = json.at("picture").text();
    bench.settings = json.at("settings").text();
    bench.device = json.at("device").text();
    bench.version = json.at("version").text();
    if (const Json* schedule = json.find("schedule")) {  // absent in older files
        bench.schedule = schedule->text();
    }
    if (const Json* options = json.find("options"); options != nullptr && options->dump() != "null") {  // absent in older files
        bench.options.emplace();
        for (const Json& word : options->elements()) {
            bench.options->push_back(word.text());
        }
    }
    bench.width = json.at("size").at(0).count();
    bench.height = json.at("size").at(1).count();
    const Json &start = json.at("startUpSeconds"), &reference = json.at("reference"), &bias = json.at("bias");
    bench.startUp = {start.at("load").number(), start.at("build").number(), start.at("upload").number(), start.at("compile").number()};
    bench.reference = reference.at("file").text();
    bench.floor = {reference.at("mse").number(), reference.at("relMse").number(), reference.at("relMseError").number(),
                   reference.at("known").boolean()};
    for (const Json& seed : json.at("seeds").elements()) {
        bench.seeds.push_back(seed.count());
    }
    for (const Json& point : json.at("points").elements()) {
        bench.points.push_back(pointOf(point, bench.seeds.size()));
    }
    bench.bias = {bias.at("squared").number(), bias.at("error").number()};
    if (bench.seeds.size() < 2 || bench.points.empty()) {
        throw InputError(
            MessageId::Missing,
            {"it has ", part::value(std::to_string(bench.seeds.size()) + " seeds and " + std::to_string(bench.points.size()) + " points"),
             ", expected ", part::expected("at least two and one")});
    }
    return bench;
}

// As RFC 4180 asks of a field.
std::string quoted(const std::string& text)
{
    std::string field(1, '"');
    for (const char c : text) {
        field.append(c == '"' ? 2 : 1, c);
    }
    field.push_back('"');
    return field;
}

}  // namespace

std::string benchJson(const std::vector<SceneBench>& benches)
{
    Json scenes = Json::array();
    for (const SceneBench& bench : benches) {
        scenes.append(toJson(bench));
    }
    return Json({{"glim:bench", kFormat}, {"scenes", scenes}}).dump(1) + "\n";
}

std::string benchCsv(const std::vector<SceneBench>& benches)
{
    std::string text =
        "scene,width,height,settings,seed,samples,seconds,cpu_seconds,kernel_seconds,mean,mse,relmse,trimmed_relmse,"
        "reference_mse,reference_relmse\n";
    for (const SceneBench& bench : benches) {
        const std::string start = quoted(bench.scene) + "," + std::to_string(bench.width) + "," + std::to_string(bench.height) + "," +
                                  quoted(bench.settings) + ",";
        for (const BenchPoint& point : bench.points) {
            for (std::size_t i = 0; i < bench.seeds.size(); ++i) {
                text += start + std::to_string(bench.seeds[i]) + "," + std::to_string(point.samples);
                for (const double value : {point.seconds[i], point.cpuSeconds[i], point.kernelSeconds[i], point.mean[i], point.mse[i],
                                           point.relMse[i], point.trimmedRelMse[i], bench.floor.mse, bench.floor.relMse}) {
                    text.append(1, ',').append(exactText(value));
                }
                text.push_back('\n');
            }
        }
    }
    return text;
}

std::vector<SceneBench> readBenches(const std::filesystem::path& file)
{
    requireFile(file, "a JSON file of `glim bench`");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        throw InputError(MessageId::FileUnreadable,
                         {part::file(file), ": cannot be read, expected ", part::expected("a JSON file of `glim bench`"), "."});
    }
    const std::optional<Json> json = Json::parse({std::istreambuf_iterator<char>(stream), {}});
    try {
        if (!json) {
            throw JsonError("no JSON");
        }
        if (json->at("glim:bench").count() != kFormat) {
            throw InputError(MessageId::UnknownFormat, {"it has ", part::place("format"), " ", part::value(json->at("glim:bench").dump()),
                                                        ", expected ", part::expected(std::to_string(kFormat))});
        }
        std::vector<SceneBench> benches;
        for (const Json& scene : json->at("scenes").elements()) {
            benches.push_back(benchOf(scene));
        }
        return benches;
    } catch (const InputError& error) {
        throw InputError(error, {part::file(file), ": is not a file of this version's `glim bench`: ", error.what(), "."});
    } catch (const JsonError&) {
        throw InputError(MessageId::UnknownFormat,
                         {part::file(file), ": is not ", part::expected("a JSON file that `glim bench` wrote"), "."});
    }
}

}  // namespace glim
