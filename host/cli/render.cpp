#include "host/cli/render.hpp"

#include "host/cli/check_target.hpp"
#include "host/cli/interrupt.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_report.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/film_file.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
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
    if (options.stats) {
        checkTarget(*options.stats, ".json", {options.scene});
    }
}

float aspectRatioOf(const Camera& camera)
{
    const bool orthographic = camera.kind == Camera::Kind::Orthographic;
    return orthographic ? camera.halfWidth / camera.halfHeight : camera.aspectRatio.value_or(1.0F);
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

std::string stopReason(int signal, const Film& film, const RenderSettings& settings)
{
    if (signal != 0) {
        return signal == SIGINT ? "SIGINT" : "SIGTERM";
    }
    return film.complete && film.sampleRanges[0].second == settings.sampleEnd ? "samples" : "time";
}

// Seconds that writing took.
double writePictures(const RenderOptions& options, const Film& film)
{
    const auto start = std::chrono::steady_clock::now();
    writeFilm(options.output, film);
    if (options.png) {
        writeFilmPng(*options.png, film, options.exposure);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Linux grants memory that is not there and later kills the program that uses it.
void refuseHugePicture(const RenderSettings& settings, const DeviceDescription& device)
{
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    const std::uint64_t onDevice = pixels * 2 * sizeof(PixelMoments);  // a block and a page
    const std::uint64_t onHost = pixels * 2 * sizeof(PixelMoments);    // the film and its planes in the file
    const std::uint64_t memory = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) *
                                 static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
    const auto refuse = [&](std::uint64_t needed, const std::string& owner, std::uint64_t there) {
        if (needed > there) {
            throw InputError("--size " + std::to_string(settings.width) + "x" + std::to_string(settings.height) +
                             ": the picture needs " + std::to_string(needed >> 20) + " MiB of memory, but " + owner +
                             " has only " + std::to_string(there >> 20) + " MiB.");
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
    const PreparedScene prepared = prepareScene(options.scene, options.sceneIndex, options.environment);
    const Camera& camera = findCamera(prepared.scene, options.camera);
    const RenderSettings settings = settingsFor(options, camera);
    refuseHugePicture(settings, device.description());
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    Renderer renderer(device, prepared.flat, flattenCamera(camera, aspect), settings);

    ProgressPrinter progress(options.progress, settings.seconds, std::uint64_t{settings.width} * settings.height);
    Film film = renderer.render([&](const RenderProgress& now) {
        progress.print(now);
        return watch.signal() == 0;
    });
    progress.finish();
    film.sceneFile = options.scene.string();
    const double writeSeconds = writePictures(options, film);
    const RenderReport report{options, prepared, film, renderer.statistics(), device.description(),
                              stopReason(watch.signal(), film, settings), writeSeconds};
    if (options.stats) {
        writeStatistics(*options.stats, report);
    }
    if (watch.signal() != 0) {
        std::cerr << "glim: stopped by " << report.stopReason << "; what was finished is in " << options.output.string()
                  << ".\n";
    }
    printSummary(report);
    return watch.signal() == 0 ? ExitCode::Done
                               : (watch.signal() == SIGINT ? ExitCode::Interrupted : ExitCode::Terminated);
}

}  // namespace

void addRender(CLI::App& app, ExitCode& exitCode)
{
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Render a glTF scene to an EXR file");
    addRenderOptions(*command, *options);
    command->footer("EXR layers: R, G, B, A; variance of the mean; albedo, normal, depth; count and what merging needs.\n"
                    "The same scene, seed and options give the same bits. Ctrl-C writes what is finished.");
    command->callback([options, &exitCode] { exitCode = runRender(*options); });
}

}  // namespace glim
