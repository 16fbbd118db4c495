#include "host/preview/preview.hpp"
#include "host/cli/commands.hpp"
#include "host/job/parse.hpp"
#include "host/job/picture_options.hpp"
#include "host/job/resolve_options.hpp"
#include "host/preview/compile_shader.hpp"

#include <memory>

namespace glim {
namespace {

struct WindowOptions : PictureOptions {
    std::optional<std::uint64_t> frames;
    std::optional<std::filesystem::path> script, shaders;
    std::optional<glm::uvec2> window;
};

void addWindow(OptionTable& table, WindowOptions& options)
{
    table.beginGroup("Output");
    addLook(table, options.look, "the window and the PNG", "none; neutral in the built-in studio");
    table.add("--window", "WxH", "Pixels of a window whose picture keeps its own size [--size; the picture follows]",
              [&options](const OptionValue& value) { options.window = parseSize(value, "--window"); });
    addNumber<std::uint32_t>(table, {"--frames", "N", "Quit after showing this many pictures", 1, 1000000000, "never"},
                             [&options](std::uint32_t frames) { options.frames = frames; });
    table.addPath("--script", "FILE", "Replay the input that this file lists", options.script);
    table.addPath("--shaders", "DIR", "Kernels from this copy of glim's shaders/, compiled again when they change", options.shaders);
}

// Without a limit the picture is refined until the window closes.
void resolveEnd(OptionTable& table, RenderSettings& settings)
{
    const bool ends = table.isGiven("--spp") || table.isGiven("--samples") || table.isGiven("--max-spp");
    settings.halvesLate = !ends;  // what ends may end within the second until they are kept
    if (!ends && !isCourse(settings.adaptive)) {
        settings.sampleEnd = kMaxSample / settings.course.lightSamples;
    }
}

}  // namespace

void addPreview(CommandLine& line)
{
    auto options = std::make_shared<WindowOptions>();
    Command& command = line.addCommand("preview", "Show a glTF scene in a window, and refine it while you look around");
    command.beginGroup("Picture");
    command.addPath("SCENE", "FILE", "Scene, .gltf or .glb; loaded again when it changes", options->scene).require();
    addPicture(command, *options);
    addCamera(command, *options);
    addProjection(command, *options);
    command.beginGroup("Sampling and stopping");
    addSampleCount(command, options->settings, "until the window closes", "0 on");
    addAdaptive(command, options->settings);
    addSampler(command, options->settings);
    addLightTransport(command, options->settings);
    addGuidingAtRest(command, options->guiding);
    addCourseEstimators(command, options->settings);
    addCourseRule(command, options->settings);
    addDevice(command, *options);
    addWindow(command, *options);
    command.setFooter(
        "Mouse: left-drag orbits, middle-drag or shift-drag pans, the wheel moves closer, a click prints what is there.\n"
        "Keys: W A S D Q E fly, F frames the scene, R the file's camera, 1-9 its others, + - exposure, T next tone,\n"
        "V next layer, N denoises or not, K plays the animation, O focuses on the next click, Space pauses sampling,\n"
        "P writes EXR and PNG, C prints what is shown as options, J saves them as JSON for --edits, F11 full screen,\n"
        "Esc quits, H shows the controls, a list of keys, or the picture alone.\n"
        "Exit codes: 0 done, 1 bad input or no display, 2 usage, 3 device.\n"
        "host/cli/README.md has more on every option.");
    command.onFinished([&command, options] {
        resolvePicture(command, *options);
        resolveEnd(command, options->settings);
        if (options->shaders) {
            requireShaders(*options->shaders);
        }
        options->settings.halves = options->settings.adaptive == Adaptive::Off;
        options->settings.caustics = false;  // their light would come in blocks of samples, seconds late
        if (options->settings.schedule == Schedule::Auto) {
            options->settings.schedule = Schedule::Wavefront;
        }
    });
    command.onRun([options] {
        preview({options->scene, makeLoadOptions(*options), options->split, options->size, options->window, options->camera,
                 options->device, options->pose, options->field, options->projection, options->lens, options->look, options->settings,
                 options->guiding == GuidingChoice::On, options->frames, options->script, options->shaders});
        return ExitCode::Done;
    });
}

}  // namespace glim
