#include "host/render/light_passes.hpp"

#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {

LightPasses::LightPasses(const FlatScene& scene, const RenderSettings& settings)
    : size_(scene, settings),
      scale_(splatScale(scene))
{}

void LightPasses::begin(Wavefront& wavefront, const RenderSettings& settings)
{
    paths_ = lightPathCount(settings.width, settings.height);
    firstPixel_ = settings.firstPixel();
    pixelCount_ = settings.pixelCount();
    splats_ = wavefront.makeSplatBuffer(SplatBuffer::countFor(settings));
    sums_.emplace(pixelCount_, scale_);
    sample_ = settings.sampleBegin;
}

void LightPasses::resume(std::uint32_t finishedSample, std::vector<SplatMoments> page)
{
    sample_ = finishedSample;
    if (!page.empty()) {
        sums_->setPage(std::move(page));
    }
}

std::optional<PassSeconds> LightPasses::trace(Wavefront& wavefront, std::uint32_t end, const std::function<bool()>& shouldContinue)
{
    const std::uint32_t block = blockSamples(sample_);
    const std::uint32_t most = std::min(end, (sample_ / block + 1) * block) - sample_;
    const std::uint32_t samples = std::clamp(size_.paths() / paths_, 1U, most), all = samples * paths_;
    PassSeconds seconds{0.0, 0.0};
    std::vector<Splat> found;
    for (std::uint32_t pixel = 0; pixel < pixelCount_; pixel += splats_->count()) {
        splats_->clear();
        for (std::uint32_t first = 0; first < all;) {
            const std::uint32_t count = std::min(all - first, size_.paths());
            const auto traced = wavefront.traceLight(*splats_, firstPixel_ + pixel, sample_, first, count, shouldContinue);
            if (!traced) {
                return std::nullopt;
            }
            seconds = {std::max(seconds.longest, traced->longest), seconds.total + traced->total};
            size_.learn(count, *traced);
            first += count;
        }
        const std::vector<Splat> band = splats_->read(std::min(splats_->count(), pixelCount_ - pixel));
        found.insert(found.end(), band.begin(), band.end());
    }
    sums_->add(found, sample_, samples);
    sample_ += samples;
    return seconds;
}

}  // namespace glim
