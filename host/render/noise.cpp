#include "host/render/noise.hpp"

#include "shaders/shared/limits.h"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

constexpr double kNoisePixels = 1024.0;
constexpr std::uint32_t kNoisePatch = 4;  // pixels a side, over which radiance is averaged
constexpr double kPassSeconds = 0.1;
constexpr std::uint32_t kFirstSample = 0xC0000000U;

RenderSettings measuringSettings(const RenderSettings& settings)
{
    RenderSettings small = pilotSettings(settings, pilotSizeAtMost(settings, kNoisePixels));
    small.sampleBegin = kFirstSample;
    small.sampleEnd = kFirstSample + 2 * kBlockSamples;
    small.passSeconds = kPassSeconds;
    small.uncheckedSeconds = 0.0;  // no pass is in flight while others use the device
    return small;
}

double relativeVarianceOf(const Film& film, std::uint32_t width)
{
    struct NoisePatch {
        double pixels = 0.0, radiance = 0.0, variance = 0.0;
    };
    const std::uint32_t columns = (width + kNoisePatch - 1) / kNoisePatch;
    std::vector<NoisePatch> patches(film.pixels.size() / width * columns);
    double sum = 0.0;
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        const glm::dvec3 mean(film.pixels[i].mean), squares(film.pixels[i].squares);
        NoisePatch& patch = patches[i / width / kNoisePatch * columns + i % width / kNoisePatch];
        patch.pixels += 1.0;
        patch.radiance += (mean.r + mean.g + mean.b) / 3.0;
        patch.variance += (squares.r + squares.g + squares.b) / 3.0 / std::max(1.0, film.pixels[i].blocks - 1.0);
        sum += (mean.r + mean.g + mean.b) / 3.0;
    }
    // A tenth of the picture's mean: where it is black, errors are not seen.
    const double floor = 0.1 * sum / static_cast<double>(film.pixels.size());
    double deviation = 0.0;
    for (const NoisePatch& patch : patches) {
        if (sum > 0.0 && patch.pixels > 0.0) {
            const double radiance = patch.radiance / patch.pixels;
            deviation += patch.pixels * std::sqrt(patch.variance / patch.pixels / (radiance * radiance + floor * floor));
        }
    }
    deviation /= static_cast<double>(film.pixels.size());
    return deviation * deviation;
}

}  // namespace

NoiseMeter::NoiseMeter(const Renderer& base, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : base_(base),
      scene_(scene),
      camera_(camera),
      settings_(measuringSettings(settings))
{}

std::optional<Noise> NoiseMeter::measure(std::shared_ptr<const Guide> guide, const std::function<bool()>& shouldContinue)
{
    settings_.guide = std::move(guide);
    auto renderer = std::make_unique<Renderer>(guided_ ? *guided_ : base_, scene_, camera_, settings_);
    renderer->clearStatistics();  // those of all who share its resources
    while (renderer->advance()) {
        if (!shouldContinue()) {
            return std::nullopt;
        }
    }
    const Film film = renderer->film();
    const RenderStatistics& statistics = renderer->statistics();
    const Noise noise{
        relativeVarianceOf(film, settings_.width),
        static_cast<double>(statistics.cameraAndBounceRays + statistics.shadowRays) / static_cast<double>(statistics.samples)};
    if (settings_.guide) {
        guided_ = std::move(renderer);
    }
    return noise;
}

}  // namespace glim
