// The user's input: what keys and the mouse do.
#include "host/flatten/camera_options.hpp"
#include "host/preview/edits_writer.hpp"
#include "host/preview/session.hpp"
#include "host/text.hpp"
#include "host/window/widgets.hpp"

#include <algorithm>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glim {
namespace {

constexpr double kExposureStep = 0.5;  // stops

}  // namespace

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

}  // namespace glim
