#include "host/cli/render_sequence.hpp"

#include "host/cli/interrupt.hpp"
#include "host/cli/output_file.hpp"
#include "host/cli/render_report.hpp"
#include "host/cli/scene_session.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/message.hpp"
#include "host/render/check_memory.hpp"
#include "host/render/film_file.hpp"
#include "host/render/film_origin.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/identify.hpp"
#include "host/render/merge_films.hpp"
#include "host/text.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>

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

void writePngs(const RenderOptions& options, const Film& film)
{
    if (options.png) {
        writeFilmPng(*options.png, film, aovOf(film), options.exposure);
    }
    if (options.rates) {
        writeFilmPng(*options.rates, film, Aov::SampleCount, 0.0);
    }
}

// Seconds that writing took.
double writePictures(const RenderOptions& options, const Film& film, const std::optional<Checkpoint>& checkpoint)
{
    const auto start = std::chrono::steady_clock::now();
    if (checkpoint) {
        writeFilm(options.output, film, *checkpoint);
    } else {
        writeFilm(options.output, film);
    }
    writePngs(options, film);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// So that the film can be made again from what its file says.
void labelFilm(Film& film, const RenderOptions& options)
{
    film.sceneFile = options.scene.string();
    film.identity.settings += describeCamera(options.pose, options.lens);
}

struct Rendered {
    Film film;
    bool isGood = false;  // the target is reached
    std::optional<Checkpoint> checkpoint;
};

Rendered renderPicture(Renderer& renderer, const RenderOptions& options, CheckpointWriter& writer, ProgressPrinter& progress,
                       const InterruptWatch& watch)
{
    Rendered rendered;
    const auto observe = [&](const RenderProgress& now) {
        progress.print(now, writer.lastWritten());
        if (watch.signal() != 0) {
            writer.abandon();
        } else if (now.betweenPasses) {
            writer.offer(renderer, watch.takeRequest());
        }
        return watch.signal() == 0;
    };
    const auto criterion = [&](const Film& film) {
        const double times = timesToTarget(film, options.target);
        rendered.isGood = times <= 1.0;
        return times;
    };
    const auto atEnd = [&] {
        if (watch.signal() != 0 || options.checkpoint.isGiven()) {
            rendered.checkpoint = renderer.checkpoint();
        }
    };
    rendered.film = renderer.render(observe, options.target.isGiven() ? StoppingCriterion(criterion) : nullptr, atEnd);
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

bool isThere(const std::filesystem::path& file)
{
    std::error_code ignored;
    return std::filesystem::exists(file, ignored);
}

// Whether a film has all samples that were asked for. A checkpoint does not end at a target: it might reach one where nobody has looked.
bool isWhole(const StoredFilm& stored, const RenderOptions& options)
{
    const RenderSettings& settings = options.settings;
    const Film& film = stored.film;
    if (!film.complete) {
        return false;
    }
    const bool resumes = options.checkpoint.resume;
    if (isCourse(settings.adaptive) || (settings.seconds && !resumes)) {
        return true;
    }
    const auto [begin, end] = film.sampleRanges.front();
    const bool all = isNeighbours(settings.adaptive)
                         ? computeRates(film).mean >= settings.sampleEnd
                         : begin == settings.sampleBegin && (end == settings.sampleEnd || (resumes && end > settings.sampleEnd));
    return all || (!stored.checkpoint && options.target.isGiven() && timesToTarget(film, options.target) <= 1.0);
}

}  // namespace

// Renders one picture after another.
class SequenceRenderer {
public:
    explicit SequenceRenderer(const RenderOptions& options)
        : session_(options)
    {}

    bool serves(const RenderOptions& options) const { return session_.serves(options); }
    ExitCode renderAll(const RenderOptions& options, const InterruptWatch& watch);

private:
    RenderOptions optionsOf(const Shot& shot) const;
    ExitCode renderShot(const RenderOptions& options);
    std::optional<StoredFilm> readOutput(const RenderOptions& options, const FlatCamera& camera, const RenderSettings& settings) const;
    bool keep(const RenderOptions& options, const StoredFilm& stored) const;
    std::optional<double> writeIdentities(const RenderOptions& options, const FlatCamera& camera, const Film& film);
    void resume(const RenderOptions& options, Renderer& renderer, StoredFilm stored) const;
    ExitCode writeShot(const RenderOptions& options, const RenderSettings& settings, const FlatCamera& camera, Rendered rendered);

    RenderOptions options_;
    bool isSequence_ = false;
    const InterruptWatch* watch_ = nullptr;  // of the request under way
    SceneSession session_;
    SequencePlace place_;
    std::shared_ptr<const CameraRayKernels> rayKernels_;
};

RenderOptions SequenceRenderer::optionsOf(const Shot& shot) const
{
    RenderOptions options = options_;
    if (isSequence_) {
        options.output = numberedPath(options.output, shot.number);
        for (std::optional<std::filesystem::path>* file : {&options.png, &options.rates, &options.ids, &options.stats}) {
            *file = *file ? std::optional(numberedPath(**file, shot.number)) : std::nullopt;
        }
    }
    options.at = shot.at;
    options.camera = shot.camera;
    options.pose = shot.pose;
    return options;
}

ExitCode SequenceRenderer::renderAll(const RenderOptions& options, const InterruptWatch& watch)
{
    options_ = options;
    isSequence_ = isSequence(options.sequence, options);
    watch_ = &watch;
    session_.pose(firstTime(options.sequence, options));
    const std::vector<Shot> shots = listShots(options.sequence, options, session_.prepared().scene);
    for (const Shot& shot : shots) {
        checkTargets(optionsOf(shot), session_.prepared().scene.files);
    }
    if (options_.settings.aov == Aov::Radiance) {
        warnIfNoLights(session_.prepared());
    }
    place_ = {};
    place_.count = shots.size();
    for (const Shot& shot : shots) {
        session_.pose(shot.at);
        const ExitCode code = renderShot(optionsOf(shot));
        if (code != ExitCode::Done) {
            return code;
        }
        ++place_.index;
    }
    if (isSequence_) {
        std::cout << place_.rendered << " of " << place_.count << " pictures rendered in " << std::fixed << std::setprecision(2)
                  << place_.seconds << " s" << (place_.rendered < place_.count ? ", the others were there\n" : "\n");
    }
    return ExitCode::Done;
}

ExitCode SequenceRenderer::renderShot(const RenderOptions& options)
{
    const auto start = std::chrono::steady_clock::now();
    const Camera camera = cameraOf(session_.prepared().scene, options);
    const RenderSettings settings = settingsFor(options, camera);
    checkMemory(session_.prepared(), settings, session_.device().description(), options.checkpoint.isGiven());
    if (watch_->signal() != 0) {
        return finish(watch_->signal(), place_.rendered == 0 ? "nothing was rendered or written"
                                                             : options.output.string() + " and what follows was not rendered");
    }
    const FlatCamera flatCamera =
        flattenCamera(camera, static_cast<float>(settings.width) / static_cast<float>(settings.height), options.lens);
    std::optional<OutputLock> lock;
    if (options.checkpoint.isGiven()) {
        lock.emplace(options.output);
    }
    std::optional<StoredFilm> stored;
    if (isSequence_ || options.checkpoint.resume) {
        stored = readOutput(options, flatCamera, settings);
    }
    if (stored && keep(options, *stored)) {
        return ExitCode::Done;
    }
    Renderer& renderer = session_.begin(flatCamera, settings);
    if (stored && options.checkpoint.resume) {
        resume(options, renderer, *std::move(stored));
    }
    stored.reset();
    CheckpointWriter writer(options.checkpoint, options.output, [&options](Film& film) { labelFilm(film, options); });
    ProgressPrinter progress(options.progress, settings.seconds, settings.pixelCount(), place_);
    Rendered rendered;
    try {
        rendered = renderPicture(renderer, options, writer, progress, *watch_);
    } catch (const DeviceError& error) {
        progress.finish();
        writer.finish();
        const auto kept = writer.lastWritten();
        throw DeviceError(error.what() + (kept ? " " + options.output.string() + " has the last checkpoint, of " +
                                                     exactText(std::round(100.0 * kept->samplesPerPixel) / 100.0) + " samples per pixel."
                                               : std::string()));
    }
    progress.finish();
    writer.abandon();
    writer.finish();
    const ExitCode code = writeShot(options, settings, flatCamera, std::move(rendered));
    ++place_.rendered;
    place_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return code;
}

// The film at --output, if it is of this picture. A film that cannot be resumed is refused; others are rendered anew.
std::optional<StoredFilm> SequenceRenderer::readOutput(const RenderOptions& options, const FlatCamera& camera,
                                                       const RenderSettings& settings) const
{
    if (!isThere(options.output)) {
        return std::nullopt;
    }
    StoredFilm stored;
    try {
        stored = readStoredFilm(options.output);
    } catch (const InputError&) {
        if (options.checkpoint.resume) {
            throw;
        }
        return std::nullopt;
    }
    Film expected = emptyFilm(settings);
    expected.identity = identityOf(SceneIdentity(session_.prepared().flat), camera, settings);
    labelFilm(expected, options);
    const bool others = stored.film.identity.kernels != expected.identity.kernels;
    const std::string difference = others ? "it is by another version of glim's kernels; `glim merge` adds samples that this one renders"
                                          : describeDifference(stored.film, expected);
    if (!difference.empty() && options.checkpoint.resume) {
        throw InputError(options.output.string() + ": cannot be resumed: " + difference + ".");
    }
    return difference.empty() ? std::optional(std::move(stored)) : std::nullopt;
}

// Keeps a film that is whole already; its PNGs may be of another exposure, and are drawn again.
bool SequenceRenderer::keep(const RenderOptions& options, const StoredFilm& stored) const
{
    if (!isWhole(stored, options) || (options.ids && !isThere(*options.ids)) || (options.stats && !isThere(*options.stats))) {
        return false;
    }
    writePngs(options, stored.film);
    std::cout << escaped(options.output.string()) << ": is whole and was kept\n";
    return true;
}

// Goes on from the film at --output, which is of this picture.
void SequenceRenderer::resume(const RenderOptions& options, Renderer& renderer, StoredFilm stored) const
{
    const std::string samples = sampleRangesText(stored.film), arithmetic = stored.film.arithmetic, device = stored.film.device;
    const auto refuse = [&](const std::string& reason) {
        throw InputError(options.output.string() + ": cannot be resumed: it has samples " + samples + ", " + reason + ".");
    };
    const auto [begin, end] = stored.film.sampleRanges.front();
    const RenderSettings& settings = renderer.settings();
    if (begin != settings.sampleBegin) {
        refuse("expected them to begin at " + std::to_string(settings.sampleBegin));
    }
    if (!stored.checkpoint && !stored.film.complete && end - begin <= kBlockSamples) {
        say(options.output.string() + " has no finished block of samples, so the render begins anew");
        return;
    }
    std::optional<Checkpoint> checkpoint = stored.checkpoint ? std::move(stored.checkpoint) : checkpointOf(std::move(stored.film));
    if (!checkpoint) {
        refuse("expected one range that ends with a page of " + std::to_string(kPageSamples) + "; `glim merge` adds others");
    }
    if (!renderer.canResume(*checkpoint)) {
        refuse(isNeighbours(settings.adaptive) ? "planned for another --spp" : "more than were asked for");
    }
    renderer.resume(*std::move(checkpoint));
    const double pixels = settings.pixelCount();
    say(options.output.string() + " is resumed at " +
        exactText(std::round(100.0 * static_cast<double>(renderer.statistics().resumedSamples) / pixels) / 100.0) + " samples per pixel");
    if (arithmetic != arithmeticFingerprint(renderer.device())) {
        say(renderer.device().description().name + " rounds otherwise than " + device +
            " did, so the film will equal a single run up to rounding");
    }
}

// Seconds that it took, if it was asked for.
std::optional<double> SequenceRenderer::writeIdentities(const RenderOptions& options, const FlatCamera& camera, const Film& film)
{
    if (!options.ids) {
        return std::nullopt;
    }
    const auto start = std::chrono::steady_clock::now();
    Identifier identifier(session_.renderer(), session_.prepared(), camera, rayKernels_);
    writeIds(*options.ids, identifier, film);
    rayKernels_ = identifier.kernels();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ExitCode SequenceRenderer::writeShot(const RenderOptions& options, const RenderSettings& settings, const FlatCamera& camera,
                                     Rendered rendered)
{
    Film& film = rendered.film;
    if (watch_->signal() != 0 && session_.renderer().statistics().samples == 0) {
        return finish(watch_->signal(), "no sample was finished, and nothing is written");
    }
    if (watch_->signal() != 0 && wouldRuin(options.output, film)) {
        return finish(watch_->signal(), "some pixels had no sample yet, so " + options.output.string() + " is left as it was");
    }
    labelFilm(film, options);
    const double writeSeconds = writePictures(options, film, rendered.checkpoint);
    const std::optional<double> idSeconds = writeIdentities(options, camera, film);
    // Before the control, whose samples are no suspects.
    std::vector<Suspect> suspects = findSuspects(session_.renderer(), film);
    const auto bias = measureBias(session_.renderer(), film, *watch_);
    const RenderReport report{options,
                              session_.prepared(),
                              film,
                              session_.renderer().statistics(),
                              session_.device().description(),
                              stopReason(watch_->signal(), film, settings, rendered.isGood, session_.renderer().isDone()),
                              writeSeconds,
                              idSeconds,
                              std::move(suspects),
                              bias};
    if (options.stats) {
        writeStatistics(*options.stats, report);
    }
    printSummary(report);
    return finish(watch_->signal(), "what was finished is in " + options.output.string());
}

RenderSession::RenderSession() = default;
RenderSession::~RenderSession() = default;

ExitCode RenderSession::render(const RenderOptions& options)
{
    checkTargets(options, {options.scene});
    const InterruptWatch watch;
    std::unique_ptr<SequenceRenderer> renderer = std::move(renderer_);  // none stays if anything is thrown
    if (!renderer || !renderer->serves(options)) {
        renderer.reset();  // so that no two scenes are on the device
        renderer = std::make_unique<SequenceRenderer>(options);
    }
    const ExitCode code = renderer->renderAll(options, watch);
    renderer_ = std::move(renderer);
    return code;
}

}  // namespace glim
