#include "host/preview/refiner.hpp"

#include "host/flatten/flatten_scene.hpp"

#include <utility>

namespace glim {
namespace {

// Measured (README.md): passes of a fifth of this length made a render 2.5 times as long, since each takes many small dispatches.
// Input waits only for kPortion dispatches; with eight of them it waited 50 ms longer.
constexpr double kPassSeconds = 0.1;
constexpr std::uint32_t kPortion = 2;
constexpr double kUncheckedSeconds = 0.02;
constexpr double kMovingSeconds = 0.03;  // aim for a coarse picture: input, picture and presenting stay below 100 ms together
// Time after the last move until the halves are kept that a denoiser needs, until a guide is learned, and until a picture is started that
// has more pixels than the window: its film alone takes seconds to make ready.
constexpr double kAloneSeconds = 1.0;
constexpr double kStillSeconds = 0.15;  // time after the last move until the full size is started, or as much as the window shows

RenderSettings startingSettings(RenderSettings settings)
{
    settings.width = settings.height = 1;
    settings.passSeconds = kPassSeconds;
    settings.portion = kPortion;
    settings.uncheckedSeconds = kUncheckedSeconds;
    return settings;
}

}  // namespace

Refiner::Refiner(Device& device, const PreparedScene& prepared, const RenderSettings& settings, const Lens& lens)
    : settings_(settings),
      prepared_(prepared),
      lens_(lens),
      camera_(flattenCamera(prepared, prepared.scene.cameras.front(), 1.0F, lens)),
      renderer_(device, prepared.flat, camera_, startingSettings(settings))
{}

Refiner::Refiner(const Refiner& other, const PreparedScene& prepared, const RenderSettings& settings)
    : settings_(settings),
      prepared_(prepared),
      lens_(other.lens_),
      camera_(other.camera_),
      renderer_(other.renderer_, prepared.flat, camera_, startingSettings(settings))
{}

FlatCamera Refiner::flatten(const Camera& camera, const glm::uvec2& size) const
{
    return flattenCamera(prepared_, camera, static_cast<float>(size.x) / static_cast<float>(size.y), lens_);
}

bool Refiner::needsKernels(const Camera& camera, const glm::uvec2& size) const
{
    return !renderer_.resources().hasKernels(prepared_.flat, flatten(camera, size));
}

void Refiner::renew() { renderer_.restart(prepared_.flat, camera_, 1, 1); }

// `seconds` is what a coarse picture at movingScale_ took. A picture of twice the resolution takes up to four times as long.
void Refiner::chooseMovingScale(double seconds)
{
    if (seconds > kMovingSeconds && movingScale_ < kCoarsest) {
        movingScale_ *= 2;
    } else if (4.0 * seconds < kMovingSeconds && movingScale_ > 1) {
        movingScale_ /= 2;
    }
}

void Refiner::aim(const Camera& camera, const glm::uvec2& size)
{
    size_ = size;
    camera_ = flatten(camera, size);
    moved_ = Clock::now();
}

void Refiner::show(const Camera& camera, const glm::uvec2& size)
{
    aim(camera, size);
    begin(movingScale_ * windowScale_, true);
}

void Refiner::showWhole(const Camera& camera, const glm::uvec2& size)
{
    aim(camera, size);
    begin(1, false);
}

// The scale to go on with: first as many pixels as the window shows, and then all.
std::uint32_t Refiner::nextScale() const
{
    const double rested = secondsBetween(moved_, Clock::now());
    if (fresh_ || rested < kStillSeconds) {
        return scale_;
    }
    if (scale_ > windowScale_) {
        return windowScale_;
    }
    const bool isWhole = renderer_.plan().sampleCount() > 0;
    return isWhole && (windowScale_ == 1 || rested > kAloneSeconds) ? 1 : scale_;
}

void Refiner::begin(std::uint32_t scale, bool fresh)
{
    scale_ = scale;
    fresh_ = fresh;
    const glm::uvec2 film = (size_ + scale - 1U) / scale;
    renderer_.adapt(prepared_.flat, camera_);
    renderer_.restart(camera_, film.x, film.y);
    seconds_ = 0.0;
}

void Refiner::advance(const std::function<bool()>& shouldContinue)
{
    const std::uint64_t before = renderer_.plan().pictureSamples();
    const Clock::time_point start = Clock::now();
    const bool whole = renderer_.advance(shouldContinue);
    const double spent = secondsBetween(start, Clock::now());
    seconds_ += spent;
    if (whole) {
        const double now = static_cast<double>(renderer_.plan().pictureSamples() - before) / spent;
        speed_ = speed_ == 0.0 ? now : 0.8 * speed_ + 0.2 * now;
    }
}

bool Refiner::refine(bool paused, const std::function<bool()>& shouldContinue)
{
    if (const std::uint32_t next = nextScale(); next < scale_) {
        begin(next, false);
    }
    const bool whole = renderer_.plan().sampleCount() > 0;
    if (isDone() || (whole && paused)) {
        return scale_ > 1;  // the full size comes next
    }
    // The first picture is always completed. Otherwise a user who moves without rest would see none.
    do {
        advance(fresh_ ? nullptr : shouldContinue);
    } while (fresh_ && renderer_.plan().sampleCount() == 0);
    if (std::exchange(fresh_, false)) {
        chooseMovingScale(seconds_);
    }
    return true;
}

bool Refiner::isAlone() const { return scale_ == 1 && !fresh_ && secondsBetween(moved_, Clock::now()) > kAloneSeconds; }

bool Refiner::keepHalves()
{
    if (!isAlone()) {
        return false;
    }
    renderer_.keepHalves();
    return true;
}

bool Refiner::isDone() const { return renderer_.plan().isDone() || (settings_.seconds && scale_ == 1 && seconds() >= *settings_.seconds); }

}  // namespace glim
