#include "host/cli/render_options.hpp"

#include "host/cli/parse.hpp"

#include <CLI/CLI.hpp>

#include <map>

namespace glim {
namespace {

void addPictureOptions(CLI::App& command, RenderOptions& options)
{
    command.add_option("scene", options.scene, "The scene, .gltf or .glb")->required()->type_name("SCENE");
    command.add_option("-o,--output", options.output, "The picture to write: scene-linear EXR with layers")
        ->required()
        ->type_name("OUT.exr");
    command.add_option("--png", options.png, "Also write sRGB of clip(2^EV x) as PNG")->type_name("P.png");
    command
        .add_option_function<std::string>(
            "--size", [&options](const std::string& text) { options.size = parseSize(text); },
            "Pixels [512 high, width from the camera's aspect ratio]")
        ->type_name("WxH");
    command.add_option("--camera", options.camera, "Name or index of a camera of the file [0]")->type_name("NAME|INDEX");
    command.add_option("--scene", options.sceneIndex, "Index of the file's scene [its default one]")->type_name("INDEX");
    command
        .add_option_function<std::string>(
            "--environment", [&options](const std::string& text) { options.environment = parseRadiance(text); },
            "Constant radiance from everywhere, W/(sr m^2), each >= 0; goes before the file's [none]")
        ->type_name("R,G,B");
    command.add_option("--exposure", options.exposure, "Stops (EV) for the PNG, -100 to 100; never applied to the EXR [0]")
        ->check(CLI::Range(-100.0, 100.0))
        ->type_name("EV");
}

void addSamplingOptions(CLI::App& command, RenderOptions& options)
{
    RenderSettings& settings = options.settings;
    CLI::Option* spp =
        command
            .add_option_function<std::uint32_t>(
                "--spp", [&settings](std::uint32_t count) { settings.sampleEnd = count; },
                "Samples per pixel, 1 to 2147483648 [64]")
            ->check(CLI::Range(1U, kMaxSample))
            ->type_name("N");
    CLI::Option* time = command
                            .add_option_function<double>(
                                "--time",
                                [&settings](double seconds) { settings.seconds = seconds; },
                                "Sample for this many seconds, > 0, as far as --samples allows if given")
                            ->check(CLI::Range(1e-3, 1e9))
                            ->type_name("SECONDS");
    CLI::Option* samples = command
                               .add_option_function<std::string>(
                                   "--samples",
                                   [&settings](const std::string& text) {
                                       std::tie(settings.sampleBegin, settings.sampleEnd) = parseRange(text);
                                   },
                                   "Absolute sample indices, for `glim merge`: BEGIN to END - 1 [0:64]")
                               ->type_name("BEGIN:END");
    spp->excludes(time)->excludes(samples);
    command.add_option("--bounces", settings.bounces, "Most surface events between camera and light; 0: emission only [64]")
        ->check(CLI::Range(0U, 1000000U))
        ->type_name("N");
    command.add_option("--seed", settings.seed, "Same seed, same bits; 0 to 4294967295 [0]")->type_name("N");
    const std::map<std::string, Sampler> samplers = {{"sobol", Sampler::Sobol}, {"independent", Sampler::Independent}};
    command.add_option("--sampler", settings.sampler, "sobol (Owen-scrambled) or independent [sobol]")
        ->transform(CLI::CheckedTransformer(samplers))
        ->type_name("S");
    const std::map<std::string, Intersector> intersectors = {{"watertight", Intersector::Watertight},
                                                             {"moller-trumbore", Intersector::MollerTrumbore}};
    command
        .add_option("--intersector", settings.intersector,
                    "watertight (Woop 2013) or moller-trumbore (the textbook test; leaks at edges) [watertight]")
        ->transform(CLI::CheckedTransformer(intersectors))
        ->type_name("I");
    command
        .add_option("--clamp-indirect", settings.clampIndirect,
                    "Scale down light that met two surfaces or more to at most this radiance, > 0; a bias, whose energy is "
                    "reported [off]")
        ->check(CLI::Range(1e-30F, 1e30F))
        ->type_name("X");
}

void addMachineOptions(CLI::App& command, RenderOptions& options)
{
    command.add_option("--device", options.device, "Index or part of a name from `glim devices` [the first usable one]")
        ->type_name("D");
    command.add_option("--stats", options.stats, "Write times, counts and estimated errors as JSON")->type_name("S.json");
    const std::map<std::string, ProgressStyle> styles = {
        {"bar", ProgressStyle::Bar}, {"json", ProgressStyle::Json}, {"none", ProgressStyle::None}};
    command
        .add_option("--progress", options.progress, "bar, json (a line per step) or none, to stderr [bar on a terminal]")
        ->transform(CLI::CheckedTransformer(styles))
        ->type_name("STYLE");
}

}  // namespace

void addRenderOptions(CLI::App& command, RenderOptions& options)
{
    addPictureOptions(command, options);
    addSamplingOptions(command, options);
    addMachineOptions(command, options);
    command.parse_complete_callback([&command, &options] {
        if (command.count("--time") > 0 && command.count("--samples") == 0) {
            options.settings.sampleEnd = kMaxSample;
        }
    });
}

}  // namespace glim
