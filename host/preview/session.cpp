#include "host/preview/session.hpp"

#include "host/error.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"
#include "host/preview/edits_writer.hpp"
#include "host/preview/pick.hpp"
#include "host/text.hpp"
#include "host/window/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <utility>
#include <vector>

namespace glim {
namespace {

constexpr double kIdleSeconds = 0.05;
constexpr double kExposureStep = 0.5;  // stops

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

void Session::handle(const Event& event)
{
    using Kind = Event::Kind;
    switch (event.kind) {
    case Kind::Close: closing_ = true; break;
    case Kind::Resize:
        screen_.takeScale();
        resize();
        pacer_.change();
        break;
    case Kind::Drop: drop(event.file); break;
    case Kind::KeyUp:
        if (viewpoint_) {
            viewpoint_->release(event.key);
        }
        break;
    case Kind::FocusLost:
        if (viewpoint_) {
            viewpoint_->releaseAll();
        }
        gestures_.cancel();
        screen_.gui().point(event);
        break;
    case Kind::KeyDown:
        ++action_;
        pacer_.await(event.when);
        press(event.key);
        break;
    default: handleMouse(event);
    }
}

// The panels take what is theirs. The mouse may move over the picture without any answer, unless it asks the guide.
void Session::handleMouse(const Event& event)
{
    action_ += event.kind == Event::Kind::ButtonDown ? 1 : 0;
    screen_.gui().point(event);
    buildPanels();
    const bool panels = screen_.gui().hasMouse();
    std::optional<Gesture> gesture = gestures_.take(event, panels);
    if (gesture) {
        gesture->motion /= drawer_.viewport().zoom;
    }
    if (!panels) {
        mouse_ = event.position;
    }
    if (panels || gesture || mouseIsPanels_ || (showsGuide() && pictures_.isGuided())) {
        pacer_.await(event.when);
    }
    mouseIsPanels_ = panels;
    if (gesture && gesture->kind == Gesture::Kind::Click) {
        clickAt(gesture->position);
    } else if (gesture && dragsSun_ && gesture->kind == Gesture::Kind::Orbit) {
        LoadOptions options = changes_.options();
        options.sun = dragSun(*options.sun, gesture->motion, static_cast<double>(size().y));
        changes_.change(options, action_);
    } else if (gesture && viewpoint_) {
        viewpoint_->follow(*gesture, static_cast<double>(size().y));
    }
}

void Session::press(char key)
{
    if (key == kEscape) {
        closing_ = true;
    } else if (key == 'H') {
        panelLevel_ = (panelLevel_ + 1) % 3;
    } else if (key == '+' || key == '-') {
        meter_.setExposure(meter_.look().exposure + (key == '+' ? kExposureStep : -kExposureStep));
    } else if (key == 'T') {
        meter_.setTone(static_cast<Tone>((static_cast<std::uint32_t>(meter_.look().tone) + 1) % 3));
    } else if (key == 'N') {
        denoises_ = !denoises_;
    } else if (key == 'G') {
        toggleGuide();
    } else if (key == ' ') {
        paused_ = !paused_;
    } else if (viewpoint_) {
        pressForScene(key);
    }
}

void Session::pressForScene(char key)
{
    if (viewpoint_->press(key, static_cast<double>(size().x) / static_cast<double>(size().y))) {
        return;
    }
    if (key >= '1' && key <= '9') {
        chooseCamera(static_cast<std::size_t>(key - '1'));
    } else if (key == 'V') {
        const std::vector<WindowLayer> order = layers();
        const auto at = std::find(order.begin(), order.end(), layer());
        chooseLayer(at + 1 == order.end() ? order.front() : at[1]);
    } else if (key == 'P') {
        timeline_.rest(timeline_.moment());
        say("writing the picture");
        if (isWhole()) {
            later_ = [this] { writePictures(); };
        } else {
            writes_ = true;
        }
    } else if (key == 'C') {
        printOptions();
    } else if (key == 'J') {
        tell(writeEdits(scene_, listShownOptions(shown())));
    } else if (key == 'K') {
        play();
    } else if (key == 'O') {
        aimFocus();
    } else if (key == 'Z') {
        undo();
    }
}

void Session::toggleGuide()
{
    if (options_.guiding) {
        showsGuide_ = !showsGuide_;
    } else {
        say("There is no guide without --guiding on.");
    }
}

void Session::play()
{
    if (timeline_.isEmpty()) {
        say("The file has no animation.");
    } else {
        timeline_.toggle(Clock::now());
    }
}

// The next click focuses, or no longer.
void Session::aimFocus()
{
    if (canFocus()) {
        lens_.setFocusesByClick(!lens_.choices().focusesByClick);
        say(lens_.choices().focusesByClick ? "A click focuses on what is there." : "");
    } else {
        say("A fisheye and 360 degrees have no lens.");
    }
}

void Session::focusOn(const std::optional<Pick>& found)
{
    if (!found) {
        say("Nothing is there to focus on.");
        return;
    }
    lens_.setFocusesByClick(false);
    lens_.focus(found->depth);
    say("in focus: " + format("%.6g m", found->depth) + (lens_.choices().radius > 0.0F ? "" : "; the aperture is a pinhole still"));
}

// What the controls show of the surface that was clicked, in the scene that has changed. It may be gone, or have another variant's
// material.
void Session::renewSurface()
{
    if (!surface_) {
        return;
    }
    const Scene& scene = pictures_.scene().scene;
    const bool isThere = std::ranges::any_of(scene.instances, [this](const MeshInstance& i) { return i.node == surface_->node; }) ||
                         std::ranges::any_of(scene.spheres, [this](const Sphere& sphere) { return sphere.node == surface_->node; });
    if (!isThere || surface_->material >= scene.materials.size()) {
        surface_.reset();
    } else {
        surface_->choices = choicesOf(*surface_, scene, pictures_.file());
    }
}

void Session::undo()
{
    if (changes_.count() == 0) {
        say("There is nothing to undo.");
    } else {
        changes_.undo();
    }
}

void Session::chooseLayer(const WindowLayer& layer)
{
    meter_.errorLayer().show(layer.isError);
    if (pictures_.choose(layer.aov, viewpoint_->camera(size()), size(), hasMoved())) {
        begin();
    }
    meter_.renew();
}

void Session::chooseCamera(std::size_t index)
{
    if (!viewpoint_->choose(index)) {
        say("The file has no camera " + std::to_string(index + 1) + ".");
    }
}

void Session::clickAt(const glm::dvec2& position)
{
    const std::optional<glm::uvec2> under = pixelAt(position);
    if (pictures_.isEmpty() || !under) {
        return;
    }
    const glm::uvec2 pixel = *under;
    const std::optional<Pick> found = picker_.pick(pictures_.shown(), pictures_.scene(), pixel, size());
    if (lens_.choices().focusesByClick) {
        focusOn(found);
        return;
    }
    const std::string there = describeSurface(found);
    surface_.reset();
    if (found) {
        surface_ = chooseSurface(found->primitive, pictures_.scene().scene, pictures_.file());
    }
    std::cout << "pixel (" << pixel.x << ", " << pixel.y << ") of " << size().x << "x" << size().y << ": " << there
              << describeSamples(pictures_.shown(), pixel, pictures_.layer()) << std::endl;
    say(there);
}

// What the film is of that P writes.
ShownPicture Session::shown() const
{
    LoadOptions load = changes_.options();
    const Moment moment = timeline_.shown();
    load.at = moment.seconds;
    load.animation = moment.animation;
    const bool isFramed = load.framed && viewpoint_->index() + 1 == viewpoint_->cameras().size();
    return {load,
            isFramed ? "framed" : std::to_string(viewpoint_->index()),
            viewpoint_->moved(),
            viewpoint_->field(),
            lens_.lens(),
            options_.projection,
            size(),
            meter_.options()};
}

void Session::printOptions()
{
    const std::string options = toCommandLine(listShownOptions(shown()));
    std::cout << options << '\n' << viewpoint_->describeAsGltf() << std::endl;
    say(options);
}

void Session::writePictures()
{
    Film film = pictures_.shown().renderer().film();
    film.sceneFile = scene_.string();
    film.showsBackground = changes_.options().environmentBackground && film.catcher.empty();
    film.identity.settings += describeCamera(viewpoint_->moved(), viewpoint_->field(), lens_.lens(), options_.projection);
    if (shaders_) {
        shaders_->label(film.identity);
    }
    if (const auto report = writer_.takeReport(true)) {
        tell(*report);
    }
    writes_ = false;
    meter_.expose(film, pictures_.layer());
    const IdleDenoiser::Result* denoised = shownDenoised();
    writer_.write(scene_, std::move(film), pictures_.layer(), meter_.look(), denoised ? std::optional(denoised->picture) : std::nullopt);
}

void Session::printSummary() const
{
    const std::string waits = pacer_.latency().describe();
    glim::say(MessageId::WindowReport, {part::value(std::to_string(frames_)), " frames", waits.empty() ? "" : "; " + waits});
}

}  // namespace glim
