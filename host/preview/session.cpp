#include "host/preview/session.hpp"

#include "host/error.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/memory.hpp"
#include "host/message.hpp"
#include "host/preview/pick.hpp"
#include "host/render/check_memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <utility>
#include <vector>

namespace glim {
namespace {

constexpr double kFrameSeconds = 1.0 / 30.0, kMovingFrameSeconds = 1.0 / 60.0;
constexpr double kPresentShare = 0.1;  // the most of the time that presenting may take while nothing moves
constexpr double kIdleSeconds = 0.05;
constexpr double kExposureStep = 0.5;  // stops

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Half the height of the picture at the point that the camera looks at, in metres.
double halfHeightOf(const Camera& camera, const Pose& pose)
{
    if (camera.kind == Camera::Kind::Orthographic) {
        return static_cast<double>(camera.halfHeight);  // includes the zoom
    }
    return std::tan(0.5 * static_cast<double>(camera.yfov)) * glm::length(pose.at - pose.from);
}

}  // namespace

Session::Session(Window& window, EventQueue& events, const PreviewOptions& options)
    : window_(window),
      events_(events),
      options_(options),
      screen_(window, options.device),
      gui_(screen_.gui()),
      display_(screen_.device()),
      loader_(options.scene, options.load, options.split)
{
    look_.exposure = options.look.exposure.value_or(0.0);
    display_.resize(std::max(1U, window.pictureSize().x), std::max(1U, window.pictureSize().y));
}

void Session::run()
{
    while (!closing_ && (!options_.frames || frames_ < *options_.frames)) {
        const bool working = light_ && work();
        const bool idle = !working && heldKeys_.empty() && !changed_ && inbox_.empty();
        takeEvents(idle ? kIdleSeconds : 0.0);
        takeScene();
        if (const auto report = writer_.takeReport(false)) {
            tell(*report);
        }
        changed_ = notice_.expire() || changed_;
        fly();
        followCamera();
        if (isPresentDue()) {
            present();
            followCamera();
        }
        if (later_ && !moved_ && !refiner().isFresh()) {
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
    if (!changed_) {
        reportShown();
    }
}

// A scene that is refused, or that needs too much memory, ends the session only if no other scene is loaded. (A lost device fails
// again in the next pass.)
void Session::takeScene()
{
    try {
        if (std::unique_ptr<PreparedScene> prepared = loader_.take()) {
            enter(std::move(prepared));
            trouble_.clear();
        }
    } catch (const std::exception& error) {
        if (!prepared_) {
            throw;
        }
        const bool isMemory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
        trouble_ = isMemory ? options_.scene.string() + ": " + memorySentence() : error.what();
        tell(trouble_);
    }
    const std::string stage = loader_.stage();
    if (stage != title_) {
        title_ = stage;
        window_.setTitle("glim: " + (stage.empty() ? options_.scene.filename().string() : stage));
        changed_ = true;
    }
}

void Session::enter(std::unique_ptr<PreparedScene> prepared)
{
    RenderSettings settings = options_.settings;
    settings.width = display_.width();
    settings.height = display_.height();
    checkMemory(*prepared, settings, screen_.device().description());
    window_.setTitle("glim: compiling kernels for " + options_.scene.filename().string());
    if (!viewpoint_) {
        const Camera& chosen = findCamera(prepared->scene, options_.camera);
        sayIfCameraIsNumber(prepared->scene, options_.camera);
        if (options_.pose) {
            placeCamera(chosen, *options_.pose, prepared->scene.origin);  // refuses a pose without direction
        }
        viewpoint_.emplace(static_cast<std::size_t>(&chosen - prepared->scene.cameras.data()), options_.pose);
        if (!options_.size) {
            window_.setSize(defaultSize(chosen));
        }
    }
    warnIfNoLights(*prepared);
    look_.tone = options_.look.tone ? *options_.look.tone : chooseTone(prepared->scene);
    auto light = std::make_unique<Refiner>(screen_.device(), *prepared, settings, options_.lens);
    viewpoint_->enter(prepared->scene);
    if (light_) {
        tell(options_.scene.string() + " has changed and is loaded again");
    }
    steps_.reset();  // it uses buffers of light_
    light_ = std::move(light);
    if (aov_ == Aov::BvhSteps) {
        aov_ = Aov::Radiance;
    }
    prepared_ = std::move(prepared);
    window_.setTitle("glim: " + options_.scene.filename().string());
    show();
}

void Session::resize()
{
    const glm::uvec2 size = window_.pictureSize();
    if (size.x == 0 || size.y == 0 || (size.x == display_.width() && size.y == display_.height())) {
        return;
    }
    display_.resize(size.x, size.y);
    if (light_) {
        show();
    }
}

// Moves the camera by half the scene's radius a second while keys are held, one step per picture.
void Session::fly()
{
    if (!shown_) {
        return;
    }
    const double seconds = std::min(0.1, secondsSince(std::exchange(flown_, Clock::now())));
    const auto axis = [this](char more, char less) {
        return (heldKeys_.contains(more) ? 1.0 : 0.0) - (heldKeys_.contains(less) ? 1.0 : 0.0);
    };
    const glm::dvec3 direction(axis('D', 'A'), axis('E', 'Q'), axis('W', 'S'));
    if (viewpoint_ && direction != glm::dvec3(0.0)) {
        viewpoint_->move([&](const Pose& pose) { return ::glim::fly(pose, 0.5 * viewpoint_->bounds().radius * seconds * direction); });
        moved_ = true;
    }
}

// Begins the next picture only after the last one was shown. Otherwise a user who moves without rest would see none.
void Session::followCamera()
{
    if (moved_ && shown_) {
        show();
    }
}

// Begins a new picture with the present camera.
void Session::show()
{
    refiner().show(viewpoint_->camera(), {display_.width(), display_.height()});
    std::move(waiting_.begin(), waiting_.end(), std::back_inserter(underWay_));
    waiting_.clear();
    moved_ = shown_ = false;
    lightIsStale_ = aov_ == Aov::BvhSteps;
    meter_.restart();
    changed_ = true;
}

bool Session::work()
{
    const bool worked = refiner().refine(paused_, [this] { return !isInputWaiting(); });
    changed_ = changed_ || worked;
    return worked;
}

// Presents at once if the user waits for an answer, and otherwise in intervals that leave most of the time to rendering.
bool Session::isPresentDue()
{
    const bool nothingNew = !changed_ && !options_.frames;
    if (nothingNew || (light_ && refiner().isFresh())) {
        return false;
    }
    const bool moving = light_ && refiner().scale() > 1;
    const double interval = moving ? kMovingFrameSeconds : std::max(kFrameSeconds, presentSeconds_ / kPresentShare);
    return !waiting_.empty() || !underWay_.empty() || secondsSince(presented_) >= interval;
}

void Session::present()
{
    const Clock::time_point start = Clock::now();
    if (light_) {
        measure();
        display_.draw(refiner().renderer(), aov_, meter_.range(), look_);
    }
    buildPanels();
    buildPanels();  // ImGui lays out a frame by the sizes of the one before
    const bool shown = screen_.present(display_.picture());
    presented_ = Clock::now();
    presentSeconds_ = std::chrono::duration<double>(presented_ - start).count();
    if (!shown) {
        return;
    }
    changed_ = moved_;
    shown_ = true;
    if (!moved_) {
        std::move(waiting_.begin(), waiting_.end(), std::back_inserter(underWay_));
        waiting_.clear();
    }
    for (const Clock::time_point came : std::exchange(underWay_, {})) {
        latency_.add(std::chrono::duration<double>(presented_ - came).count());
    }
    if (light_) {
        ++frames_;
    }
    reportShown();
}

void Session::reportShown()
{
    if (light_ && !moved_) {
        window_.reportShown(refiner().sampleCount(), refiner().scale() == 1 && refiner().isDone(), handledEvents_);
    }
}

void Session::measure()
{
    const bool exposed = !options_.look.exposure && (aov_ == Aov::Radiance || aov_ == Aov::Albedo);
    if (meter_.measure(refiner(), aov_, exposed, isInputWaiting()) && exposed) {
        look_.exposure = meter_.exposure();
    }
}

void Session::say(const std::string& text)
{
    notice_.show(text);
    changed_ = true;
}

void Session::tell(const std::string& text)
{
    glim::say(text);
    say(text);
}

void Session::handle(const Event& event)
{
    using Kind = Event::Kind;
    switch (event.kind) {
    case Kind::Close: closing_ = true; break;
    case Kind::Resize:
        resize();
        changed_ = true;
        break;
    case Kind::KeyUp: heldKeys_.erase(event.key); break;
    case Kind::FocusLost:
        heldKeys_.clear();
        gestures_.cancel();
        gui_.point(event);
        break;
    case Kind::KeyDown:
        waiting_.push_back(event.when);
        press(event.key);
        changed_ = true;
        break;
    default: handleMouse(event);
    }
}

// The panels take what is theirs. The mouse may move over the picture without any answer.
void Session::handleMouse(const Event& event)
{
    gui_.point(event);
    buildPanels();
    const bool panels = gui_.hasMouse();
    const std::optional<Gesture> gesture = gestures_.take(event, panels);
    if (panels || gesture || mouseIsPanels_) {
        waiting_.push_back(event.when);
        changed_ = true;
    }
    mouseIsPanels_ = panels;
    if (gesture) {
        follow(*gesture);
    }
}

void Session::follow(const Gesture& gesture)
{
    if (gesture.kind == Gesture::Kind::Click) {
        clickAt(gesture.position);
    } else if (viewpoint_) {
        moveBy(gesture);
    }
}

void Session::moveBy(const Gesture& gesture)
{
    const double height = static_cast<double>(display_.height());
    const Camera camera = viewpoint_->camera();
    viewpoint_->move([&](const Pose& pose) {
        switch (gesture.kind) {
        case Gesture::Kind::Orbit: return orbit(pose, gesture.motion, height);
        case Gesture::Kind::Pan: return pan(pose, gesture.motion, 2.0 * halfHeightOf(camera, pose) / height);
        default: return dolly(pose, gesture.notches, camera.kind);
        }
    });
    moved_ = true;
}

void Session::press(char key)
{
    if (key == kEscape) {
        closing_ = true;
    } else if (key == 'H') {
        panelLevel_ = (panelLevel_ + 1) % 3;
    } else if (key == '+' || key == '-') {
        setExposure(look_.exposure + (key == '+' ? kExposureStep : -kExposureStep));
    } else if (key == 'T') {
        setTone(static_cast<Tone>((static_cast<std::uint32_t>(look_.tone) + 1) % 3));
    } else if (key == ' ') {
        paused_ = !paused_;
    } else if (viewpoint_ && std::string("WASDQE").find(key) != std::string::npos) {
        heldKeys_.insert(key);
    } else if (viewpoint_) {
        pressForScene(key);
    }
}

void Session::pressForScene(char key)
{
    if (key == 'F') {
        const double aspect = static_cast<double>(display_.width()) / static_cast<double>(display_.height());
        viewpoint_->move([&](const Pose& pose) { return frame(pose, viewpoint_->bounds(), viewpoint_->fileCamera(), aspect); });
        moved_ = true;
    } else if (key == 'R') {
        viewpoint_->reset();
        moved_ = true;
    } else if (key >= '1' && key <= '9') {
        chooseCamera(static_cast<std::size_t>(key - '1'));
    } else if (key == 'V') {
        const std::vector<Aov> order = layers();
        const auto at = std::find(order.begin(), order.end(), aov_);
        chooseLayer(at + 1 == order.end() ? order.front() : at[1]);
    } else if (key == 'P') {
        say("writing the picture");
        if (isWhole()) {
            later_ = [this] { writePictures(); };
        } else {
            writes_ = true;
        }
    } else if (key == 'C') {
        printCamera();
    }
}

void Session::chooseCamera(std::size_t index)
{
    if (viewpoint_->choose(index)) {
        moved_ = true;
    } else {
        say("The file has no camera " + std::to_string(index + 1) + ".");
    }
}

void Session::setExposure(double exposure)
{
    look_.exposure = exposure;
    options_.look.exposure = exposure;  // no longer chosen by the film
}

// Keeps the tone when the scene is loaded again.
void Session::setTone(Tone tone)
{
    look_.tone = tone;
    options_.look.tone = tone;
}

// What V steps through. Without a BVH it has no steps.
std::vector<Aov> Session::layers() const
{
    std::vector<Aov> layers = {Aov::Radiance, Aov::Normal, Aov::Depth, Aov::Albedo, Aov::SampleCount};
    if (options_.settings.course.accelerator != Accelerator::None) {
        layers.push_back(Aov::BvhSteps);
    }
    return layers;
}

// BVH steps need a film of their own.
void Session::chooseLayer(Aov aov)
{
    if (aov == Aov::BvhSteps && !steps_) {
        say("compiling kernels that count BVH steps");
        later_ = [this] {
            RenderSettings settings = options_.settings;
            settings.aov = Aov::BvhSteps;
            settings.bounces = 0;
            settings.adaptive = Adaptive::Off;
            steps_ = std::make_unique<Refiner>(*light_, *prepared_, settings);
            showAov(Aov::BvhSteps);
        };
    } else {
        showAov(aov);
    }
}

void Session::showAov(Aov aov)
{
    const bool stale = lightIsStale_ || moved_, leaves = aov_ == Aov::BvhSteps;
    aov_ = aov;
    if (aov == Aov::BvhSteps) {
        show();
        lightIsStale_ = stale;
    } else if (leaves && stale) {
        show();
    }
    meter_.renew();
}

void Session::buildPanels()
{
    const PanelChoices before{look_.exposure, look_.tone, aov_, viewpoint_ ? viewpoint_->index() : 0};
    PanelChoices wanted = before;
    gui_.frame({display_.width(), display_.height()}, [&] {
        if (light_ && panelLevel_ > 0) {
            wanted = showControls(figures(), before);
        }
        if (panelLevel_ > 1) {
            showHelp();
        }
        if (!light_ || panelLevel_ > 0) {
            showMessages(messages());
        }
    });
    if (wanted.exposure != before.exposure) {
        setExposure(wanted.exposure);
    }
    if (wanted.tone != before.tone) {
        setTone(wanted.tone);
    }
    if (wanted.layer != before.layer) {
        chooseLayer(wanted.layer);
    }
    if (wanted.camera != before.camera) {
        chooseCamera(wanted.camera);
    }
}

PanelFigures Session::figures() const
{
    Refiner& picture = refiner();
    PanelFigures figures;
    figures.samples = picture.renderer().sampleCount();
    figures.seconds = picture.seconds();
    figures.samplesPerSecond = picture.samplesPerSecond();
    figures.state = paused_ ? "paused" : picture.isDone() && picture.scale() == 1 ? "done" : "";
    figures.errors = meter_.errors();
    figures.size = {display_.width(), display_.height()};
    figures.scale = picture.scale();
    figures.device = screen_.device().description().name;
    figures.layers = layers();
    for (const Camera& camera : viewpoint_->cameras()) {
        figures.cameras.push_back(camera.name);
    }
    return figures;
}

// Of the scene that is being loaded, of one that is refused, and the last notice.
std::vector<std::string> Session::messages() const
{
    std::vector<std::string> lines;
    for (const std::string& line : {title_, trouble_, notice_.text()}) {
        if (!line.empty() && std::find(lines.begin(), lines.end(), line) == lines.end()) {
            lines.push_back(line);
        }
    }
    return lines;
}

void Session::clickAt(const glm::dvec2& position)
{
    if (!light_) {
        return;
    }
    const glm::uvec2 size(display_.width(), display_.height());
    const glm::uvec2 pixel(glm::clamp(position, glm::dvec2(0.0), glm::dvec2(size - 1U)));
    const std::string there = describeSurface(refiner(), *prepared_, pixel, size);
    std::cout << "pixel (" << pixel.x << ", " << pixel.y << ") of " << size.x << "x" << size.y << ": " << there
              << describeSamples(refiner(), pixel, aov_) << std::endl;
    say(there);
}

void Session::printCamera()
{
    const std::string options = "--camera " + std::to_string(viewpoint_->index()) + cameraOptions(viewpoint_->moved(), options_.lens) +
                                " --size " + std::to_string(display_.width()) + "x" + std::to_string(display_.height());
    std::cout << options << '\n' << viewpoint_->describeAsGltf() << std::endl;
    say(options);
}

void Session::writePictures()
{
    Film film = refiner().renderer().film();
    film.sceneFile = options_.scene.string();
    film.identity.settings += describeCamera(viewpoint_->moved(), options_.lens);
    if (const auto report = writer_.takeReport(true)) {
        tell(*report);
    }
    writes_ = false;
    if (!options_.look.exposure) {
        look_.exposure = chooseExposure(film, aov_);
    }
    writer_.write(options_.scene, std::move(film), aov_, look_);
}

void Session::printSummary() const
{
    const std::string waits = latency_.describe();
    glim::say(std::to_string(frames_) + " frames" + (waits.empty() ? "" : "; " + waits));
}

}  // namespace glim
