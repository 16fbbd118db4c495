#include "host/render/aov.hpp"

#include "shaders/shared/display_colors.h"
#include "shaders/shared/display_types.h"
#include "shaders/shared/tone_mapping.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glim {
namespace {

static_assert(static_cast<std::uint32_t>(Aov::Radiance) == kAovRadiance && static_cast<std::uint32_t>(Aov::Normal) == kAovNormal);
static_assert(static_cast<std::uint32_t>(Aov::Depth) == kAovDepth && static_cast<std::uint32_t>(Aov::Albedo) == kAovAlbedo);
static_assert(static_cast<std::uint32_t>(Aov::SampleCount) == kAovSampleCount && static_cast<std::uint32_t>(Aov::BvhSteps) == kAovBvhSteps);
static_assert(static_cast<std::uint32_t>(Aov::Guide) == kAovGuide);
static_assert(static_cast<std::uint32_t>(Tone::None) == kToneNone && static_cast<std::uint32_t>(Tone::Neutral) == kToneNeutral &&
              static_cast<std::uint32_t>(Tone::Agx) == kToneAgx);

bool isFinite(const glm::vec3& value) { return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z); }

Rgb8 srgb(const glm::vec3& linear, const Look& look)
{
    const double scale = std::exp2(look.exposure);
    const glm::dvec3 shown = look.tone == Tone::None
                                 ? scale * glm::dvec3(linear)
                                 : glm::dvec3(mapTone(static_cast<float>(scale) * linear, static_cast<std::uint32_t>(look.tone)));
    return {srgbByte(shown.r), srgbByte(shown.g), srgbByte(shown.b)};
}

// The value that `aov` shows of a pixel; nothing if it has none.
std::optional<float> valueOf(const PixelMoments& pixel, Aov aov)
{
    const bool there = aov == Aov::SampleCount || (isFinite(pixel.mean) && (aov == Aov::BvhSteps || pixel.alpha > 0.0F));
    if (!there) {
        return {};
    }
    return aov == Aov::SampleCount ? static_cast<float>(pixel.count) : aov == Aov::BvhSteps ? pixel.mean.r : pixel.depth;
}

// The direction's colour is full where the guide chooses among 1/64 of all directions.
constexpr float kMostGuideBits = 6.0F;

Rgb8 guideColor(const glm::vec3& mean, float alpha)
{
    const float length = glm::length(mean);
    if (!(length > 0.0F)) {
        return {};
    }
    return roundToBytes(std::clamp(std::log2(length / alpha) / kMostGuideBits, 0.0F, 1.0F) * vectorColor(mean / length));
}

}  // namespace

const char* getName(Tone tone)
{
    constexpr const char* kNames[] = {"none", "neutral", "agx"};
    return kNames[static_cast<std::size_t>(tone)];
}

DisplayRange computeRange(const Film& film, Aov aov)
{
    if (aov != Aov::Depth && aov != Aov::SampleCount && aov != Aov::BvhSteps) {
        return {};
    }
    std::vector<float> values;
    for (const PixelMoments& pixel : film.pixels) {
        if (const std::optional<float> value = valueOf(pixel, aov)) {
            values.push_back(*value);
        }
    }
    if (values.empty()) {
        return {};
    }
    if (aov == Aov::BvhSteps) {
        // A few rays take by far the most steps.
        const auto most = values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), most, values.end());
        return {0.0F, *most};
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return {*least, *most};
}

Rgb8 displayColor(const PixelMoments& pixel, Aov aov, const DisplayRange& range, const Look& look)
{
    if (!isFinite(pixel.mean)) {
        return kMagenta;
    }
    const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
    switch (aov) {
    case Aov::Normal: return pixel.alpha > 0.0F ? roundToBytes(vectorColor(pixel.normal / pixel.alpha)) : Rgb8{};
    case Aov::Depth: return pixel.alpha > 0.0F ? roundToBytes(depthColor(pixel.depth, range.low, range.high)) : Rgb8{};
    case Aov::Albedo: return srgb(pixel.albedo, {look.exposure, Tone::None});
    case Aov::SampleCount: return roundToBytes(heatColor(placeOnScale(pixel.count, low, high, 1.0)));
    case Aov::BvhSteps: return roundToBytes(heatColor(placeOnScale(static_cast<double>(pixel.mean.r), low, high, kSmallestScale)));
    case Aov::Guide: return guideColor(pixel.mean, pixel.alpha);
    case Aov::Radiance: break;
    }
    return srgb(pixel.mean,
                {look.exposure, static_cast<Tone>(toneOfPixel(pixel.mean, pixel.albedo, static_cast<std::uint32_t>(look.tone)))});
}

Rgba8 displaySurfaces(const PixelMoments& pixel, Aov aov, const DisplayRange& range, const Look& look)
{
    if (!isFinite(pixel.mean)) {
        return {kMagenta[0], kMagenta[1], kMagenta[2], 255};
    }
    const auto alpha = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(pixel.alpha, 0.0F, 1.0F)));
    if (alpha == 0) {
        return {};
    }
    PixelMoments surfaces = pixel;
    surfaces.mean /= pixel.alpha;
    surfaces.albedo /= pixel.alpha;
    const Rgb8 color = displayColor(surfaces, aov, range, look);
    return {color[0], color[1], color[2], alpha};
}

}  // namespace glim
