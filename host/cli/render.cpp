#include "host/cli/render.hpp"

#include "host/cli/check_target.hpp"
#include "host/cli/interrupt.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_report.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_pictures.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <unistd.h>

namespace glim {
namespace {

constexpr std::uint32_t kDefaultHeight = 512;

void checkTargets(const RenderOptions& options)
{
    checkTarget(options.output, ".exr", {options.scene});
    if (options.png) {
        checkTarget(*options.png, ".png", {options.scene});
    }
    if (options.rates) {
        checkTarget(*options.rates, ".png", {options.scene});
    }
    if (options.stats) {
        checkTarget(*options.stats, ".json", {options.scene});
    }
}

float aspectRatioOf(const Camera& camera)
{
    const bool orthographic = camera.kind == Camera::Kind::Orthographic;
    return orthographic ? camera.halfWidth / camera.halfHeight : camera.aspectRatio.value_or(1.0F);
}

LoadOptions loadOptionsOf(const RenderOptions& options)
{
    LoadOptions load{options.sceneIndex, options.environment};
    if (options.size) {
        load.aspectRatio = static_cast<float>(options.size->x) / static_cast<float>(options.size->y);
    }
    return load;
}

RenderSettings settingsFor(const RenderOptions& options, const Camera& camera)
{
    RenderSettings settings = options.settings;
    const float width = std::round(static_cast<float>(kDefaultHeight) * aspectRatioOf(camera));
    const glm::uvec2 size =
        options.size.value_or(glm::uvec2(static_cast<std::uint32_t>(std::clamp(width, 1.0F, 65535.0F)), kDefaultHeight));
    settings.width = size.x;
    settings.height = size.y;
    return settings;
}

const char* nameOf(int signal)
{
    return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

// The exit code of a render that a signal may have ended; says so.
ExitCode finish(int signal, const std::string& what)
{
    if (signal == 0) {
        return ExitCode::Done;
    }
    std::cerr << "glim: stopped by " << nameOf(signal) << "; " << what << ".\n";
    return signal == SIGINT ? ExitCode::Interrupted : signal == SIGTERM ? ExitCode::Terminated : ExitCode::HungUp;
}

// A picture with holes is better than none, but not than the one that is there.
bool wouldRuin(const std::filesystem::path& output, const Film& film)
{
    std::error_code ignored;
    return std::filesystem::exists(output, ignored) &&
           std::any_of(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return p.count == 0; });
}

std::string stopReason(int signal, const Film& film, const RenderSettings& settings)
{
    if (signal != 0) {
        return nameOf(signal);
    }
    if (settings.adaptive == Adaptive::Off) {
        return film.complete && film.sampleRanges[0].second == settings.sampleEnd ? "samples" : "time";
    }
    if (!film.complete) {
        return "time";
    }
    const bool reached = std::any_of(film.pixels.begin(), film.pixels.end(),
                                     [&](const PixelMoments& p) { return p.count >= settings.sampleEnd; });
    return reached ? "samples" : "tolerance";
}

// As describeSettings: the picture can be made again from what is in its file.
std::string describe(const Lens& lens)
{
    char text[100] = "";
    if (lens.radius > 0.0F) {
        std::snprintf(text, sizeof text, " lens-radius=%.9g focal-distance=%.9g", static_cast<double>(lens.radius),
                      static_cast<double>(lens.focalDistance));
    }
    return text;
}

// Seconds that writing took.
double writePictures(const RenderOptions& options, const Film& film)
{
    const auto start = std::chrono::steady_clock::now();
    writeFilm(options.output, film);
    if (options.png) {
        writeFilmPng(*options.png, film, options.exposure);
    }
    if (options.rates) {
        writeRatesPng(*options.rates, film);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Before anything is allocated: Linux grants memory that is not there and later kills the program that uses it.
void refuseWhatDoesNotFit(const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device)
{
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    const std::uint64_t onDevice = sizeInBytes(prepared.flat) + PathBuffers::sizeInBytes(settings.pathCapacity) +
                                   pixels * Slab::bytesPerPixel(settings.adaptive != Adaptive::Off);
    const std::uint64_t onHost = pixels * 2 * sizeof(PixelMoments);  // the film and its planes in the file
    const std::uint64_t memory = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                                 static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
    const auto refuse = [&](std::uint64_t needed, const std::string& owner, std::uint64_t there) {
        if (needed > there) {
            throw InputError(prepared.scene.file + ": the scene and a picture of " + std::to_string(settings.width) + "x" +
                             std::to_string(settings.height) + " need " + std::to_string(needed >> 20) + " MiB, which is " +
                             std::to_string((needed - there) >> 20) + " MiB more memory than " + owner + " has.");
        }
    };
    if (device.software) {
        refuse(onHost + onDevice, "this machine", memory);
        return;
    }
    refuse(onHost, "this machine", memory);
    refuse(onDevice, "device \"" + device.name + "\"", device.memory);
}

ExitCode runRender(const RenderOptions& options)
{
    checkTargets(options);
    const InterruptWatch watch;
    const Instance instance;
    Device device(instance, options.device);
    const PreparedScene prepared = prepareScene(options.scene, loadOptionsOf(options), options.split);
    if (options.settings.view == View::Shaded) {
        warnOfDarkness(prepared);
    }
    const Camera& camera = findCamera(prepared.scene, options.camera);
    const RenderSettings settings = settingsFor(options, camera);
    refuseWhatDoesNotFit(prepared, settings, device.description());
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    if (watch.signal() != 0) {
        return finish(watch.signal(), "nothing was rendered or written");
    }
    Renderer renderer(device, prepared.flat, flattenCamera(camera, aspect, options.lens), settings);

    ProgressPrinter progress(options.progress, settings.seconds, std::uint64_t{settings.width} * settings.height);
    Film film = renderer.render([&](const RenderProgress& now) {
        progress.print(now);
        return watch.signal() == 0;
    });
    progress.finish();
    if (watch.signal() != 0 && renderer.statistics().samples == 0) {
        return finish(watch.signal(), "no sample was finished, and nothing is written");
    }
    if (watch.signal() != 0 && wouldRuin(options.output, film)) {
        return finish(watch.signal(), "some pixels had no sample yet, so " + options.output.string() + " is left as it was");
    }
    film.sceneFile = options.scene.string();
    film.identity.settings += describe(options.lens);
    const double writeSeconds = writePictures(options, film);
    const RenderReport report{options, prepared, film, renderer.statistics(), device.description(),
                              stopReason(watch.signal(), film, settings), writeSeconds};
    if (options.stats) {
        writeStatistics(*options.stats, report);
    }
    printSummary(report);
    return finish(watch.signal(), "what was finished is in " + options.output.string());
}

}  // namespace

void addRender(CLI::App& app, ExitCode& exitCode)
{
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Render a glTF scene to an EXR file");
    addRenderOptions(*command, *options);
    command->footer("EXR layers: R, G, B, A (coverage); albedo; normal (world axes); depth.Z (nearest, along the view axis);\n"
                    "count.X (samples); from 33 samples on variance, of the mean, surest at multiples of 32; squares, blocks and\n"
                    "clamped for merging. The same scene, seed and options give the same pixels. Ctrl-C writes what is finished.\n"
                    "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by SIGHUP, SIGINT or SIGTERM.");
    command->callback([options, &exitCode] { exitCode = runRender(*options); });
}

}  // namespace glim
