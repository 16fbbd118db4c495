#include "host/render/aov.hpp"

#include "host/image/heat_color.hpp"
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
static_assert(static_cast<std::uint32_t>(Tone::None) == kToneNone && static_cast<std::uint32_t>(Tone::Neutral) == kToneNeutral &&
              static_cast<std::uint32_t>(Tone::Agx) == kToneAgx);

bool isFinite(const glm::vec3& value) { return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z); }

std::uint8_t plainByte(float value) { return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F))); }

Rgb8 srgb(const glm::vec3& linear, const Look& look)
{
    const double scale = std::exp2(look.exposure);
    const glm::dvec3 shown = look.tone == Tone::None
                                 ? scale * glm::dvec3(linear)
                                 : glm::dvec3(mapTone(static_cast<float>(scale) * linear, static_cast<std::uint32_t>(look.tone)));
    return {srgbByte(shown.r), srgbByte(shown.g), srgbByte(shown.b)};
}

Rgb8 normalColor(const PixelMoments& pixel)
{
    const glm::vec3 color = 0.5F + 0.5F * pixel.normal / pixel.alpha;
    return pixel.alpha > 0.0F ? Rgb8{plainByte(color.r), plainByte(color.g), plainByte(color.b)} : Rgb8{};
}

// A number's place on its scale.
double place(float value, const DisplayRange& range, double atLeast)
{
    const double low = static_cast<double>(range.low);
    return (static_cast<double>(value) - low) / std::max(atLeast, static_cast<double>(range.high) - low);
}

Rgb8 depthColor(const PixelMoments& pixel, const DisplayRange& range)
{
    if (!(pixel.alpha > 0.0F)) {
        return {};
    }
    const double share = std::clamp(place(pixel.depth, range, 1e-30), 0.0, 1.0);
    const std::uint8_t grey = plainByte(static_cast<float>(std::lerp(1.0, static_cast<double>(kFarthestGrey), share)));
    return {grey, grey, grey};
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

}  // namespace

const char* nameOf(Tone tone)
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
    switch (aov) {
    case Aov::Normal: return normalColor(pixel);
    case Aov::Depth: return depthColor(pixel, range);
    case Aov::Albedo: return srgb(pixel.albedo, {look.exposure, Tone::None});
    case Aov::SampleCount: return heatColor(place(static_cast<float>(pixel.count), range, 1.0));
    case Aov::BvhSteps: return heatColor(place(pixel.mean.r, range, 1e-30));
    case Aov::Radiance: break;
    }
    return srgb(pixel.mean, look);
}

}  // namespace glim
