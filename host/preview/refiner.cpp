#include "host/preview/refiner.hpp"

#include "host/flatten/flatten_scene.hpp"

#include <utility>

namespace glim {
namespace {

// A pass pays: with a fifth of this, two spheres took 2.5 times as long, for the many small dispatches. Input waits only for the
// dispatches under way: of eight, 50 ms more.
constexpr double kPassSeconds = 0.1;
constexpr std::uint32_t kPortion = 2;
constexpr double kMovingSeconds = 0.03;  // for a coarse picture: with pass, drawing and presenting it makes less than 100 ms
constexpr double kStillSeconds = 0.15;   // after the last move the picture is refined

double secondsBetween(std::chrono::steady_clock::time_point begin, std::chrono::steady_clock::time_point end)
{
    return std::chrono::duration<double>(end - begin).count();
}

RenderSettings startingSettings(RenderSettings settings)
{
    settings.width = settings.height = 1;
    settings.passSeconds = kPassSeconds;
    settings.portion = kPortion;
    return settings;
}

}  // namespace

Refiner::Refiner(Device& device, const PreparedScene& prepared, const RenderSettings& settings, const Lens& lens)
    : settings_(settings), lens_(lens), camera_(flattenCamera(prepared.scene.cameras.front(), 1.0F, lens)),
      renderer_(device, prepared.flat, camera_, startingSettings(settings))
{
}

Refiner::Refiner(const Refiner& lender, const PreparedScene& prepared, const RenderSettings& settings)
    : settings_(settings), lens_(lender.lens_), camera_(lender.camera_),
      renderer_(lender.renderer_, prepared.flat, camera_, startingSettings(settings))
{
}

// After a first picture at movingScale_ has taken so long; a finer one would take up to four times that.
void Refiner::chooseMovingScale(double seconds)
{
    if (seconds > kMovingSeconds && movingScale_ < kCoarsest) {
        movingScale_ *= 2;
    } else if (4.0 * seconds < kMovingSeconds && movingScale_ > 1) {
        movingScale_ /= 2;
    }
}

void Refiner::show(const Camera& camera, const glm::uvec2& size)
{
    size_ = size;
    camera_ = flattenCamera(camera, static_cast<float>(size.x) / static_cast<float>(size.y), lens_);
    moved_ = Clock::now();
    begin(movingScale_, true);
}

void Refiner::begin(std::uint32_t scale, bool fresh)
{
    scale_ = scale;
    fresh_ = fresh;
    const glm::uvec2 film = (size_ + scale - 1U) / scale;
    renderer_.restart(camera_, film.x, film.y);
    seconds_ = 0.0;
}

void Refiner::advance(const std::function<bool()>& goesOn)
{
    const std::uint64_t before = renderer_.pictureSamples();
    const Clock::time_point start = Clock::now();
    const bool whole = renderer_.advance(goesOn);
    const double spent = secondsBetween(start, Clock::now());
    seconds_ += spent;
    if (whole) {
        const double now = static_cast<double>(renderer_.pictureSamples() - before) / spent;
        speed_ = speed_ == 0.0 ? now : 0.8 * speed_ + 0.2 * now;
    }
}

bool Refiner::refine(bool paused, const std::function<bool()>& goesOn)
{
    if (scale_ > 1 && !fresh_ && secondsBetween(moved_, Clock::now()) > kStillSeconds) {
        begin(1, false);
    }
    const bool whole = renderer_.sampleCount() > 0;
    if (isDone() || (whole && paused)) {
        return scale_ > 1;  // will be refined soon
    }
    // The first picture is always made whole, or a hand that never rests would see none.
    do {
        advance(fresh_ ? nullptr : goesOn);
    } while (fresh_ && renderer_.sampleCount() == 0);
    if (std::exchange(fresh_, false)) {
        chooseMovingScale(seconds_);
    }
    return true;
}

bool Refiner::isDone() const { return renderer_.isDone() || (settings_.seconds && scale_ == 1 && seconds() >= *settings_.seconds); }

}  // namespace glim
