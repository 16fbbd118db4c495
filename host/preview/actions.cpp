// What the user does, done.
#include "host/flatten/view_options.hpp"
#include "host/preview/pick.hpp"
#include "host/preview/session.hpp"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <utility>

namespace glim {
namespace {

constexpr double kExposureStep = 0.5;  // stops

double slopeOf(const Camera& camera, const Pose& pose)
{
    if (camera.kind == Camera::Kind::Orthographic) {
        return static_cast<double>(camera.halfHeight);  // of the placed camera, zoom and all
    }
    return std::tan(0.5 * static_cast<double>(camera.yfov)) * glm::length(pose.at - pose.from);
}

}  // namespace

void Session::say(const std::string& text)
{
    notice_ = text;
    noticeTime_ = Clock::now();
    changed_ = true;
}

void Session::tell(const std::string& text)
{
    std::cerr << "glim: " << text << '\n';
    say(text);
}

void Session::handle(const Event& event)
{
    using Kind = Event::Kind;
    if (event.kind == Kind::Close) {
        closing_ = true;
        return;
    }
    if (event.kind == Kind::Resize) {
        resize();
        return;
    }
    if (event.kind == Kind::KeyUp) {
        held_.erase(event.key);
        return;
    }
    waiting_.push_back(event.when);
    changed_ = true;
    if (event.kind == Kind::KeyDown) {
        press(event.key);
    } else if (event.kind == Kind::Click) {
        clickAt(event.position);
    } else if (viewpoint_) {
        moveBy(event);
    }
}

void Session::moveBy(const Event& event)
{
    const double height = static_cast<double>(display_.height());
    const Camera camera = viewpoint_->camera();
    viewpoint_->move([&](const Pose& pose) {
        switch (event.kind) {
        case Event::Kind::Orbit: return orbit(pose, event.amount, height);
        case Event::Kind::Pan: return pan(pose, event.amount, 2.0 * slopeOf(camera, pose) / height);
        default: return dolly(pose, event.amount.y, camera.kind);
        }
    });
    moved_ = true;
}

void Session::press(char key)
{
    if (key == kEscape) {
        closing_ = true;
    } else if (key == 'H') {
        overlayLevel_ = (overlayLevel_ + 1) % 3;
    } else if (key == '+' || key == '-') {
        options_.exposure += key == '+' ? kExposureStep : -kExposureStep;
    } else if (key == ' ') {
        paused_ = !paused_;
    } else if (viewpoint_ && std::string("WASDQE").find(key) != std::string::npos) {
        held_.insert(key);
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
        if (viewpoint_->choose(static_cast<std::size_t>(key - '1'))) {
            moved_ = true;
        } else {
            say(std::string("The file has no camera ") + key + ".");
        }
    } else if (key == 'V') {
        cycleLook();
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

// Node visits are another film's; without a BVH there are none.
void Session::cycleLook()
{
    const bool visits = options_.settings.accelerator != Accelerator::None;
    const Look last = visits ? Look::Steps : Look::Rate;
    const Look next = look_ == last ? Look::Radiance : static_cast<Look>(static_cast<int>(look_) + 1);
    if (next == Look::Steps && !steps_) {
        say("compiling kernels that count");
        later_ = [this] {
            RenderSettings settings = options_.settings;
            settings.view = View::BvhSteps;
            settings.bounces = 0;
            settings.adaptive = Adaptive::Off;
            steps_ = std::make_unique<Refiner>(*light_, *prepared_, settings);
            lookAt(Look::Steps);
        };
    } else {
        lookAt(next);
    }
}

void Session::lookAt(Look look)
{
    const bool stale = lightIsStale_ || moved_, leaves = look_ == Look::Steps;
    look_ = look;
    if (look == Look::Steps) {
        show();
        lightIsStale_ = stale;
    } else if (leaves && stale) {
        show();
    }
    estimatedAt_ = 0;
}

void Session::clickAt(const glm::dvec2& position)
{
    if (!light_) {
        return;
    }
    const glm::uvec2 size(display_.width(), display_.height());
    const glm::uvec2 pixel(glm::clamp(position, glm::dvec2(0.0), glm::dvec2(size - 1U)));
    std::string there = "nothing";
    if (const std::optional<Pick> found = pick(refiner().renderer(), *prepared_, refiner().camera(), pixel, size)) {
        char place[200];
        std::snprintf(place, sizeof place, ", at (%.6g, %.6g, %.6g), %.6g m away", found->position.x, found->position.y,
                      found->position.z, found->distance);
        there = textOf(found->primitive) + ", material " + found->primitive.material + place;
    }
    std::cout << "pixel (" << pixel.x << ", " << pixel.y << ") of " << size.x << "x" << size.y << ": " << there
              << describeSamples(pixel) << std::endl;
    say(there);
}

// As in "; 64 samples, mean (1, 1, 1) W/(sr m^2), standard error (.1, .1, .1)".
std::string Session::describeSamples(const glm::uvec2& pixel)
{
    const RenderSettings& film = refiner().renderer().settings();
    const glm::uvec2 place = pixel / refiner().scale();
    const PixelMoments moments = refiner().renderer().moments(place.y * film.width + place.x);
    const glm::vec3 error = glm::sqrt(varianceOfMean(moments));
    char text[300];
    std::snprintf(text, sizeof text, "; %u sample%s, mean (%.6g, %.6g, %.6g)%s", moments.count, moments.count == 1 ? "" : "s",
                  static_cast<double>(moments.mean.r), static_cast<double>(moments.mean.g), static_cast<double>(moments.mean.b),
                  look_ == Look::Steps ? " node visits and primitive tests" : " W/(sr m^2)");
    std::string known = text;
    if (refiner().scale() > 1) {
        known += " in a picture of 1/" + std::to_string(refiner().scale()) + " size";
    }
    if (moments.blocks < 2) {
        return known + ", standard error known from 33 samples on";
    }
    std::snprintf(text, sizeof text, ", standard error (%.2g, %.2g, %.2g)", static_cast<double>(error.r),
                  static_cast<double>(error.g), static_cast<double>(error.b));
    return known + text;
}

void Session::printCamera()
{
    const std::string options = "--camera " + std::to_string(viewpoint_->index()) + viewOptions(viewpoint_->moved(), options_.lens) +
                                " --size " + std::to_string(display_.width()) + "x" + std::to_string(display_.height());
    std::cout << options << '\n' << viewpoint_->describeAsGltf() << std::endl;
    say(options);
}

void Session::writePictures()
{
    Film film = refiner().renderer().film();
    film.sceneFile = options_.scene.string();
    film.identity.settings += describeView(viewpoint_->moved(), options_.lens);
    if (const auto report = writer_.takeReport(true)) {
        tell(*report);
    }
    writes_ = false;
    writer_.write(options_.scene, std::move(film), look_, options_.exposure);
}

}  // namespace glim
