#include "host/preview/film_meter.hpp"

#include "host/measure/compare_images.hpp"
#include "host/measure/picture.hpp"
#include "host/render/robust_radiance.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {

void FilmMeter::restart()
{
    errors_.clear();
    errorLayer_.restart();
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
    const std::uint32_t samples = refiner.windowSampleCount();
    const bool isExposed = !options_.exposure && (aov == Aov::Radiance || aov == Aov::Albedo);
    const bool isRanged = aov == Aov::Depth || aov == Aov::SampleCount || aov == Aov::BvhSteps;
    const bool isFirst = (isRanged || isExposed) && measuredAov_ != aov;
    const double growth = errors_.empty() ? kUsualGrowth : growthToNext(errors_.back(), errorLayer_.target());
    const bool isLast = refiner.isDone() && samples > measuredAt_;
    if (!isFirst && (samples < 1 || (samples < growth * static_cast<double>(measuredAt_) && !isLast) || isWaiting)) {
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
    if (refiner.scale() > 1 || aov == Aov::BvhSteps) {
        return;
    }
    const Picture picture = makePicture(film);
    const std::vector<glm::dvec3> likely = robustRadiance(picture.width, picture.height, picture.radiance, picture.variance);
    if (const auto errors = estimateErrors(picture, likely); errors && errors->relMse > 0.0) {
        const bool isWhole = std::ranges::all_of(film.pixels, [](const PixelMoments& pixel) { return pixel.blocks >= 2; });
        errors_.push_back({refiner.seconds(), errors->relMse, refiner.renderer().plan().pictureSamples(), isWhole});
        errorLayer_.take(picture, likely);
    }
}

}  // namespace glim
