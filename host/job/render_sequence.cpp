#include "host/job/render_sequence.hpp"

#include "host/clock.hpp"
#include "host/job/film_report.hpp"
#include "host/job/focus.hpp"
#include "host/job/interrupt.hpp"
#include "host/job/movie.hpp"
#include "host/job/outcome.hpp"
#include "host/job/output_file.hpp"
#include "host/job/output_lock.hpp"
#include "host/job/render_picture.hpp"
#include "host/job/render_report.hpp"
#include "host/job/surface_files.hpp"
#include "host/message.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/layers_file.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <ostream>

namespace glim {
namespace {

// `inputs`: files that are not to be overwritten.
void checkTargets(const RenderJob& options, const std::vector<std::filesystem::path>& inputs)
{
    if (options.output) {
        checkTarget(*options.output, ".exr", inputs);
    }
    checkPictureTargets(options.pictures, inputs);
    if (options.rates) {
        checkTarget(*options.rates, ".png", inputs);
    }
    if (options.movie) {
        checkTarget(*options.movie, "", inputs);
    }
    for (const auto* file : {&options.layers, &options.ids, &options.surfaces}) {
        if (*file) {
            checkTarget(**file, ".exr", inputs);
        }
    }
    for (const auto* file : {&options.objects, &options.stats}) {
        if (*file) {
            checkTarget(**file, ".json", inputs);
        }
    }
}

// A picture with holes is better than none, but not better than an existing one.
bool wouldRuin(const std::filesystem::path& output, const Film& film)
{
    std::error_code ignored;
    return std::filesystem::exists(output, ignored) &&
           std::any_of(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return p.count == 0; });
}

std::string stopReason(int signal, const RenderedFilm& rendered, const RenderSettings& settings, bool isDone)
{
    const Film& film = rendered.film;
    if (signal != 0) {
        return getSignalName(signal);
    }
    if (rendered.isGood) {
        return "target";
    }
    if (rendered.isUnknown) {
        return "unknown error";
    }
    if (!isDone) {
        return "time";
    }
    const bool calm = isCourse(settings.adaptive) && std::none_of(film.pixels.begin(), film.pixels.end(),
                                                                  [&](const PixelMoments& p) { return p.count >= settings.sampleEnd; });
    return calm ? "tolerance" : "samples";
}

// The look of the pictures, if there are any.
std::optional<Look> drawFilm(const RenderJob& options, const Film& film)
{
    std::optional<Look> look;
    if (!options.pictures.empty()) {
        look = chooseLook(options.look, film);
        writePictures(options.pictures, film, *look);
    }
    if (options.rates) {
        writeFilmPicture(*options.rates, film, Aov::SampleCount);
    }
    if (options.layers) {
        writeLayers(*options.layers, film, options.compression);
    }
    return look;
}

// Returns its digests if a film is asked for.
std::optional<FilmDigests> writeFilmOf(const RenderJob& options, const RenderedFilm& rendered, const std::optional<Denoising>& denoising)
{
    if (!options.output) {
        return std::nullopt;
    }
    FilmAdditions additions{.checkpoint = rendered.checkpoint ? &*rendered.checkpoint : nullptr};
    std::optional<DenoisedLayers> layers;
    if (denoising) {
        additions.denoised = &layers.emplace(layersOf(*denoising));
    }
    return writeFilm(*options.output, rendered.film, additions);
}

RenderedFilm renderWatched(Renderer& renderer, const RenderJob& options, FilmDenoiser& denoiser, CheckpointWriter& writer,
                           ProgressPrinter& progress, const InterruptWatch& watch)
{
    const auto observe = [&](const RenderProgress& now) {
        progress.print(now, writer.lastWritten());
        if (watch.signal() != 0) {
            writer.abandon();
        } else if (now.betweenPasses) {
            writer.offer(renderer, watch.takeRequest());
        }
        return watch.signal() == 0;
    };
    return renderPicture(renderer, options, denoiser, observe, [&] { return watch.signal() != 0 || options.checkpoint.isGiven(); });
}

std::optional<ControlBias> measureBias(Renderer& renderer, const Film& film, const InterruptWatch& watch)
{
    if (renderer.settings().adaptive == Adaptive::Off) {
        return std::nullopt;
    }
    const auto control = renderer.sampleControl(film, [&] { return watch.signal() == 0; });
    return control ? estimateControlBias(film, *control) : std::nullopt;
}

// For what only informs: it can fail, and the render is none the worse for it.
template <class Inform>
auto tryTo(const char* purpose, Inform inform) -> decltype(inform())
{
    try {
        return inform();
    } catch (const std::exception& error) {
        say(MessageId::NotInformed, {"it was not possible to ", purpose, ": ", describeReason(error)});
        return decltype(inform())();
    }
}

bool isThere(const std::filesystem::path& file)
{
    std::error_code ignored;
    return std::filesystem::exists(file, ignored);
}

// Whether a film has all samples that were asked for. A checkpoint does not end at a target: it might reach one where nobody has looked.
bool isWhole(const StoredFilm& stored, const RenderJob& options)
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
    const bool mayBeShort = !stored.checkpoint && options.target.isGiven() && !options.target.denoised;
    const double times = mayBeShort ? timesToTarget(film, options.target) : 2.0;
    return all || times <= 1.0 || (std::isinf(times) && computeRates(film).mean >= kSamplesOfUnknownError);
}

}  // namespace

// Renders one picture after another.
class SequenceRenderer {
public:
    SequenceRenderer(const RenderJob& options, std::ostream& reports, SceneUse use)
        : reports_(reports),
          session_(options, use)
    {}

    bool serves(const RenderJob& options) const { return session_.serves(options); }
    void pose(const RenderJob& options) { session_.pose(options.edits, firstTime(options.sequence, options)); }
    ExitCode renderAll(const RenderJob& options, const InterruptWatch& watch);

private:
    RenderJob makeOptions(const Shot& shot) const;
    ExitCode renderShot(const RenderJob& options);
    bool mayGoOn(const RenderJob& options) const;
    bool takeGuide(const RenderJob& options, PictureFrame& frame) const;
    std::optional<StoredFilm> readOutput(const RenderJob& options, const PictureFrame& frame) const;
    bool keep(const RenderJob& options, const StoredFilm& stored);
    std::optional<Look> draw(const RenderJob& options, const Film& film);
    void fixSize(const Shot& first);
    ExitCode makeMovieOf(const std::vector<Shot>& shots);
    ExitCode writeShot(const RenderJob& options, const PictureFrame& frame, RenderedFilm rendered);

    std::ostream& reports_;
    RenderJob options_;
    bool isSequence_ = false;
    const InterruptWatch* watch_ = nullptr;  // of the request under way
    SceneSession session_;
    FocusFinder focus_;
    SequencePlace place_;
    SurfaceFiles surfaceFiles_;
};

RenderJob SequenceRenderer::makeOptions(const Shot& shot) const
{
    RenderJob options = options_;
    if (isSequence_) {
        for (std::filesystem::path& file : options.pictures) {
            file = numberedPath(file, shot.number);
        }
        for (std::optional<std::filesystem::path>* file :
             {&options.output, &options.rates, &options.layers, &options.ids, &options.surfaces, &options.objects, &options.stats}) {
            *file = *file ? std::optional(numberedPath(**file, shot.number)) : std::nullopt;
        }
    }
    options.at = shot.at;
    options.camera = shot.camera;
    options.pose = shot.pose;
    return options;
}

ExitCode SequenceRenderer::renderAll(const RenderJob& options, const InterruptWatch& watch)
{
    options_ = options;
    isSequence_ = isSequence(options.sequence, options);
    session_.denoiser().open(options);
    watch_ = &watch;
    pose(options);
    const std::vector<Shot> shots = listShots(options.sequence, options, session_.prepared().scene);
    if (options_.movie) {
        fixSize(shots.front());
    }
    for (const Shot& shot : shots) {
        checkTargets(makeOptions(shot), session_.prepared().scene.files);
        makeCamera(session_.prepared().scene, makeOptions(shot));  // refuses what does not fit it before the first picture
    }
    if (options_.settings.aov == Aov::Radiance) {
        warnIfNoLights(session_.prepared());
    }
    sayIfCameraIsNumber(session_.prepared().scene, options_.camera);
    if (!options_.pictures.empty() && options_.settings.aov == Aov::Radiance && !options_.look.tone) {
        options_.look.tone = chooseTone(session_.prepared().scene);
    }
    place_ = {};
    place_.count = shots.size();
    for (const Shot& shot : shots) {
        session_.pose(options.edits, shot.at);
        const ExitCode code = renderShot(focus_.resolve(makeOptions(shot), session_));
        if (code != ExitCode::Done) {
            return code;
        }
        ++place_.index;
    }
    if (isSequence_) {
        reports_ << place_.rendered << " of " << place_.count << " pictures rendered in " << std::fixed << std::setprecision(2)
                 << place_.seconds << " s" << (place_.rendered < place_.count ? ", the others were there\n" : "\n");
    }
    return options_.movie ? makeMovieOf(shots) : ExitCode::Done;
}

// A movie has one size, even if an animation changes its camera's aspect ratio.
void SequenceRenderer::fixSize(const Shot& first)
{
    options_.size = options_.size.value_or(defaultSize(makeCamera(session_.prepared().scene, makeOptions(first))));
}

ExitCode SequenceRenderer::makeMovieOf(const std::vector<Shot>& shots)
{
    std::vector<std::filesystem::path> pictures;
    for (const Shot& shot : shots) {
        pictures.push_back(makeOptions(shot).pictures.front());
    }
    return makeMovie(options_, pictures, *watch_, reports_);
}

// A movie has one exposure: that of its first picture, if it is automatic.
std::optional<Look> SequenceRenderer::draw(const RenderJob& options, const Film& film)
{
    const std::optional<Look> look = drawFilm(options, film);
    if (look && options_.movie) {
        options_.look.exposure = look->exposure;
    }
    return look;
}

ExitCode SequenceRenderer::renderShot(const RenderJob& options)
{
    const auto start = Clock::now();
    PictureFrame frame = framePicture(session_, options);
    const OutputLock lock(options.mainFile());
    if (options.guiding != GuidingChoice::Off && !takeGuide(options, frame)) {
        ProgressPrinter learning(options.progress, std::nullopt, 1, place_);
        learnGuide(session_, options, frame, [&](const LearningPause& pause) {
            learning.printLearning(pause.done, secondsSince(start));
            return watch_->signal() == 0;
        });
        learning.finish();
    }
    if (watch_->signal() != 0) {
        return finish(watch_->signal(), place_.rendered == 0 ? "nothing was rendered or written"
                                                             : options.mainFile().string() + " and what follows was not rendered");
    }
    std::optional<StoredFilm> stored = readOutput(options, frame);
    if (stored && keep(options, *stored)) {
        return ExitCode::Done;
    }
    if (place_.rendered == 0) {
        sayGroupMemory(session_, options, frame);
    }
    Renderer& renderer = session_.begin(frame.camera, frame.settings);
    if (stored && options.checkpoint.resume) {
        resumeFrom(renderer, *std::move(stored), part::file(options.mainFile()));
    }
    stored.reset();
    CheckpointWriter writer(options.checkpoint, options.mainFile(), [&](Checkpoint& checkpoint) {
        labelFilm(checkpoint.film, options, frame);
        checkpoint.guide = frame.guide;
    });
    ProgressPrinter progress(options.progress, frame.settings.seconds, frame.settings.pixelCount(), place_);
    RenderedFilm rendered;
    try {
        rendered = renderWatched(renderer, options, session_.denoiser(), writer, progress, *watch_);
    } catch (const DeviceError& error) {
        progress.finish();
        writer.finish();
        const auto kept = writer.lastWritten();
        if (!kept) {
            throw;
        }
        throw DeviceError(error, {error.what(), " ", part::file(options.mainFile()), " has the last checkpoint, of ",
                                  exactText(std::round(100.0 * kept->samplesPerPixel) / 100.0), " samples per pixel."});
    }
    progress.finish();
    writer.abandon();
    writer.finish();
    const ExitCode code = writeShot(options, frame, std::move(rendered));
    ++place_.rendered;
    place_.seconds += secondsSince(start);
    return code;
}

// Whether there is a film at --output that the render may go on from or keep.
bool SequenceRenderer::mayGoOn(const RenderJob& options) const
{
    return (isSequence_ || options.checkpoint.resume) && options.output && isThere(*options.output);
}

// Takes the guide of the checkpoint at --output, if it is of this picture, and says whether it did. readOutput() refuses to resume another
// film by it: any guide of this picture would be refused too.
bool SequenceRenderer::takeGuide(const RenderJob& options, PictureFrame& frame) const
{
    if (!mayGoOn(options)) {
        return false;
    }
    PictureFrame guided = frame;
    try {
        std::optional<LearnedGuide> guide = readGuide(*options.output);
        if (!guide || !answers(*guide, options.guiding)) {
            return false;
        }
        guided.setGuide(*std::move(guide));
        guided.keepsGuide = true;
        if (!options.checkpoint.resume && findOther(readFilmHeader(*options.output), session_, guided, options)) {
            return false;
        }
    } catch (const InputError&) {
        if (options.checkpoint.resume) {
            throw;
        }
        return false;
    }
    frame = std::move(guided);
    return true;
}

// The film at --output, if it is of this picture. A film that cannot be resumed is refused; others are rendered anew.
std::optional<StoredFilm> SequenceRenderer::readOutput(const RenderJob& options, const PictureFrame& frame) const
{
    if (!mayGoOn(options)) {
        return std::nullopt;
    }
    StoredFilm stored;
    try {
        stored = readStoredFilm(*options.output);
    } catch (const InputError&) {
        if (options.checkpoint.resume) {
            throw;
        }
        return std::nullopt;
    }
    stored.film.showsBackground = options.environmentBackground && stored.film.catcher.empty();  // which films of earlier builds do not say
    const std::optional<Message> difference = findOther(stored.film, session_, frame, options);
    if (difference && options.checkpoint.resume) {
        throw InputError(Message(*difference, {part::file(options.mainFile()), ": cannot be resumed: ", difference->sentence, "."}));
    }
    return difference ? std::nullopt : std::optional(std::move(stored));
}

// Keeps a film that is whole already; its PNGs may be of another exposure, and are drawn again.
bool SequenceRenderer::keep(const RenderJob& options, const StoredFilm& stored)
{
    const auto isMissing = [](const std::optional<std::filesystem::path>* file) { return *file && !isThere(**file); };
    if (!isWhole(stored, options) ||
        std::ranges::any_of(std::array{&options.ids, &options.surfaces, &options.objects, &options.stats}, isMissing)) {
        return false;
    }
    if (!options.denoise || !stored.film.catcher.empty()) {
        draw(options, stored.film);
    } else if (const auto radiance = readDenoised(*options.output)) {
        draw(options, showDenoised(stored.film, *radiance));
    } else {
        return false;
    }
    reports_ << escaped(options.mainFile().string()) << ": is whole and was kept\n";
    return true;
}

ExitCode SequenceRenderer::writeShot(const RenderJob& options, const PictureFrame& frame, RenderedFilm rendered)
{
    Film& film = rendered.film;
    if (watch_->signal() != 0 && session_.renderer().statistics().samples == 0) {
        return finish(watch_->signal(), "no sample was finished, and nothing is written");
    }
    if (watch_->signal() != 0 && wouldRuin(options.mainFile(), film)) {
        return finish(watch_->signal(), "some pixels had no sample yet, so " + options.mainFile().string() + " is left as it was");
    }
    labelFilm(film, options, frame);
    if (rendered.checkpoint) {
        rendered.checkpoint->guide = frame.guide;
    }
    const std::optional<Denoising>& denoising = rendered.denoising;
    const auto start = Clock::now();
    std::optional<FilmDigests> digests = writeFilmOf(options, rendered, denoising);
    const std::optional<Look> look = draw(options, denoising ? showDenoised(film, denoising->picture.radiance) : film);
    const double writeSeconds = secondsSince(start);
    warnIfUnknown(rendered);
    if (options.denoise && !denoising && !rendered.denoisingError) {
        say(MessageId::NotDenoised, {"the picture is not denoised: ", !film.catcher.empty()   ? "it has a shadow catcher"
                                                                      : watch_->signal() == 0 ? "too few samples were finished"
                                                                                              : "the render was ended"});
    }
    const std::optional<double> idSeconds = surfaceFiles_.write(session_, options, frame, film);
    // Before the control, whose samples are no suspects.
    std::vector<Suspect> suspects = tryTo("find the brightest samples", [&] { return findSuspects(session_.renderer(), film); });
    const auto bias = tryTo("measure the bias", [&] { return measureBias(session_.renderer(), film, *watch_); });
    if (options.stats && !digests) {
        digests = computeDigests(film);
    }
    const RenderReport report{options,
                              session_.prepared(),
                              film,
                              digests.value_or(FilmDigests()),
                              tryTo("estimate the error", [&] { return std::optional(findError(film, options.settings)); }),
                              look,
                              session_.renderer().statistics(),
                              session_.device().description(),
                              stopReason(watch_->signal(), rendered, frame.settings, session_.renderer().plan().isDone()),
                              writeSeconds,
                              idSeconds,
                              std::move(suspects),
                              bias,
                              denoising,
                              frame.guide,
                              frame.keepsGuide};
    if (options.stats) {
        writeStatistics(*options.stats, report);
    }
    tryTo("report on the film", [&] { printSummary(report, reports_); });
    if (rendered.denoisingError) {
        std::rethrow_exception(rendered.denoisingError);
    }
    return finish(watch_->signal(), "what was finished is in " + options.mainFile().string());
}

RenderSession::RenderSession(std::ostream& reports, SceneUse use)
    : reports_(reports),
      use_(use)
{}
RenderSession::~RenderSession() = default;

ExitCode RenderSession::render(const RenderJob& options)
{
    checkTargets(options, {options.scene});
    const InterruptWatch watch;
    if (options.movie) {
        checkMovie(options);
    }
    if (renderer_ && renderer_->serves(options)) {
        renderer_->pose(options);  // what the scene refuses changes nothing
    }
    std::unique_ptr<SequenceRenderer> renderer = std::move(renderer_);  // none stays if anything is thrown
    if (!renderer || !renderer->serves(options)) {
        renderer.reset();                                                               // so that no two scenes are on the device
        const bool needsSurfaces = options.ids || options.surfaces || options.objects;  // afterwards
        const bool isOnePicture = !isSequence(options.sequence, options) && !needsSurfaces;
        renderer = std::make_unique<SequenceRenderer>(options, reports_, isOnePicture ? use_ : SceneUse::Again);
    }
    const ExitCode code = renderer->renderAll(options, watch);
    renderer_ = std::move(renderer);
    return code;
}

}  // namespace glim
