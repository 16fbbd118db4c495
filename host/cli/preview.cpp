#include "host/cli/preview.hpp"

#include "host/cli/parse.hpp"
#include "host/cli/picture_options.hpp"
#include "host/cli/sampling_options.hpp"
#include "host/cli/settle_options.hpp"
#include "host/preview/preview.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace glim {
namespace {

struct WindowOptions : PictureOptions {
    std::optional<std::uint64_t> frames;
    std::optional<std::filesystem::path> script;
};

void addWindowOptions(CLI::App& command, WindowOptions& options)
{
    addNumber<std::uint32_t>(command, {"--frames", "N", "Quit after showing as many pictures", 1, 1000000000, "never"},
                             [&options](std::uint32_t frames) { options.frames = frames; });
    command
        .add_option("--script", options.script,
                    "Acts without a user. A line is a delay in seconds and one of: key K, press K, release K, drag left|middle "
                    "X,Y X,Y, scroll N, click X,Y, resize WxH, iconify, restore, samples N (waits for them), close")
        ->type_name("FILE");
}

// Refines until it is closed, where nothing else is said.
void settleEnd(const CLI::App& command, RenderSettings& settings)
{
    const bool ends = command.count("--spp") + command.count("--samples") + command.count("--max-spp") > 0;
    if (!ends && !isCourse(settings.adaptive)) {
        settings.sampleEnd = kMaxSample / settings.lightSamples;
    }
}

}  // namespace

void addPreview(CLI::App& app)
{
    auto options = std::make_shared<WindowOptions>();
    CLI::App* command = app.add_subcommand("preview", "Show a glTF scene in a window, and refine it while you look around");
    addSceneOptions(*command, *options);
    addCameraOptions(*command, *options);
    addExposure(*command, options->exposure, "the window and a PNG");
    addSampleOptions(*command, options->settings, "as many as there is time for", "0 on");
    addLightOptions(*command, options->settings);
    addAdaptiveOptions(*command, options->settings);
    addTracingOptions(*command, options->settings, options->split);
    addWindowOptions(*command, *options);
    addDevice(*command, *options);
    command->footer("Keys: left-drag orbits, middle-drag or shift-drag pans, the wheel goes nearer; W A S D Q E fly; F frames the scene,\n"
                    "R is the file's camera, 1-9 its others; + - exposure; V the next view (shaded, normal, depth, albedo, samples,\n"
                    "BVH steps); a click prints what is there; Space pauses, P writes what is shown to SCENE-001.exr and .png in the\n"
                    "working folder, C prints the camera as options and as glTF, H shows help, Esc quits. After N samples the picture\n"
                    "has the bits of `glim render --spp N` with the same options and those that C prints. A changed scene file is loaded again.\n"
                    "Exit codes: 0 done, 1 bad input or no display, 2 usage, 3 device.");
    command->parse_complete_callback([command, options] {
        settlePicture(*command, *options);
        settleEnd(*command, options->settings);
        if (options->settings.schedule == Schedule::Auto) {
            options->settings.schedule = Schedule::Wavefront;
        }
    });
    command->callback([options] {
        preview({options->scene, loadOptionsOf(*options), options->split, options->size, options->camera, options->device,
                 options->pose, options->lens, options->exposure, options->settings, options->frames, options->script});
    });
}

}  // namespace glim
