#include "host/job/render_picture.hpp"

#include "host/flatten/camera_options.hpp"
#include "host/job/outcome.hpp"
#include "host/message.hpp"
#include "host/render/check_memory.hpp"
#include "host/render/film_camera.hpp"
#include "host/render/film_identity.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/parameters.hpp"
#include "host/text.hpp"
#include "shaders/shared/limits.h"

#include <cmath>
#include <limits>
#include <utility>

namespace glim {

void PictureFrame::setGuide(LearnedGuide learned)
{
    settings.guide = learned.guide;
    guide = std::move(learned);
}

PictureFrame framePicture(SceneSession& session, const RenderJob& options)
{
    const Camera camera = makeCamera(session.prepared().scene, options);
    RenderSettings settings = catchingSettings(session.prepared().flat, settingsFor(options, camera));
    if (keepsGroups(session.prepared().flat, settings)) {
        settings.lightGroups = session.prepared().scene.lightGroups;
    }
    if (settings.catcher && options.target.denoised) {
        throw InputError(MessageId::Conflict, {part::place("--denoised"), ": films with shadow catchers are not denoised; expected ",
                                               part::expected("a target for the noisy picture"), "."});
    }
    checkMemory(session.prepared(), settings, session.device().description(), options.checkpoint.isGiven());
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    const FlatCamera flatCamera = flattenCamera(session.prepared(), camera, aspect, options.lens);
    if (options.caustics == CausticsChoice::Auto) {
        RenderSettings shaded = settings;
        shaded.aov = settings.aov == Aov::Guide ? Aov::Radiance : settings.aov;  // whose guide is shown
        settings.caustics = session.choosesLightPaths(flatCamera, shaded);
    }
    return {flatCamera, settings,
            describeFilmCamera(camera, {settings.width, settings.height}, session.prepared().scene.origin, options.at),
            camera.projection.crop};
}

bool answers(const LearnedGuide& guide, GuidingChoice choice)
{
    return choice == GuidingChoice::On ? guide.guide != nullptr : !guide.guide || guide.gain;
}

void learnGuide(SceneSession& session, const RenderJob& options, PictureFrame& frame, const LearningObserver& observer)
{
    const GuideUse use = options.guiding == GuidingChoice::On ? GuideUse::Always : GuideUse::IfItPays;
    frame.setGuide(session.learnGuide(frame.camera, frame.settings, use, observer));
}

void sayGroupMemory(const SceneSession& session, const RenderJob& options, const PictureFrame& frame)
{
    const RenderSettings& settings = frame.settings;
    if (!settings.lightGroups.empty()) {
        const DeviceDescription& device = session.device().description();
        const std::uint64_t bytes = computeGroupBytes(session.prepared(), settings, device, options.checkpoint.isGiven());
        say(MessageId::GroupMemory,
            {counted(settings.lightGroups.size(), "light group"), settings.lightGroups.size() == 1 ? " takes " : " take ",
             part::value(format("%.3g MiB", static_cast<double>(bytes) / 0x1p20)), " of memory"});
    }
}

void labelFilm(Film& film, const RenderJob& options, const PictureFrame& frame)
{
    film.camera = frame.description;
    film.crop = frame.crop;
    film.sceneFile = options.scene.string();
    film.showsBackground = options.environmentBackground && film.catcher.empty();
    film.identity.settings += describeCamera(options.pose, options.field, options.lens, options.projection);
    film.identity.settings += options.shutter ? " shutter=" + describeShutter(*options.shutter) : "";
}

std::optional<Message> findOther(const Film& film, const SceneSession& session, const PictureFrame& frame, const RenderJob& options)
{
    Film expected = emptyFilm(frame.settings);
    expected.identity = makeIdentity(SceneIdentity(session.prepared().flat), frame.camera, frame.settings);
    labelFilm(expected, options, frame);
    const std::optional<Message> difference = findDifference(film, expected);
    if (!difference && film.identity.kernels != expected.identity.kernels) {
        return Message(MessageId::Mismatch, {"it is by another version of glim's ", part::place("kernels"),
                                             "; `glim merge` adds samples that this one renders"});
    }
    return difference;
}

void resumeFrom(Renderer& renderer, StoredFilm stored, const MessagePart& name)
{
    const std::string samples = sampleRangesText(stored.film), arithmetic = stored.film.arithmetic, device = stored.film.device;
    const auto refuse = [&](MessageId id, std::initializer_list<MessagePart> why) {
        const Message reason(id, why);
        throw InputError(Message(reason, {name, ": cannot be resumed: it has samples ", part::value(samples), ", ", reason.sentence, "."}));
    };
    const auto [begin, end] = stored.film.sampleRanges.front();
    const RenderSettings& settings = renderer.settings();
    if (begin != settings.sampleBegin) {
        refuse(MessageId::Mismatch, {"expected ", part::expected("them to begin at " + std::to_string(settings.sampleBegin))});
    }
    if (!stored.checkpoint && end - begin <= kBlockSamples) {
        say(MessageId::BegunAnew, {name, " has no finished block of samples, so the render begins anew"});
        return;
    }
    if (settings.halves && !(stored.checkpoint && stored.checkpoint->hasHalves())) {
        refuse(MessageId::Unsupported, {"but not their two halves, which ", part::place("--denoise"), " needs; expected ",
                                        part::expected("a film by --denoise with --checkpoint or --resume")});
    }
    std::optional<Checkpoint> checkpoint = stored.checkpoint ? std::move(stored.checkpoint) : makeCheckpoint(std::move(stored.film));
    if (!checkpoint) {
        refuse(MessageId::Unsupported, {"expected ", part::expected("one range that ends with a page of " + std::to_string(kPageSamples)),
                                        "; `glim merge` adds others"});
    }
    if (!renderer.plan().canResume(checkpoint->progress)) {
        if (isNeighbours(settings.adaptive)) {
            refuse(MessageId::Mismatch, {"planned for another ", part::place("--spp")});
        }
        refuse(MessageId::Mismatch, {"more than were asked for"});
    }
    renderer.resume(*std::move(checkpoint));
    const double pixels = settings.pixelCount();
    say(MessageId::Resumed,
        {name, " is resumed at ",
         part::value(exactText(std::round(100.0 * static_cast<double>(renderer.statistics().resumedSamples) / pixels) / 100.0)),
         " samples per pixel"});
    if (arithmetic != arithmeticFingerprint(renderer.resources().device)) {
        say(MessageId::OtherRounding, {part::value(renderer.resources().device.description().name), " rounds otherwise than ", device,
                                       " did, so the film will equal a single run up to rounding"});
    }
}

RenderedFilm renderPicture(Renderer& renderer, const RenderJob& options, FilmDenoiser& denoiser, const RenderObserver& observer,
                           const std::function<bool()>& keepsCheckpoint)
{
    RenderedFilm rendered;
    const ErrorTarget& target = options.target;
    RenderProgress last{};
    bool goesOn = true;
    const RenderObserver observe = [&](const RenderProgress& now) {
        last = now;
        last.betweenPasses = false;
        return goesOn = observer(now);
    };
    const auto denoise = [&] {
        rendered.denoising.reset();
        rendered.denoisingError = nullptr;
        try {
            rendered.denoising = denoiser.denoise(options, renderer, [&] { return goesOn = observer(last); });
        } catch (const std::exception&) {
            rendered.denoisingError = std::current_exception();
        }
    };
    const auto timesOfDenoised = [&] {
        denoise();
        return rendered.denoising ? timesToTarget(rendered.denoising->picture.measured, target) : std::numeric_limits<double>::infinity();
    };
    const auto criterion = [&](const Film& film) {
        const double times = target.denoised ? timesOfDenoised() : timesToTarget(film, target);
        rendered.isGood = times <= 1.0;
        rendered.isUnknown = std::isinf(times) && goesOn && renderer.plan().sampleCount() >= kSamplesOfUnknownError;
        return rendered.isUnknown ? 0.0 : times;
    };
    const auto atEnd = [&] {
        try {
            rendered.checkpoint = keepsCheckpoint() ? renderer.checkpoint() : std::nullopt;
        } catch (const DeviceError&) {
            throw;  // nor could the film be read
        } catch (const std::exception& error) {
            say(MessageId::NoCheckpoint, {"the film has no checkpoint: ", describeReason(error)});
        }
    };
    rendered.film = renderer.render(observe, target.isGiven() ? StoppingCriterion(criterion) : nullptr, atEnd);
    if (options.denoise && !(target.denoised && (rendered.isGood || rendered.isUnknown))) {
        denoise();  // else the last look at the target did
    }
    return rendered;
}

void warnIfUnknown(const RenderedFilm& rendered)
{
    if (rendered.isUnknown) {
        warn(MessageId::TargetUnreachable,
             {"the target is not reached after ", part::value(format("%.4g samples per pixel", computeRates(rendered.film).mean)),
              ", and the render ends, because the error is unknown: ",
              estimateError(rendered.film) ? "it is not measured of the denoised picture" : whyUnknown(rendered.film),
              "; without a target it has the samples that --spp asks for."});
    }
}

}  // namespace glim
