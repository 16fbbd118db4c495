#include "host/bench/bench_file.hpp"

#include "host/bench/bench_reference.hpp"
#include "host/bench/run_bench.hpp"
#include "host/cli/bench_kernels.hpp"
#include "host/cli/bench_options.hpp"
#include "host/cli/bench_report.hpp"
#include "host/cli/commands.hpp"
#include "host/clock.hpp"
#include "host/error.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/job/interrupt.hpp"
#include "host/job/output_file.hpp"
#include "host/job/progress.hpp"
#include "host/job/resolve_options.hpp"
#include "host/job/version.hpp"
#include "host/render/check_memory.hpp"
#include "host/render/film_file.hpp"
#include "host/render/light_path_gain.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <bit>
#include <iostream>
#include <memory>
#include <numeric>

namespace glim {
namespace {

// The progress of one scene's bench.
class BenchProgress {
public:
    BenchProgress(ProgressStyle style, const InterruptWatch& watch, std::uint64_t pixels)
        : printer_(style, std::nullopt, pixels),
          watch_(watch),
          pixels_(pixels)
    {}
    ~BenchProgress() { printer_.finish(); }

    // `samples` per pixel are to be rendered in all parts.
    void plan(std::uint64_t samples) { total_ = samples; }
    void finishPart(std::uint64_t samples) { done_ += samples; }
    // `samples` per pixel of the current part are done. False once the user wants to stop.
    bool show(std::uint64_t samples)
    {
        const double seconds = secondsSince(start_);
        if (total_ > 0) {
            printer_.print({pixels_ * (done_ + samples), pixels_ * total_, seconds});
        }
        return watch_.signal() == 0;
    }

private:
    ProgressPrinter printer_;
    const InterruptWatch& watch_;
    std::uint64_t pixels_, done_ = 0, total_ = 0;
    Clock::time_point start_ = Clock::now();
};

glm::uvec2 sizeOf(const BenchOptions& options, const Camera& camera)
{
    const glm::uvec2 natural = defaultSize(camera);
    const std::uint32_t width = (natural.x * kBenchHeight + natural.y / 2) / natural.y;
    return options.size.value_or(glm::uvec2(std::max(1U, width), kBenchHeight));
}

std::string pictureText(const BenchOptions& options)
{
    std::string text = "camera=" + options.camera.value_or("0") + describeCamera(options.pose, options.field, options.lens);
    if (options.sceneIndex) {
        text += " scene=" + std::to_string(*options.sceneIndex);
    }
    if (options.environment) {
        text += " environment=" + describeEnvironment(*options.environment);
    }
    if (options.sun) {
        text += " sun=" + describeSun(*options.sun);
    }
    for (const Addition& addition : options.additions) {
        text += " add=" + describeAddition(addition);
    }
    for (const Edit& edit : options.edits) {
        text += " " + edit.pointer + "=" + edit.value;
    }
    return text;
}

// The options of a baseline, to be rendered again beside those that were asked for. Refuses words that are none of them.
BenchOptions makeOptions(const SceneBench& baseline, const std::string& file, const BenchOptions& asked)
{
    BenchOptions options;
    CommandLine line("", "", "");
    Command& command = line.addCommand("bench", "");
    addBenchOptions(command, options);
    command.onRun([] { return ExitCode::Done; });
    std::vector<std::string> words{"bench", asked.scenes.front().string()};
    words.insert(words.end(), baseline.options->begin(), baseline.options->end());
    try {
        line.run(words);
    } catch (const UsageError& error) {
        throw InputError(error, {part::file(file), ": names options that this version of glim refuses: ", error.what(), "."});
    }
    options.settings.seed = asked.settings.seed;
    options.seeds = asked.seeds;
    return options;
}

// Refuses baselines without the picture of `bench`.
const SceneBench& findBaseline(const std::vector<SceneBench>& baselines, const std::string& file, const SceneBench& bench)
{
    const auto describe = [](const SceneBench& b) {
        return std::filesystem::path(b.scene).filename().string() + " at " + std::to_string(b.width) + "x" + std::to_string(b.height) +
               " with " + b.picture;
    };
    std::string list;
    for (const SceneBench& baseline : baselines) {
        if (describe(baseline) == describe(bench)) {
            return baseline;
        }
        list += (list.empty() ? "" : "; ") + describe(baseline);
    }
    throw InputError(MessageId::Mismatch,
                     {part::file(file), ": has ", part::value(list), "; expected ", part::expected(describe(bench)), "."});
}

// A scene, ready to be measured.
struct BenchJob {
    PreparedScene prepared;
    RenderSettings settings;
    FlatCamera camera;
    SceneBench bench;
};

SceneBench describeBench(const BenchOptions& options, const std::filesystem::path& scene, const RenderSettings& settings,
                         const DeviceDescription& device)
{
    SceneBench bench;
    bench.scene = scene.string();
    bench.picture = pictureText(options);
    bench.settings = describeSettings(settings);
    bench.options = options.words;
    bench.device = device.name + ", " + device.driver;
    bench.version = versionText();
    bench.width = settings.width;
    bench.height = settings.height;
    bench.seeds.resize(options.seeds);
    std::iota(bench.seeds.begin(), bench.seeds.end(), settings.seed);
    return bench;
}

BenchJob prepareJob(const BenchOptions& options, const std::filesystem::path& scene, Device& device)
{
    BenchJob job{prepareScene(scene, makeLoadOptions(options), options.split), options.settings, {}, {}};
    warnIfNoLights(job.prepared);
    sayIfCameraIsNumber(job.prepared.scene, options.camera);
    const Camera camera = makeCamera(job.prepared.scene, options);
    const glm::uvec2 size = sizeOf(options, camera);
    job.settings.width = size.x;
    job.settings.height = size.y;
    job.settings.sampleEnd = std::bit_floor(maxSamples(job.settings));
    job.settings.caustics = options.caustics != CausticsChoice::Off;
    checkMemory(job.prepared, job.settings, device.description());
    job.camera = flattenCamera(job.prepared, camera, static_cast<float>(size.x) / static_cast<float>(size.y), options.lens);
    if (options.caustics == CausticsChoice::Auto) {
        job.settings.caustics = choosesLightPaths(device, job.prepared.flat, job.camera, job.settings);
    }
    job.bench = describeBench(options, scene, job.settings, device.description());
    return job;
}

// Renders the reference. False if the user stopped it.
bool makeReference(Device& device, const BenchJob& job, const RenderSettings& settings, BenchProgress& progress)
{
    Renderer renderer(device, job.prepared.flat, job.camera, settings);
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    bool shouldContinue = true;
    Film film = renderer.render([&](const RenderProgress& now) {
        shouldContinue = progress.show(now.samples / pixels);
        return shouldContinue;
    });
    if (shouldContinue) {
        film.sceneFile = job.bench.scene;
        writeFilm(job.bench.reference, film);
        progress.finishPart(settings.sampleEnd);
    }
    return shouldContinue;
}

// Empty if the baseline's options can be rendered again beside those of the job.
std::string whyNotByTurns(const SceneBench& baseline, const BenchJob& job, const std::optional<BenchJob>& other)
{
    return !baseline.options                         ? "its file does not tell its options"
           : *baseline.options == *job.bench.options ? "it has the same options"
           : describeSettings(referenceSettings(other->settings, 1)) != describeSettings(referenceSettings(job.settings, 1))
               ? "its options ask for other light"
               : "";
}

// Measures one scene into job.bench and, by turns, `other` into its own. False if the user stopped it.
bool measurePair(Device& device, const BenchOptions& options, BenchJob& job, std::optional<BenchJob>& other, const InterruptWatch& watch)
{
    SceneBench& bench = job.bench;
    BenchProgress progress(options.progress, watch, std::uint64_t{bench.width} * bench.height);
    const BenchObserver show = [&](std::uint64_t samples) { return progress.show(samples); };
    Renderer renderer(device, job.prepared.flat, job.camera, job.settings);
    std::vector<BenchSide> sides{{renderer, job.camera}};
    bench.startUp = {job.prepared.loadSeconds, job.prepared.buildSeconds, renderer.statistics().uploadSeconds,
                     renderer.statistics().compileSeconds};
    bench.schedule = getName(renderer.statistics().schedule);
    // This also warms up for --spp: first dispatches take longer.
    const auto fitting =
        chooseSamples(renderer, job.camera, options.samples ? 0.0 : options.seconds, job.settings.sampleEnd / kReferenceFactor, show);
    if (!fitting) {
        return false;
    }
    std::optional<Renderer> otherRenderer;
    if (other) {
        otherRenderer.emplace(device, other->prepared.flat, other->camera, other->settings);
        sides.push_back({*otherRenderer, other->camera});
        if (!chooseSamples(*otherRenderer, other->camera, 0.0, *fitting, show)) {
            return false;
        }
    }
    const std::uint32_t samples = options.samples.value_or(*fitting);
    const std::string identity = renderer.films().folded().identity.scene;
    const RenderSettings longRender = referenceSettings(job.settings, samples);
    bench.reference = options.reference.value_or(getReferencePath(options, bench.scene)).string();
    const bool made = options.reference || (!options.makeReference && isReference(bench.reference, identity, longRender));
    const std::uint64_t work = std::uint64_t{samples} * bench.seeds.size() * sides.size();
    progress.plan(made ? work : work + longRender.sampleEnd);
    if (!made && !makeReference(device, job, longRender, progress)) {
        return false;
    }
    const Picture reference = readReference(bench.reference, bench.width, bench.height, identity, bench.seeds);
    auto rendered = renderSeeds(sides, bench.seeds, samples, reference, show);
    if (!rendered) {
        return false;
    }
    for (BenchJob* each : {&job, other ? &*other : nullptr}) {
        if (each != nullptr) {
            each->bench.floor = measureFloor(reference);
            each->bench.points = std::move(rendered->front().points);
            each->bench.bias = rendered->front().bias;
            rendered->erase(rendered->begin());
        }
    }
    return true;
}

void checkBenchTargets(const BenchOptions& options)
{
    std::vector<std::filesystem::path> inputs = options.scenes;
    for (const auto& input : {options.reference, options.against}) {
        if (input) {
            inputs.push_back(*input);
        }
    }
    checkTarget(options.output, ".json", inputs);
    checkTarget(getCsvPath(options), ".csv", inputs);
    for (const std::filesystem::path& scene : options.scenes) {
        if (!options.reference) {
            checkTarget(getReferencePath(options, scene), ".exr", inputs);
        }
    }
}

ExitCode runBench(const BenchOptions& options)
{
    if (options.kernels) {
        return runBenchKernels(options);
    }
    checkBenchTargets(options);
    const std::vector<SceneBench> baselines = options.against ? readBenches(*options.against) : std::vector<SceneBench>();
    const InterruptWatch watch;
    const VulkanInstance instance;
    Device device(instance, options.device);
    std::vector<SceneBench> benches;
    for (const std::filesystem::path& scene : options.scenes) {
        BenchJob job = prepareJob(options, scene, device);
        const SceneBench* baseline = options.against ? &findBaseline(baselines, options.against->string(), job.bench) : nullptr;
        std::optional<BenchJob> other;
        std::string apart;
        if (baseline != nullptr) {
            if (baseline->options && *baseline->options != *job.bench.options) {
                other = prepareJob(makeOptions(*baseline, options.against->string(), options), scene, device);
            }
            apart = whyNotByTurns(*baseline, job, other);
            if (!apart.empty()) {
                other.reset();
            }
        }
        if (watch.signal() != 0 || !measurePair(device, options, job, other, watch)) {
            return finish(watch.signal(), "no figures are written");
        }
        printBench(job.bench);
        if (baseline != nullptr) {
            const SceneBench& against = other ? other->bench : *baseline;
            printComparison(compareBenches(job.bench, against), against, options.against->string(), apart);
        }
        std::cout << std::flush;
        benches.push_back(std::move(job.bench));
        writeText(options.output, benchJson(benches));
        writeText(getCsvPath(options), benchCsv(benches));
    }
    return ExitCode::Done;
}

}  // namespace

void addBench(CommandLine& line)
{
    auto options = std::make_shared<BenchOptions>();
    Command& command = line.addCommand("bench", "Measure how fast the error of a picture falls, or compare with an earlier bench");
    addBenchOptions(command, *options);
    command.setFooter(
        "Renders K seeds and compares each with the reference after 1, 2, 4 ... samples per pixel. Intervals are 95 %.\n"
        "tools/plot_bench draws OUT.json. host/cli/README.md says how the figures are made.\n"
        "Exit codes: 0 done, 1 bad input, 2 usage, 3 device, 129, 130 or 143 stopped by SIGHUP, SIGINT or SIGTERM.");
    command.onRun([options] { return runBench(*options); });
}

}  // namespace glim
