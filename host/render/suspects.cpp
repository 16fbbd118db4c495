#include "host/render/suspects.hpp"

#include "host/render/replay.hpp"
#include "shaders/shared/luminance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

struct Brightest {
    float luminance;
    std::uint32_t pixel, sampleIndex;
};

// NaN where float32 does not hold the whole.
double shareOf(double part, double whole) { return std::isfinite(whole) ? part / whole : std::numeric_limits<double>::quiet_NaN(); }

// The `count` pixels with the brightest samples, none of them black.
std::vector<Brightest> findBrightest(const Renderer& renderer, std::size_t count)
{
    std::vector<Brightest> found;
    for (const auto& tile : renderer.films().tiles()) {
        const std::vector<BrightestSample> samples = download<BrightestSample>(tile->brightest(), tile->count());
        for (std::uint32_t i = 0; i < tile->count(); ++i) {
            if (samples[i].luminance > 0.0F) {
                found.push_back({samples[i].luminance, tile->begin() + i, samples[i].sampleIndex});
            }
        }
    }
    const auto last = found.begin() + static_cast<std::ptrdiff_t>(std::min(count, found.size()));
    std::partial_sort(found.begin(), last, found.end(), [](const Brightest& a, const Brightest& b) {
        return a.luminance != b.luminance ? a.luminance > b.luminance : a.pixel < b.pixel;
    });
    found.erase(last, found.end());
    return found;
}

}  // namespace

std::vector<Suspect> findSuspects(Renderer& renderer, const Film& film)
{
    if (renderer.settings().suspects == 0) {
        return {};
    }
    double picture = 0.0;
    for (const PixelMoments& pixel : shownPixels(film)) {
        picture += computeLuminance(pixel.mean);
    }
    std::vector<Suspect> suspects;
    for (const Brightest& each : findBrightest(renderer, renderer.settings().suspects)) {
        const PixelMoments pixel = shownPixel(film, each.pixel);
        const PathRadiance path = traceSample(renderer.resources(), each.pixel, each.sampleIndex);
        const double luminance = computeLuminance(path.radiance), part = luminance / pixel.count;
        suspects.push_back(
            {each.pixel, each.sampleIndex, path.radiance, luminance, shareOf(part, computeLuminance(pixel.mean)), shareOf(part, picture)});
    }
    return suspects;
}

}  // namespace glim
