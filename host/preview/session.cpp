#include "host/preview/session.hpp"

#include "host/error.hpp"
#include "host/measure/compare_images.hpp"
#include "host/measure/picture.hpp"
#include "host/render/check_memory.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <iterator>
#include <thread>
#include <utility>

namespace glim {
namespace {

constexpr double kFrameSeconds = 1.0 / 30.0, kMovingFrameSeconds = 1.0 / 60.0;
constexpr double kPresentShare = 0.1;   // of the time, at most, that goes into presenting while nothing moves
constexpr double kIdleSeconds = 0.05;

double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

Session::Session(Window& window, EventQueue& events, const PreviewOptions& options)
    : window_(window), events_(events), options_(options), instance_(Window::instanceExtensions()),
      surface_(instance_, window.createSurface(instance_)), device_(instance_, options.device, surface_.handle()),
      swapchain_(device_, surface_.handle()), display_(device_), loader_(options.scene, options.load, options.split)
{
    display_.resize(std::max(1U, window.pictureSize().x), std::max(1U, window.pictureSize().y));
}

void Session::run()
{
    while (!closing_ && (!options_.frames || frames_ < *options_.frames)) {
        const bool working = light_ && work();
        const bool idle = !working && held_.empty() && !changed_ && inbox_.empty();
        takeEvents(idle ? kIdleSeconds : 0.0);
        takeScene();
        if (const auto report = writer_.takeReport(false)) {
            tell(*report);
        }
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

// What takes longer than a picture is done after one that says so, and the events that follow wait for it.
void Session::takeEvents(double seconds)
{
    for (const Event& event : events_.take(seconds)) {
        inbox_.push_back(event);
    }
    while (!inbox_.empty() && !later_) {
        handle(inbox_.front());
        inbox_.pop_front();
        ++handled_;
        changed_ = true;
    }
}

// A scene that is refused, or too much for the memory, ends the session only if there is none to go on with. (A device that is lost
// says so again.)
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
        trouble_ = isMemory ? options_.scene.string() + ": out of memory" : error.what();
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
    refuseWhatDoesNotFit(*prepared, settings, device_.description());
    window_.setTitle("glim: compiling kernels for " + options_.scene.filename().string());
    if (!viewpoint_) {
        const Camera& chosen = findCamera(prepared->scene, options_.camera);
        if (options_.pose) {
            placeCamera(chosen, *options_.pose, prepared->scene.origin);  // refuses what gives no direction
        }
        viewpoint_.emplace(static_cast<std::size_t>(&chosen - prepared->scene.cameras.data()), options_.pose);
        if (!options_.size) {
            window_.setSize(naturalSize(chosen));
        }
    }
    warnOfDarkness(*prepared);
    auto light = std::make_unique<Refiner>(device_, *prepared, settings, options_.lens);
    viewpoint_->enter(prepared->scene);
    if (light_) {
        tell(options_.scene.string() + " has changed and is loaded again");
    }
    steps_.reset();  // it has borrowed from light_
    light_ = std::move(light);
    if (look_ == Look::Steps) {
        look_ = Look::Radiance;
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
    changed_ = true;
}

// While keys are held, from picture to picture: half the scene's radius a second.
void Session::fly()
{
    if (!shown_) {
        return;
    }
    const double seconds = std::min(0.1, secondsSince(std::exchange(flown_, Clock::now())));
    const auto axis = [this](char more, char less) { return static_cast<double>(held_.count(more)) - static_cast<double>(held_.count(less)); };
    const glm::dvec3 way(axis('D', 'A'), axis('E', 'Q'), axis('W', 'S'));
    if (viewpoint_ && way != glm::dvec3(0.0)) {
        viewpoint_->move([&](const Pose& pose) { return ::glim::fly(pose, 0.5 * viewpoint_->bounds().radius * seconds * way); });
        moved_ = true;
    }
}

// However often the camera moves, each picture is shown before the next is begun: a hand that never rests would see none otherwise.
void Session::followCamera()
{
    if (moved_ && shown_) {
        show();
    }
}

// Begins the picture from where the camera is now.
void Session::show()
{
    refiner().show(viewpoint_->camera(), {display_.width(), display_.height()});
    std::move(waiting_.begin(), waiting_.end(), std::back_inserter(underWay_));
    waiting_.clear();
    moved_ = shown_ = false;
    lightIsStale_ = look_ == Look::Steps;
    estimatedAt_ = 0;
    relMse_.reset();
    changed_ = true;
}

bool Session::work()
{
    const bool worked = refiner().refine(paused_, [this] { return !isAsked(); });
    changed_ = changed_ || worked;
    return worked;
}

// At once where the user waits; else often enough to look alive, and seldom enough to leave the time to rendering.
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
        display_.draw(refiner().renderer(), look_, range_, options_.exposure);
    }
    const auto dotPixels = static_cast<std::uint32_t>(std::max(1.0F, std::round(window_.contentScale())));
    display_.cover(drawText(overlay(), dotPixels, display_.width()));
    const glm::uvec2 size = window_.pictureSize();
    const bool shown = swapchain_.present(display_.shown(), size.x, size.y);
    presented_ = Clock::now();
    presentSeconds_ = std::chrono::duration<double>(presented_ - start).count();
    if (!shown) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));  // no hurry: the window is changing, or not to be seen
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
    if (light_ && !moved_) {
        window_.reportShown(refiner().sampleCount(), refiner().scale() == 1 && refiner().isDone(), handled_);
    }
}

// Whatever takes a look at the whole film, as often as its samples double.
void Session::measure()
{
    const std::uint32_t samples = refiner().sampleCount();
    const bool ranged = look_ == Look::Depth || look_ == Look::Rate || look_ == Look::Steps;
    const bool first = ranged && measuredLook_ != look_;
    if (!first && (samples < 1 || samples < 2 * estimatedAt_ || isAsked())) {
        return;
    }
    if (!ranged && samples < leastSamplesForError(0)) {
        return;
    }
    const Film film = refiner().renderer().film();
    estimatedAt_ = samples;
    measuredLook_ = look_;
    range_ = computeRange(film, look_);
    if (look_ == Look::Rate) {
        range_.high = std::max(range_.high, 2.0F * range_.low);  // or a sweep under way would be all the scale shows
    }
    if (const auto errors = estimateErrors(pictureOf(film)); errors && look_ != Look::Steps) {
        relMse_ = errors->relMse;
    }
}

void Session::printSummary() const
{
    std::fprintf(stderr, "glim: %llu frames", static_cast<unsigned long long>(frames_));
    if (latency_.count() > 0) {
        std::fprintf(stderr, "; %zu inputs, each in a picture after %.0f ms (median), %.0f ms (99 %%), %.0f ms (longest)",
                     latency_.count(), 1e3 * latency_.quantile(0.5), 1e3 * latency_.quantile(0.99), 1e3 * latency_.quantile(1.0));
    }
    std::fprintf(stderr, "\n");
}

}  // namespace glim
