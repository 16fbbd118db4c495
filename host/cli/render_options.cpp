#include "host/cli/render_options.hpp"

#include "host/cli/parse.hpp"
#include "host/cli/sampling_options.hpp"
#include "host/cli/settle_options.hpp"

#include <CLI/CLI.hpp>

namespace glim {
namespace {

void addPictureOptions(CLI::App& command, RenderOptions& options)
{
    command.add_option("SCENE", options.scene, "The scene, .gltf or .glb")->required()->type_name("FILE");
    command.add_option("-o,--output", options.output, "The picture to write: scene-linear EXR with layers")
        ->required()
        ->type_name("OUT.exr");
    CLI::Option* png = command.add_option("--png", options.png,
                                          "Also write a PNG: sRGB of clip(2^EV x); normals as .5 + .5 n, depth from white to "
                                          "dark, node visits from blue (none) to red (as many as 99.9 % of the pixels have)");
    png->type_name("P.png");
    command
        .add_option("--rates", options.rates, "Write a PNG of the samples per pixel, from blue (fewest) to red (most)")
        ->type_name("R.png");
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

void addViewOptions(CLI::App& command, RenderOptions& options)
{
    addEnum(command, "--view", "V",
            "shaded, or of the surface that a camera ray meets first: normal (world axes), depth (metres along the view axis, 0 "
            "where there is none, averaged over the pixel; the layer depth.Z has the nearest), albedo or bvh-steps (R inner "
            "nodes visited, G primitives tested) [shaded]",
            {"shaded", "normal", "depth", "albedo", "bvh-steps"}, options.settings.view);
    CLI::Option* radius = addNumber<float>(
        command, {"--lens-radius", "R", "Radius of a thin lens, metres", 0.0F, 1e6F, "0, a pinhole"},
        [&options](float metres) { options.lens.radius = metres; });
    CLI::Option* distance = addNumber<float>(
        command,
        {"--focal-distance", "D", "From the lens to the plane of sharpness along the view axis, metres", 1e-6F, 1e9F, "none"},
        [&options](float metres) { options.lens.focalDistance = metres; });
    radius->needs(distance);
    distance->needs(radius);
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
    addViewOptions(command, options);
    addSampleOptions(command, options.settings);
    addLightOptions(command, options.settings);
    addAdaptiveOptions(command, options.settings);
    addTracingOptions(command, options.settings, options.split);
    addMachineOptions(command, options);
    command.parse_complete_callback([&command, &options] { settleOptions(command, options); });
}

}  // namespace glim
