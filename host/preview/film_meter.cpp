#include "host/preview/film_meter.hpp"

#include "host/measure/compare_images.hpp"
#include "host/measure/picture.hpp"
#include "host/render/film_pictures.hpp"
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

bool FilmMeter::measure(Refiner& refiner, Aov aov, bool choosesExposure, bool isWaiting)
{
    const std::uint32_t samples = refiner.sampleCount();
    const bool ranged = aov == Aov::Depth || aov == Aov::SampleCount || aov == Aov::BvhSteps;
    const bool first = (ranged || choosesExposure) && measuredAov_ != aov;
    if (!first && (samples < 1 || samples < kGrowth * static_cast<double>(measuredAt_) || isWaiting)) {
        return false;
    }
    if (!ranged && !choosesExposure && samples < leastSamplesForError(0)) {
        return false;
    }
    const Film film = refiner.renderer().film();
    measuredAt_ = samples;
    measuredAov_ = aov;
    range_ = computeRange(film, aov);
    if (choosesExposure) {
        exposure_ = chooseExposure(film, aov);
    }
    if (aov == Aov::SampleCount) {
        range_.high = std::max(range_.high, 2.0F * range_.low);  // the scale should not show the present sweep alone
    }
    if (const auto errors = estimateErrors(pictureOf(film)); errors && errors->relMse > 0.0 && aov != Aov::BvhSteps) {
        errors_.push_back({refiner.seconds(), errors->relMse});
    }
    return true;
}

}  // namespace glim
