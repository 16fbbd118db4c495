#include "host/render/look.hpp"

#include "host/image/heat_color.hpp"
#include "shaders/shared/display_types.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glim {
namespace {

static_assert(static_cast<std::uint32_t>(Look::Radiance) == kLookRadiance && static_cast<std::uint32_t>(Look::Normal) == kLookNormal);
static_assert(static_cast<std::uint32_t>(Look::Depth) == kLookDepth && static_cast<std::uint32_t>(Look::Albedo) == kLookAlbedo);
static_assert(static_cast<std::uint32_t>(Look::Rate) == kLookRate && static_cast<std::uint32_t>(Look::Steps) == kLookSteps);

bool isFinite(const glm::vec3& value) { return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z); }

std::uint8_t plainByte(float value) { return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F))); }

Rgb8 srgb(const glm::vec3& linear, double exposure)
{
    const glm::dvec3 scaled = std::exp2(exposure) * glm::dvec3(linear);
    return {srgbByte(scaled.r), srgbByte(scaled.g), srgbByte(scaled.b)};
}

Rgb8 normalColor(const PixelMoments& pixel)
{
    const glm::vec3 color = 0.5F + 0.5F * pixel.normal / pixel.alpha;
    return pixel.alpha > 0.0F ? Rgb8{plainByte(color.r), plainByte(color.g), plainByte(color.b)} : Rgb8{};
}

// A number's place on its scale.
double place(float value, const LookRange& range, double atLeast)
{
    const double low = static_cast<double>(range.low);
    return (static_cast<double>(value) - low) / std::max(atLeast, static_cast<double>(range.high) - low);
}

Rgb8 depthColor(const PixelMoments& pixel, const LookRange& range)
{
    if (!(pixel.alpha > 0.0F)) {
        return {};
    }
    const double share = std::clamp(place(pixel.depth, range, 1e-30), 0.0, 1.0);
    const std::uint8_t grey = plainByte(static_cast<float>(std::lerp(1.0, static_cast<double>(kFarthestGrey), share)));
    return {grey, grey, grey};
}

// What `look` measures of a pixel; nothing where there is nothing.
std::optional<float> valueOf(const PixelMoments& pixel, Look look)
{
    const bool there = look == Look::Rate || (isFinite(pixel.mean) && (look == Look::Steps || pixel.alpha > 0.0F));
    if (!there) {
        return {};
    }
    return look == Look::Rate ? static_cast<float>(pixel.count) : look == Look::Steps ? pixel.mean.r : pixel.depth;
}

}  // namespace

LookRange computeRange(const Film& film, Look look)
{
    if (look != Look::Depth && look != Look::Rate && look != Look::Steps) {
        return {};
    }
    std::vector<float> values;
    for (const PixelMoments& pixel : film.pixels) {
        if (const std::optional<float> value = valueOf(pixel, look)) {
            values.push_back(*value);
        }
    }
    if (values.empty()) {
        return {};
    }
    if (look == Look::Steps) {
        // Few rays take by far the most steps.
        const auto most = values.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), most, values.end());
        return {0.0F, *most};
    }
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return {*least, *most};
}

Rgb8 lookAt(const PixelMoments& pixel, Look look, const LookRange& range, double exposure)
{
    if (!isFinite(pixel.mean)) {
        return kMagenta;
    }
    switch (look) {
    case Look::Normal: return normalColor(pixel);
    case Look::Depth: return depthColor(pixel, range);
    case Look::Albedo: return srgb(pixel.albedo, exposure);
    case Look::Rate: return heatColor(place(static_cast<float>(pixel.count), range, 1.0));
    case Look::Steps: return heatColor(place(pixel.mean.r, range, 1e-30));
    case Look::Radiance: break;
    }
    return srgb(pixel.mean, exposure);
}

}  // namespace glim
