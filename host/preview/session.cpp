#include "host/preview/session.hpp"

#include "host/error.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

namespace glim {
namespace {

constexpr double kIdleSeconds = 0.05;

}  // namespace

Session::Session(Window& window, EventQueue& events, const PreviewOptions& options)
    : window_(window),
      events_(events),
      options_(options),
      screen_(window, options.device),
      drawer_(screen_.device()),
      scene_(options.scene),
      loader_(std::make_unique<SceneLoader>(options.scene, options.load, options.split)),
      pictures_(screen_.device(), options.settings, options.lens, [this] { announceCompiling(); }),
      lens_(options.lens),
      timeline_({options.load.animation, options.load.at}),
      denoiser_(screen_.device(), [this] { announceCompiling(); }),
      meter_(options.look),
      changes_(options.load),
      guideInset_(screen_.device())
{
    if (options.window) {
        firstSize_.own = options.size;
    }
    pictureSize_ = firstSize_;
    lay(glm::max(glm::uvec2(1), window.pictureSize()));
    if (options.shaders) {
        shaders_.emplace(*options.shaders);
    }
}

void Session::run()
{
    while (!closing_ && (!options_.frames || frames_ < *options_.frames)) {
        const bool isWorking = !pictures_.isEmpty() && work();
        takeEvents(isWorking || movesItself() || pacer_.isChanged() || !inbox_.empty() ? 0.0 : kIdleSeconds);
        takeScene();
        if (shaders_ && !pictures_.isEmpty()) {
            takeShaders();
        }
        takeDropped();
        if (const auto report = writer_.takeReport(false)) {
            tell(*report);
        }
        if (messages_.notice.expire()) {
            pacer_.change();
        }
        step();
        follow();
        if (isPresentDue()) {
            present();
            step();
            follow();
        }
        if (later_ && !hasMoved() && !pictures_.shown().isFresh()) {
            std::exchange(later_, nullptr)();
        }
        if (writes_ && isWhole()) {
            writePictures();
        }
    }
    window_.finish();
    if (writes_) {
        tell("the window was closed before the picture was whole, and nothing is written");
    }
    if (const auto report = writer_.takeReport(true)) {
        tell(*report);
    }
}

// While long work is announced but not done, events wait.
void Session::takeEvents(double seconds)
{
    for (const Event& event : events_.take(seconds)) {
        inbox_.push_back(event);
    }
    while (!inbox_.empty() && !later_) {
        handle(inbox_.front());
        inbox_.pop_front();
        ++handledEvents_;
    }
    if (!pacer_.isChanged()) {
        reportShown();
    }
}

// A scene that is refused, or that needs too much memory, ends the session only if no other scene is loaded. (A lost device fails
// again in the next pass.)
void Session::takeScene()
{
    try {
        if (std::unique_ptr<LoadedScene> loaded = loader_->take()) {
            enter(std::move(loaded));
            messages_.trouble.clear();
        }
    } catch (const std::exception& error) {
        if (pictures_.isEmpty()) {
            throw;
        }
        const bool isMemory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        messages_.trouble = isMemory ? scene_.string() + ": " + memorySentence() : error.what();
        tell(messages_.trouble);
    }
    const std::string stage = dropped_ ? dropped_->stage() : loader_->stage();
    if (stage != messages_.stage) {
        messages_.stage = stage;
        window_.setTitle("glim: " + (stage.empty() ? scene_.filename().string() : stage));
        pacer_.change();
    }
}

// What does not compile changes nothing.
void Session::takeShaders()
{
    if (shaders_->take()) {
        learner_.end();
        try {
            show();
            tell("the kernels of " + options_.shaders->string() + " have changed, and the picture begins anew");
        } catch (const DeviceError& error) {
            shaders_->refuse(error.what());
            show();
        }
        drawer_.renew();
        denoiser_.renew();
        guideInset_.renew();
    }
    if (const std::string& trouble = shaders_->trouble(); trouble != messages_.shaders) {
        messages_.shaders = trouble;
        if (!trouble.empty()) {
            glim::say(MessageId::WindowReport, {trouble});
        }
        pacer_.change();
    }
}

// All that depends on the scene. What may refuse it comes first.
void Session::enter(std::unique_ptr<LoadedScene> loaded)
{
    const PreparedScene& prepared = loaded->prepared;
    checkPicture(prepared, size());
    if (!viewpoint_) {
        const Camera& chosen = findCamera(prepared.scene, options_.camera);
        sayIfCameraIsNumber(prepared.scene, options_.camera);
        applyField(chosen, options_.field);                                        // refuses an angle for an orthographic camera,
        const Camera seen = applyProjection(chosen, options_.projection, size());  // and a K
        if (options_.pose) {
            placeCamera(chosen, *options_.pose, prepared.scene.origin);  // refuses a pose without direction
        }
        viewpoint_.emplace(static_cast<std::size_t>(&chosen - prepared.scene.cameras.data()), options_.pose, options_.field,
                           options_.projection);
        if (!options_.size && options_.window) {
            firstSize_.own = defaultSize(seen);
            pictureSize_ = firstSize_;
            lay(drawer_.windowSize());
        } else if (!options_.size) {
            window_.setSize(glm::round(glm::vec2(defaultSize(seen)) * std::max(1.0F, window_.contentScale())));
        }
    }
    const bool isFirst = pictures_.isEmpty();
    exchange(std::move(loaded));
    maps_ = findMaps(scene_, changes_.options());
    viewpoint_->enter(pictures_.scene().scene);
    timeline_.enter(pictures_.scene().scene.animations);
    if (!isFirst) {
        tell(scene_.string() + " has changed and is loaded again");
    }
    show();
}

void Session::exchange(std::unique_ptr<LoadedScene> loaded)
{
    learner_.end();
    pictures_.enter(std::move(loaded));
    surface_.reset();
    warnIfNoLights(pictures_.scene());
    meter_.enter(pictures_.scene().scene);
}

LoadOptions Session::wantedScene() const
{
    LoadOptions options = changes_.options();
    options.animation = timeline_.moment().animation;
    options.at = timeline_.moment().seconds;
    return options;
}

bool Session::hasLens() const
{
    const Lens wanted = lens_.lens();
    return pictures_.lens().radius == wanted.radius && pictures_.lens().focalDistance == wanted.focalDistance;
}

bool Session::canFocus() const
{
    const Projection::Model model = options_.projection.model;
    return model != Projection::Model::Fisheye && model != Projection::Model::Equirectangular;
}

// One step for each picture.
void Session::step()
{
    if (viewpoint_ && pacer_.isShown()) {
        const Clock::time_point now = Clock::now();
        viewpoint_->fly(now);
        timeline_.advance(now);
    }
}

// Begins the next picture only after the last one was shown. Otherwise a user who moves without rest would see none.
void Session::follow()
{
    if (hasMoved() && pacer_.isShown()) {
        show();
    }
}

// Changes the scene to what is wanted. What is refused is said, and the scene stays as it was.
void Session::followScene()
{
    const LoadOptions wanted = wantedScene();
    if (wanted == pictures_.options()) {
        return;
    }
    learner_.end();
    try {
        pictures_.change(wanted, options_.split);
    } catch (const InputError& error) {
        tell(error.what());
        changes_.giveUp(pictures_.options());
        timeline_.rest({pictures_.options().animation, pictures_.options().at});
        renewSurface();
        return;
    }
    loader_->setOptions(wanted);
    viewpoint_->enter(pictures_.scene().scene);
    renewSurface();
}

// Begins a new picture with the present camera, lens, scene and time.
void Session::show()
{
    learner_.cancel();
    followScene();
    pictures_.setLens(lens_.lens());
    pictures_.show(viewpoint_->camera(size()), size());
    begin();
}

void Session::begin()
{
    viewpoint_->see();
    meter_.restart();
    denoiser_.restart();
    pacer_.begin();
}

// Whether the picture is still to begin anew, by a guide that is learned once the view rests.
bool Session::awaitsGuide() const { return options_.guiding && !pictures_.isGuided() && pictures_.layer() != Aov::BvhSteps; }

// Works on the guide for about a tenth of a second. Returns false if there is nothing to do.
bool Session::learnGuide()
{
    if (hasMoved()) {
        return false;  // show() comes first
    }
    if (const std::shared_ptr<const Guide> guide = learner_.take()) {
        pictures_.guide(guide, viewpoint_->camera(size()), size());
        begin();
        say("guided by " + counted(guide->cells, "cell"));
        return true;
    }
    if (!learner_.isWorking() && awaitsGuide() && !paused_ && pictures_.shown().isAlone()) {
        announceCompiling();
        learner_.begin(pictures_.shown().renderer(), pictures_.scene().flat, pictures_.shown().camera());
        pacer_.change();
    }
    return learner_.advance();
}

bool Session::work()
{
    if (learnGuide()) {
        return true;
    }
    const auto shouldContinue = [this] { return !isInputWaiting(); };
    const bool denoises = denoises_ && options_.settings.halves && pictures_.layer() == Aov::Radiance;
    const bool worked =
        (denoises && denoiser_.work(pictures_.shown(), shouldContinue)) || pictures_.shown().refine(paused_, shouldContinue);
    if (worked) {
        pacer_.change();
    }
    return worked;
}

bool Session::isPresentDue() const
{
    const bool isThere = !pictures_.isEmpty();
    const bool nothingNew = !pacer_.isChanged() && !options_.frames;
    if (nothingNew || (isThere && pictures_.shown().isFresh())) {
        return false;
    }
    return movesItself() || pacer_.isDue(Clock::now(), isThere && pictures_.shown().scale() > 1);
}

void Session::present()
{
    const Clock::time_point start = Clock::now();
    bool isDrawn = true;
    if (!pictures_.isEmpty()) {
        meter_.measure(pictures_.shown(), pictures_.layer(), isInputWaiting());
        Renderer& renderer = pictures_.shown().renderer();
        drawer_.setTransparent(!pictures_.options().environmentBackground || pictures_.settings().catcher);
        const auto shouldContinue = [this] { return !isInputWaiting(); };
        if (meter_.errorLayer().isShown()) {
            isDrawn = drawer_.draw(renderer, meter_.errorLayer(), meter_.look(), shouldContinue);
        } else if (const IdleDenoiser::Result* denoised = shownDenoised()) {
            drawer_.draw(renderer, *denoised, meter_.look());
        } else {
            isDrawn = drawer_.draw(renderer, pictures_.layer(), meter_.range(), meter_.look(), shouldContinue);
        }
    }
    if (showsGuide()) {
        const std::optional<glm::uvec2> pixel = mouse_ ? pixelAt(*mouse_) : std::nullopt;
        guideInset_.look(pictures_.shown(), pictures_.scene(), picker_, pixel, size());
    }
    buildPanels();
    buildPanels();  // ImGui lays out a frame by the sizes of the one before
    const bool isShown = screen_.present(drawer_.picture());
    pacer_.spend(start, Clock::now());
    if (isShown) {
        pacer_.show(hasMoved());
        frames_ += pictures_.isEmpty() ? 0 : 1;
        reportShown();
    }
    if (!isDrawn) {
        pacer_.change();
    }
}

const IdleDenoiser::Result* Session::shownDenoised() const
{
    return denoises_ && !pictures_.isEmpty() && pictures_.layer() == Aov::Radiance ? denoiser_.result() : nullptr;
}

void Session::reportShown()
{
    if (!pictures_.isEmpty() && !hasMoved()) {
        const Refiner& picture = pictures_.shown();
        const bool isLast = !awaitsGuide() && !dropped_;
        window_.reportShown(isLast ? picture.sampleCount() : 0, isLast && picture.scale() == 1 && picture.isDone(), handledEvents_);
    }
}

void Session::say(const std::string& text)
{
    messages_.notice.show(text);
    pacer_.change();
}

void Session::tell(const std::string& text)
{
    glim::say(MessageId::WindowReport, {text});
    say(text);
}

void Session::printSummary() const
{
    const std::string waits = pacer_.latency().describe();
    glim::say(MessageId::WindowReport, {part::value(std::to_string(frames_)), " frames", waits.empty() ? "" : "; " + waits});
}

}  // namespace glim
