#include "host/cli/bench_options.hpp"

#include "host/bench/bench_reference.hpp"
#include "host/bench/run_bench.hpp"
#include "host/job/parse.hpp"
#include "host/job/resolve_options.hpp"

#include <bit>
#include <set>

namespace glim {
namespace {

constexpr std::uint32_t kMinSeeds = 16;  // fewer give no spread worth an interval (Celarek et al. 2019)
constexpr std::uint32_t kMaxSeeds = 1024;
constexpr std::uint32_t kMaxSamples = kMaxSample / kReferenceFactor;

void addSampling(OptionTable& table, BenchOptions& options)
{
    table.beginGroup("Sampling and stopping");
    const Option seconds =
        addNumber<double>(table, {"--seconds", "S", "Render time per seed, at least 64 samples per pixel", 1e-3, 1e6, "1"},
                          [&options](double value) { options.seconds = value; });
    addNumber<std::uint32_t>(
        table, {"--spp", "N", "Samples per pixel of each seed, a power of two", kMinBenchSamples, kMaxSamples, "by --seconds"},
        [&options](std::uint32_t samples) {
            if (!std::has_single_bit(samples)) {
                throw UsageError(MessageId::OutOfRange, {part::place("--spp"), ": ", part::quoted(std::to_string(samples)), ": expected ",
                                                         part::expected("a power of two, as in 256")});
            }
            options.samples = samples;
        })
        .excludes(seconds);
    addNumber<std::uint32_t>(table, {"--seeds", "K", "Independent renders, with consecutive seeds from --seed", kMinSeeds, kMaxSeeds, "16"},
                             [&options](std::uint32_t count) { options.seeds = count; });
    addChoice(table, "--adaptive", "RULE", "off, neighbours or neighbours:absolute, beyond 64 samples per pixel [off]",
              {"off", "neighbours", "neighbours:absolute"}, [&options](std::size_t i) {
                  constexpr Adaptive kRules[] = {Adaptive::Off, Adaptive::Neighbours, Adaptive::NeighboursAbsolute};
                  options.settings.adaptive = kRules[i];
              });
    addSampler(table, options.settings);
}

void addOutput(OptionTable& table, BenchOptions& options)
{
    table.beginGroup("Output");
    table.addPath("-o,--output", "OUT.json", "Results as JSON; OUT.csv has the raw measurements [bench.json]", options.output);
    const Option reference =
        table.addPath("--reference", "R.exr", "Picture to measure against [OUT.SCENE.exr, made if missing]", options.reference);
    table.addFlag("--make-reference", "Make OUT.SCENE.exr even if it exists", options.makeReference).excludes(reference);
    table.addPath("--against", "BASELINE.json", "Also compare with an earlier bench of the same pictures", options.against);
    table.addFlag("--kernels", "Measure rays per second of the kernels instead", options.kernels);
    addProgress(table, options.progress);
}

void resolveBench(OptionTable& table, BenchOptions& options)
{
    if (options.scenes.empty() && !options.kernels) {
        throw UsageError(MessageId::Missing, {part::place("SCENE"), " is required"});
    }
    options.outputGiven = table.isGiven("--output");
    options.words = table.wordsGiven({"--edits", "--output", "--reference", "--make-reference", "--against", "--kernels", "--progress",
                                      "--seconds", "--spp", "--seeds", "--seed", "--device"});
    // For resolveLight, which also refuses more light samples than can be counted.
    options.settings.sampleEnd = options.samples.value_or(kMinBenchSamples);
    resolveLight(table, options);
    if (options.settings.adaptive != Adaptive::Off && options.settings.sampleEnd <= kPilotSamples && options.samples) {
        throw UsageError(MessageId::OutOfRange, {part::place("--spp"), ": ", part::quoted(std::to_string(*options.samples)),
                                                 ": --adaptive neighbours begins with ", std::to_string(kPilotSamples),
                                                 " samples of every pixel; expected ", part::expected("more")});
    }
    std::set<std::filesystem::path> references;
    for (const std::filesystem::path& scene : options.scenes) {
        if (!references.insert(getReferencePath(options, scene)).second) {
            throw UsageError(MessageId::Duplicate,
                             {part::place("SCENE"), ": ", part::quoted(scene), ": expected ", part::expected("scenes of different names")});
        }
    }
    if (options.reference && options.scenes.size() > 1) {
        throw UsageError(MessageId::Conflict, {part::place("--reference"), ": ", part::quoted(*options.reference), ": expected ",
                                               part::expected("one SCENE"), " with it, not ", std::to_string(options.scenes.size())});
    }
}

}  // namespace

void addBenchOptions(OptionTable& table, BenchOptions& options)
{
    table.beginGroup("Picture");
    table.addPaths("SCENE", "FILE", "Scenes, .gltf or .glb; without one, --kernels makes hills in memory", options.scenes);
    addPicture(table, options, std::to_string(kBenchHeight));
    addCamera(table, options);
    addSampling(table, options);
    addLightTransport(table, options.settings);
    addCaustics(table, options.caustics);
    addCourseEstimators(table, options.settings);
    addDevice(table, options);
    addOutput(table, options);
    for (const char* other : {"--seconds", "--spp", "--seeds", "--reference", "--make-reference", "--against", "--adaptive"}) {
        table.option("--kernels").excludes(table.option(other));
    }
    table.onFinished([&table, &options] { resolveBench(table, options); });
}

std::filesystem::path getCsvPath(const BenchOptions& options) { return std::filesystem::path(options.output).replace_extension(".csv"); }

std::filesystem::path getReferencePath(const BenchOptions& options, const std::filesystem::path& scene)
{
    const std::string stem = options.output.stem().string() + "." + scene.stem().string() + ".exr";
    return options.output.parent_path() / stem;
}

}  // namespace glim
