#include "host/cli/bench_options.hpp"

#include "host/bench/bench_reference.hpp"
#include "host/bench/run_bench.hpp"
#include "host/cli/parse.hpp"
#include "host/cli/sampling_options.hpp"
#include "host/cli/settle_options.hpp"

#include <CLI/CLI.hpp>

#include <bit>
#include <set>

namespace glim {
namespace {

constexpr std::uint32_t kLeastSeeds = 16;  // fewer tell no spread worth an interval (Celarek et al. 2019)
constexpr std::uint32_t kMostSeeds = 1024;
constexpr std::uint32_t kMostSamples = kMaxSample / kReferenceFactor;

void addMeasureOptions(CLI::App& command, BenchOptions& options)
{
    CLI::Option* seconds = addNumber<double>(
        command,
        {"--seconds", "S", "Of each seed, rounded to a power of two samples per pixel, at least 64; the reference takes 128 S", 1e-3,
         1e6, "1"},
        [&options](double value) { options.seconds = value; });
    addNumber<std::uint32_t>(command,
                             {"--spp", "N", "Samples per pixel of each seed instead, a power of two", kLeastBenchSamples, kMostSamples,
                              "what --seconds allow"},
                             [&options](std::uint32_t samples) {
                                 if (!std::has_single_bit(samples)) {
                                     throw CLI::ValidationError("--spp", "\"" + std::to_string(samples) +
                                                                             "\": expected a power of two, as in 256");
                                 }
                                 options.samples = samples;
                             })
        ->excludes(seconds);
    addNumber<std::uint32_t>(command, {"--seeds", "K", "Independent renders, from --seed on", kLeastSeeds, kMostSeeds, "16"},
                             [&options](std::uint32_t count) { options.seeds = count; });
}

void addFileOptions(CLI::App& command, BenchOptions& options)
{
    command
        .add_option("-o,--output", options.output,
                    "All figures as JSON; the raw ones also as CSV beside it, and references as OUT.SCENE.exr [bench.json]")
        ->type_name("OUT.json");
    CLI::Option* reference = command.add_option(
        "--reference", options.reference,
        "Picture to measure against, of one scene [OUT.SCENE.exr, which is made if it is not there or of another picture]");
    reference->type_name("R.exr");
    command.add_flag("--make-reference", options.makeReference, "Make OUT.SCENE.exr even if it is there")->excludes(reference);
    command
        .add_option("--against", options.against,
                    "Also print how much better this is than an earlier bench of the same pictures, by other settings or another "
                    "build")
        ->type_name("BASELINE.json");
}

void settleBench(const CLI::App& command, BenchOptions& options)
{
    if (options.scenes.empty() && !options.kernels) {
        throw CLI::RequiredError("SCENE");
    }
    options.outputGiven = command.get_option("--output")->count() > 0;
    // For settleLight, which also refuses more light samples than can be counted.
    options.settings.sampleEnd = options.samples.value_or(kLeastBenchSamples);
    settleLight(command, options);
    if (options.settings.adaptive != Adaptive::Off && options.settings.sampleEnd <= kPilotSamples && options.samples) {
        throw CLI::ValidationError("--spp", "\"" + std::to_string(*options.samples) + "\": --adaptive neighbours begins with " +
                                                std::to_string(kPilotSamples) + " samples of every pixel; expected more");
    }
    std::set<std::filesystem::path> references;
    for (const std::filesystem::path& scene : options.scenes) {
        if (!references.insert(referenceOf(options, scene)).second) {
            throw CLI::ValidationError("SCENE", "\"" + scene.string() + "\": expected scenes of different names");
        }
    }
    if (options.reference && options.scenes.size() > 1) {
        throw CLI::ValidationError("--reference", "\"" + options.reference->string() + "\": expected one SCENE with it, not " +
                                                      std::to_string(options.scenes.size()));
    }
}

}  // namespace

void addBenchOptions(CLI::App& command, BenchOptions& options)
{
    command.add_option("SCENE", options.scenes, "The scenes, .gltf or .glb; none with --kernels: hills made in memory")->type_name("FILE");
    CLI::Option* kernels = command.add_flag("--kernels", options.kernels,
                                            "Measure instead how many rays a second the kernels trace, by kind of ray and variant, and "
                                            "how much of a picture's time that is; as JSON if there is an -o");
    addSceneChoice(command, options);
    addMeasureOptions(command, options);
    addFileOptions(command, options);
    addCameraOptions(command, options, std::to_string(kBenchHeight));
    addSamplerOptions(command, options.settings);
    addChoice(command, "--adaptive", "RULE",
              "neighbours or neighbours:absolute, as `glim render` has them: points of more than 64 samples per pixel are adaptive "
              "[off]",
              {"off", "neighbours", "neighbours:absolute"}, [&options](std::size_t i) {
                  constexpr Adaptive kRules[] = {Adaptive::Off, Adaptive::Neighbours, Adaptive::NeighboursAbsolute};
                  options.settings.adaptive = kRules[i];
              });
    addLightOptions(command, options.settings);
    addTracingOptions(command, options.settings, options.split);
    addDevice(command, options);
    addProgress(command, options.progress);
    for (const char* other : {"--seconds", "--spp", "--seeds", "--reference", "--make-reference", "--against", "--adaptive"}) {
        kernels->excludes(command.get_option(other));
    }
    command.parse_complete_callback([&command, &options] { settleBench(command, options); });
}

std::filesystem::path csvOf(const BenchOptions& options)
{
    return std::filesystem::path(options.output).replace_extension(".csv");
}

std::filesystem::path referenceOf(const BenchOptions& options, const std::filesystem::path& scene)
{
    const std::string stem = options.output.stem().string() + "." + scene.stem().string() + ".exr";
    return options.output.parent_path() / stem;
}

}  // namespace glim
