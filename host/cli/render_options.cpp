#include "host/cli/render_options.hpp"

#include "host/cli/parse.hpp"

#include <CLI/CLI.hpp>

#include <limits>

namespace glim {
namespace {

void addPictureOptions(CLI::App& command, RenderOptions& options)
{
    command.add_option("SCENE", options.scene, "The scene, .gltf or .glb")->required()->type_name("FILE");
    command.add_option("-o,--output", options.output, "The picture to write: scene-linear EXR with layers")
        ->required()
        ->type_name("OUT.exr");
    CLI::Option* png = command.add_option("--png", options.png, "Also write sRGB of clip(2^EV x) as PNG");
    png->type_name("P.png");
    command
        .add_option_function<std::string>(
            "--size", [&options](const std::string& text) { options.size = parseSize(text); },
            "Pixels, each side 1 to 65535 [512 high, width from the camera's aspect ratio]")
        ->type_name("WxH");
    command.add_option("--camera", options.camera, "Name or index of a camera of the file [0]")->type_name("NAME|INDEX");
    addSceneIndex(command, options.sceneIndex);
    command
        .add_option_function<std::string>(
            "--environment", [&options](const std::string& text) { options.environment = parseRadiance(text); },
            "Constant radiance from everywhere, W/(sr m^2), each >= 0; replaces the file's own [none]")
        ->type_name("R,G,B");
    addExposure(command, options.exposure)->needs(png);
}

void addSampleCounts(CLI::App& command, RenderSettings& settings)
{
    CLI::Option* spp = addNumber<std::uint32_t>(command, {"--spp", "N", "Samples per pixel", 1, kMaxSample, "64"},
                                                [&settings](std::uint32_t count) { settings.sampleEnd = count; });
    CLI::Option* time = addNumber<double>(
        command,
        {"--time", "SECONDS", "Sample for this long and until the pass under way ends; with --samples to its end at most",
         1e-3, 1e9, "off"},
        [&settings](double seconds) { settings.seconds = seconds; });
    CLI::Option* samples = command
                               .add_option_function<std::string>(
                                   "--samples",
                                   [&settings](const std::string& text) {
                                       std::tie(settings.sampleBegin, settings.sampleEnd) = parseRange(text);
                                   },
                                   "Absolute sample indices BEGIN to END - 1, for `glim merge`, 0 to " +
                                       std::to_string(kMaxSample) + " [0:64]")
                               ->type_name("BEGIN:END");
    spp->excludes(time)->excludes(samples);
}

void addSamplingOptions(CLI::App& command, RenderSettings& settings)
{
    addSampleCounts(command, settings);
    addNumber<std::uint32_t>(
        command, {"--bounces", "N", "Most surface events between camera and light; 0 is emission only", 0, 1000000, "64"},
        [&settings](std::uint32_t bounces) { settings.bounces = bounces; });
    addNumber<std::uint32_t>(
        command, {"--seed", "N", "Same seed, same bits", 0, std::numeric_limits<std::uint32_t>::max(), "0"},
        [&settings](std::uint32_t seed) { settings.seed = seed; });
    addChoice(command, "--sampler", "S", "sobol (Owen-scrambled) or independent [sobol]", {"sobol", "independent"},
              [&settings](std::size_t i) { settings.sampler = i == 0 ? Sampler::Sobol : Sampler::Independent; });
    addChoice(command, "--intersector", "I",
              "watertight (Woop 2013) or moller-trumbore (the textbook test; leaks at edges) [watertight]",
              {"watertight", "moller-trumbore"}, [&settings](std::size_t i) {
                  settings.intersector = i == 0 ? Intersector::Watertight : Intersector::MollerTrumbore;
              });
    addNumber<float>(command,
                     {"--clamp-indirect", "X",
                      "Scale down light that met two surfaces or more to at most this radiance, W/(sr m^2); a bias, whose "
                      "energy is reported",
                      1e-30F, 1e30F, "off"},
                     [&settings](float limit) { settings.clampIndirect = limit; });
}

void addMachineOptions(CLI::App& command, RenderOptions& options)
{
    command.add_option("--device", options.device, "Index or part of a name from `glim devices` [the first usable one]")
        ->type_name("D");
    command.add_option("--stats", options.stats, "Write times, counts and estimated errors as JSON")->type_name("S.json");
    addChoice(command, "--progress", "STYLE", "bar, json (a line per step) or none, to stderr [bar on a terminal]",
              {"bar", "json", "none"}, [&options](std::size_t i) {
                  constexpr ProgressStyle kStyles[] = {ProgressStyle::Bar, ProgressStyle::Json, ProgressStyle::None};
                  options.progress = kStyles[i];
              });
}

}  // namespace

void addRenderOptions(CLI::App& command, RenderOptions& options)
{
    addPictureOptions(command, options);
    addSamplingOptions(command, options.settings);
    addMachineOptions(command, options);
    command.parse_complete_callback([&command, &options] {
        if (command.count("--time") > 0 && command.count("--samples") == 0) {
            options.settings.sampleEnd = kMaxSample;
        }
    });
}

}  // namespace glim
