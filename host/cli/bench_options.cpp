#include "host/cli/bench_options.hpp"

#include "host/bench/bench_reference.hpp"
#include "host/bench/run_bench.hpp"
#include "host/cli/parse.hpp"
#include "host/cli/resolve_options.hpp"

#include <bit>
#include <set>

namespace glim {
namespace {

constexpr std::uint32_t kLeastSeeds = 16;  // fewer give no spread worth an interval (Celarek et al. 2019)
constexpr std::uint32_t kMostSeeds = 1024;
constexpr std::uint32_t kMostSamples = kMaxSample / kReferenceFactor;

void addSampling(const Command& command, BenchOptions& options)
{
    command.beginGroup("Sampling and stopping");
    const Option seconds =
        addNumber<double>(command, {"--seconds", "S", "Render time per seed, at least 64 samples per pixel", 1e-3, 1e6, "1"},
                          [&options](double value) { options.seconds = value; });
    addNumber<std::uint32_t>(
        command, {"--spp", "N", "Samples per pixel of each seed, a power of two", kLeastBenchSamples, kMostSamples, "by --seconds"},
        [&options](std::uint32_t samples) {
            if (!std::has_single_bit(samples)) {
                throw UsageError("--spp", "\"" + std::to_string(samples) + "\": expected a power of two, as in 256");
            }
            options.samples = samples;
        })
        .excludes(seconds);
    addNumber<std::uint32_t>(command,
                             {"--seeds", "K", "Independent renders, with consecutive seeds from --seed", kLeastSeeds, kMostSeeds, "16"},
                             [&options](std::uint32_t count) { options.seeds = count; });
    addChoice(command, "--adaptive", "RULE", "off, neighbours or neighbours:absolute, beyond 64 samples per pixel [off]",
              {"off", "neighbours", "neighbours:absolute"}, [&options](std::size_t i) {
                  constexpr Adaptive kRules[] = {Adaptive::Off, Adaptive::Neighbours, Adaptive::NeighboursAbsolute};
                  options.settings.adaptive = kRules[i];
              });
    addSampler(command, options.settings);
}

void addOutput(const Command& command, BenchOptions& options)
{
    command.beginGroup("Output");
    command.addPath("-o,--output", "OUT.json", "Results as JSON; OUT.csv has the raw measurements [bench.json]", options.output);
    const Option reference =
        command.addPath("--reference", "R.exr", "Picture to measure against [OUT.SCENE.exr, made if missing]", options.reference);
    command.addFlag("--make-reference", "Make OUT.SCENE.exr even if it exists", options.makeReference).excludes(reference);
    command.addPath("--against", "BASELINE.json", "Also compare with an earlier bench of the same pictures", options.against);
    command.addFlag("--kernels", "Measure rays per second of the kernels instead", options.kernels);
    addProgress(command, options.progress);
}

void resolveBench(const Command& command, BenchOptions& options)
{
    if (options.scenes.empty() && !options.kernels) {
        throw UsageError("SCENE is required");
    }
    options.outputGiven = command.isGiven("--output");
    options.words = command.wordsGiven({"--output", "--reference", "--make-reference", "--against", "--kernels", "--progress", "--seconds",
                                        "--spp", "--seeds", "--seed", "--device"});
    // For resolveLight, which also refuses more light samples than can be counted.
    options.settings.sampleEnd = options.samples.value_or(kLeastBenchSamples);
    resolveLight(command, options);
    if (options.settings.adaptive != Adaptive::Off && options.settings.sampleEnd <= kPilotSamples && options.samples) {
        throw UsageError("--spp", "\"" + std::to_string(*options.samples) + "\": --adaptive neighbours begins with " +
                                      std::to_string(kPilotSamples) + " samples of every pixel; expected more");
    }
    std::set<std::filesystem::path> references;
    for (const std::filesystem::path& scene : options.scenes) {
        if (!references.insert(referenceOf(options, scene)).second) {
            throw UsageError("SCENE", "\"" + scene.string() + "\": expected scenes of different names");
        }
    }
    if (options.reference && options.scenes.size() > 1) {
        throw UsageError("--reference", "\"" + options.reference->string() + "\": expected one SCENE with it, not " +
                                            std::to_string(options.scenes.size()));
    }
}

}  // namespace

void addBenchOptions(const Command& command, BenchOptions& options)
{
    command.beginGroup("Picture");
    command.addPaths("SCENE", "FILE", "Scenes, .gltf or .glb; without one, --kernels makes hills in memory", options.scenes);
    addPicture(command, options, std::to_string(kBenchHeight));
    addCamera(command, options);
    addSampling(command, options);
    addLightTransport(command, options.settings);
    addCaustics(command, options.settings);
    addCourseEstimators(command, options.settings);
    addDevice(command, options);
    addOutput(command, options);
    for (const char* other : {"--seconds", "--spp", "--seeds", "--reference", "--make-reference", "--against", "--adaptive"}) {
        command.option("--kernels").excludes(command.option(other));
    }
    command.onParsed([command, &options] { resolveBench(command, options); });
}

std::filesystem::path csvOf(const BenchOptions& options) { return std::filesystem::path(options.output).replace_extension(".csv"); }

std::filesystem::path referenceOf(const BenchOptions& options, const std::filesystem::path& scene)
{
    const std::string stem = options.output.stem().string() + "." + scene.stem().string() + ".exr";
    return options.output.parent_path() / stem;
}

}  // namespace glim
