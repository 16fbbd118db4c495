#include "host/cli/commands.hpp"
#include "host/cli/fastest_schedule.hpp"
#include "host/cli/interrupt.hpp"
#include "host/cli/output_file.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_report.hpp"
#include "host/cli/replay.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/render/check_memory.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/identify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

namespace glim {
namespace {

// `inputs`: files that are not to be overwritten.
void checkTargets(const RenderOptions& options, const std::vector<std::filesystem::path>& inputs)
{
    checkTarget(options.output, ".exr", inputs);
    if (options.png) {
        checkTarget(*options.png, ".png", inputs);
    }
    if (options.rates) {
        checkTarget(*options.rates, ".png", inputs);
    }
    if (options.ids) {
        checkTarget(*options.ids, ".exr", inputs);
    }
    if (options.stats) {
        checkTarget(*options.stats, ".json", inputs);
    }
}

// A picture with holes is better than none, but not better than an existing one.
bool wouldRuin(const std::filesystem::path& output, const Film& film)
{
    std::error_code ignored;
    return std::filesystem::exists(output, ignored) &&
           std::any_of(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return p.count == 0; });
}

std::string stopReason(int signal, const Film& film, const RenderSettings& settings, bool isGood, bool isDone)
{
    if (signal != 0) {
        return nameOfSignal(signal);
    }
    if (isGood) {
        return "target";
    }
    if (!isDone) {
        return "time";
    }
    const bool calm = isCourse(settings.adaptive) && std::none_of(film.pixels.begin(), film.pixels.end(),
                                                                  [&](const PixelMoments& p) { return p.count >= settings.sampleEnd; });
    return calm ? "tolerance" : "samples";
}

// Seconds that writing took.
double writePictures(const RenderOptions& options, const Film& film)
{
    const auto start = std::chrono::steady_clock::now();
    writeFilm(options.output, film);
    if (options.png) {
        writeFilmPng(*options.png, film, aovOf(film), options.exposure);
    }
    if (options.rates) {
        writeFilmPng(*options.rates, film, Aov::SampleCount, 0.0);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Seconds that identifying and writing took, if it was asked for.
std::optional<double> identify(const RenderOptions& options, const Renderer& renderer, const PreparedScene& prepared,
                               const FlatCamera& camera, const Film& film)
{
    if (!options.ids) {
        return std::nullopt;
    }
    const auto start = std::chrono::steady_clock::now();
    Identifier identifier(renderer, prepared, camera);
    writeIds(*options.ids, identifier, film);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct Rendered {
    Film film;
    bool isGood = false;  // the target is reached
};

Rendered renderPicture(Renderer& renderer, const ErrorTarget& target, ProgressPrinter& progress, const InterruptWatch& watch)
{
    Rendered rendered;
    const auto observe = [&](const RenderProgress& now) {
        progress.print(now);
        return watch.signal() == 0;
    };
    const auto criterion = [&](const Film& film) {
        const double times = timesToTarget(film, target);
        rendered.isGood = times <= 1.0;
        return times;
    };
    rendered.film = renderer.render(observe, target.isGiven() ? StoppingCriterion(criterion) : nullptr);
    return rendered;
}

std::optional<ControlBias> measureBias(Renderer& renderer, const Film& film, const InterruptWatch& watch)
{
    if (renderer.settings().adaptive == Adaptive::Off) {
        return std::nullopt;
    }
    const auto control = renderer.sampleControl(film, [&] { return watch.signal() == 0; });
    return control ? estimateControlBias(film, *control) : std::nullopt;
}

ExitCode runRender(const RenderOptions& options)
{
    checkTargets(options, {options.scene});
    const InterruptWatch watch;
    const VulkanInstance instance;
    Device device(instance, options.device);
    const PreparedScene prepared = prepareScene(options.scene, loadOptionsOf(options), options.split);
    checkTargets(options, prepared.scene.files);  // textures and maps among them
    if (options.settings.aov == Aov::Radiance) {
        warnIfNoLights(prepared);
    }
    const Camera camera = cameraOf(prepared.scene, options);
    RenderSettings settings = settingsFor(options, camera);
    checkMemory(prepared, settings, device.description());
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    if (watch.signal() != 0) {
        return finish(watch.signal(), "nothing was rendered or written");
    }
    const FlatCamera flatCamera = flattenCamera(camera, aspect, options.lens);
    settings.fastest = fastestSchedule(device, prepared.flat, flatCamera, settings);
    Renderer renderer(device, prepared.flat, flatCamera, settings);

    ProgressPrinter progress(options.progress, settings.seconds, std::uint64_t{settings.width} * settings.height);
    auto [film, isGood] = renderPicture(renderer, options.target, progress, watch);
    progress.finish();
    if (watch.signal() != 0 && renderer.statistics().samples == 0) {
        return finish(watch.signal(), "no sample was finished, and nothing is written");
    }
    if (watch.signal() != 0 && wouldRuin(options.output, film)) {
        return finish(watch.signal(), "some pixels had no sample yet, so " + options.output.string() + " is left as it was");
    }
    film.sceneFile = options.scene.string();
    film.identity.settings += describeCamera(options.pose, options.lens);  // so that the film can be made again from what its file says
    const double writeSeconds = writePictures(options, film);
    const std::optional<double> idSeconds = identify(options, renderer, prepared, flatCamera, film);
    // Before the control, whose samples are no suspects.
    std::vector<Suspect> suspects = findSuspects(renderer, film);
    const auto bias = measureBias(renderer, film, watch);
    const RenderReport report{options,
                              prepared,
                              film,
                              renderer.statistics(),
                              device.description(),
                              stopReason(watch.signal(), film, settings, isGood, renderer.isDone()),
                              writeSeconds,
                              idSeconds,
                              std::move(suspects),
                              bias};
    if (options.stats) {
        writeStatistics(*options.stats, report);
    }
    printSummary(report);
    return finish(watch.signal(), "what was finished is in " + options.output.string());
}

}  // namespace

void addRender(CommandLine& line)
{
    auto options = std::make_shared<RenderOptions>();
    const Command command = line.addCommand("render", "Render a glTF scene to an EXR file");
    addRenderOptions(command, *options);
    command.setFooter(
        "EXR layers: R, G, B, A, albedo, normal, depth.Z, count.X, variance, error, and more for `glim merge`.\n"
        "The same scene, seed and options give the same pixels. Ctrl-C writes what is finished.\n"
        "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by SIGHUP, SIGINT or SIGTERM.\n"
        "host/cli/README.md has more on every option.");
    command.onRun([options] {
        if (options->replay) {
            runReplay(*options);
            return ExitCode::Done;
        }
        return runRender(*options);
    });
}

}  // namespace glim
