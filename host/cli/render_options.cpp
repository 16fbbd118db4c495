#include "host/cli/render_options.hpp"

#include "host/cli/parse.hpp"
#include "host/cli/sampling_options.hpp"
#include "host/cli/settle_options.hpp"

#include <CLI/CLI.hpp>

namespace glim {
namespace {

void addOutputOptions(CLI::App& command, RenderOptions& options)
{
    command.add_option("-o,--output", options.output, "The picture to write: scene-linear EXR with layers (not with --replay)")
        ->required()
        ->type_name("OUT.exr");
    CLI::Option* png = command.add_option("--png", options.png,
                                          "Also write a PNG: sRGB of clip(2^EV x); normals as .5 + .5 n, depth from white to "
                                          "dark, node visits from blue (none) to red (as many as 99.9 % of the pixels have)");
    png->type_name("P.png");
    addExposure(command, options.exposure, "a PNG")->needs(png);
    command
        .add_option("--rates", options.rates, "Write a PNG of the samples per pixel, from blue (fewest) to red (most)")
        ->type_name("R.png");
    command
        .add_option("--stats", options.stats, "Write times, counts and estimated errors, or what --replay prints, as JSON")
        ->type_name("S.json");
    addProgress(command, options.progress);
}

void addTargets(CLI::App& command, ErrorTarget& target)
{
    command
        .add_option_function<std::string>(
            "--target-rmse", [&target](const std::string& text) { target.rmse = parsePercent("--target-rmse", text); },
            "Sample until the estimated root mean square error of the picture is this share of its mean, as in 1%; --spp, "
            "--samples or --time may end it before [off]")
        ->type_name("P%");
    addNumber<double>(command,
                      {"--target-relmse", "E", "The same for the estimated relMSE, mean (x - truth)^2 / (truth^2 + .01 mean^2)",
                       1e-12, 1e6, "off"},
                      [&target](double value) { target.relMse = value; });
}

void addPathOptions(CLI::App& command, RenderOptions& options)
{
    addNumber<std::uint32_t>(
        command,
        {"--suspects", "N",
         "List the N brightest samples of the picture, of each pixel its brightest alone (8 bytes a pixel), each with the option "
         "that replays it",
         1, 1000, "off"},
        [&options](std::uint32_t count) { options.settings.suspects = count; });
    command
        .add_option_function<std::string>(
            "--replay",
            [&command, &options](const std::string& text) {
                options.replay = parseSample(text);
                command.get_option("--output")->required(false);
            },
            "Instead of a picture: trace sample SAMPLE of the pixel in column X and row Y (from the upper left corner, 0,0) alone, "
            "to the bits it has in a render with the same options, and print every vertex, pdf, weight and contribution")
        ->type_name("X,Y,SAMPLE");
}

void addView(CLI::App& command, RenderOptions& options)
{
    addEnum(command, "--view", "V",
            "shaded, or of the surface that a camera ray meets first: normal (world axes), depth (metres along the view axis, 0 "
            "where there is none, averaged over the pixel; the layer depth.Z has the nearest), albedo or bvh-steps (R inner "
            "nodes visited, G primitives tested) [shaded]",
            {"shaded", "normal", "depth", "albedo", "bvh-steps"}, options.settings.view);
}

}  // namespace

void addProgress(CLI::App& command, ProgressStyle& style)
{
    addChoice(command, "--progress", "STYLE", "bar, json (a line per step) or none, to stderr [bar on a terminal]",
              {"bar", "json", "none"}, [&style](std::size_t i) {
                  constexpr ProgressStyle kStyles[] = {ProgressStyle::Bar, ProgressStyle::Json, ProgressStyle::None};
                  style = kStyles[i];
              });
}

void addRenderOptions(CLI::App& command, RenderOptions& options)
{
    addSceneOptions(command, options);
    addOutputOptions(command, options);
    addCameraOptions(command, options);
    addView(command, options);
    addPathOptions(command, options);
    addSampleOptions(command, options.settings, "64; 4 with a --view other than shaded", "0:64");
    addTargets(command, options.target);
    addLightOptions(command, options.settings);
    addAdaptiveOptions(command, options.settings);
    addTracingOptions(command, options.settings, options.split);
    addDevice(command, options);
    command.parse_complete_callback([&command, &options] { settleRender(command, options); });
}

}  // namespace glim
