#include "host/preview/film_meter.hpp"

#include "host/measure/compare_images.hpp"
#include "host/measure/picture.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {
namespace {

constexpr double kGrowth = 1.25;  // of the samples, from one measurement to the next

}  // namespace

void FilmMeter::restart()
{
    errors_.clear();
    renew();
}

void FilmMeter::expose(const Film& film, Aov aov)
{
    if (!options_.exposure) {
        look_.exposure = chooseExposure(film, aov);
    }
}

void FilmMeter::measure(Refiner& refiner, Aov aov, bool isWaiting)
{
    const std::uint32_t samples = refiner.sampleCount();
    const bool isExposed = !options_.exposure && (aov == Aov::Radiance || aov == Aov::Albedo);
    const bool isRanged = aov == Aov::Depth || aov == Aov::SampleCount || aov == Aov::BvhSteps;
    const bool isFirst = (isRanged || isExposed) && measuredAov_ != aov;
    if (!isFirst && (samples < 1 || samples < kGrowth * static_cast<double>(measuredAt_) || isWaiting)) {
        return;
    }
    if (!isRanged && !isExposed && samples < minSamplesForError(0)) {
        return;
    }
    const Film film = refiner.renderer().film();
    measuredAt_ = samples;
    measuredAov_ = aov;
    range_ = computeRange(film, aov);
    if (isExposed) {
        expose(film, aov);
    }
    if (aov == Aov::SampleCount) {
        range_.high = std::max(range_.high, 2.0F * range_.low);  // the scale should not show the present sweep alone
    }
    if (const auto errors = estimateErrors(makePicture(film)); errors && errors->relMse > 0.0 && aov != Aov::BvhSteps) {
        errors_.push_back({refiner.seconds(), errors->relMse});
    }
}

}  // namespace glim
