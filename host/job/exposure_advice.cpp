#include "host/job/exposure_advice.hpp"

#include "shaders/shared/luminance.h"
#include "shaders/shared/tone_mapping.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace glim {
namespace {

constexpr double kBurntShare = 0.2;  // of the pixels, clipped in all channels
constexpr double kDarkMean = 0.01;   // of the luminance

// The exposure shows the luminance that 5 % of the pixels exceed as .9. So at most 5 % are clipped in all channels, and the mean is at
// least .05 * .8: the advice needs no further advice.
constexpr double kExceeding = 0.05, kShownAs = 0.9;

std::vector<glm::dvec3> findShown(const Film& film)
{
    std::vector<glm::dvec3> surfaces, all;
    for (const PixelMoments& pixel : shownPixels(film)) {
        const glm::dvec3 mean(pixel.mean);
        if (pixel.count > 0 && std::isfinite(mean.r + mean.g + mean.b)) {
            all.push_back(mean);
            if (pixel.alpha >= 0.5F) {
                surfaces.push_back(mean);
            }
        }
    }
    return surfaces.empty() ? all : surfaces;
}

// Clipped in all channels. A tone clips nothing, so there it is white as bytes are.
bool isWhite(const glm::dvec3& light, Tone tone)
{
    if (tone == Tone::None) {
        return std::min({light.r, light.g, light.b}) > 1.0;
    }
    const glm::vec3 shown = mapTone(glm::vec3(light), static_cast<std::uint32_t>(tone));
    return srgbByte(static_cast<double>(std::min({shown.r, shown.g, shown.b}))) == 255;
}

}  // namespace

std::optional<Message> adviseExposure(const Film& film, const Look& look)
{
    const std::vector<glm::dvec3> shown = findShown(film);
    if (shown.empty()) {
        return std::nullopt;
    }
    const double scale = std::exp2(look.exposure), count = static_cast<double>(shown.size());
    std::vector<double> luminances;
    double sum = 0.0, clipped = 0.0;
    for (const glm::dvec3& c : shown) {
        luminances.push_back(computeLuminance(c));
        sum += luminances.back();
        clipped += isWhite(scale * c, look.tone) ? 1.0 : 0.0;
    }
    const bool burnt = clipped > kBurntShare * count, dark = sum * scale < kDarkMean * count;
    if (!burnt && !dark) {
        return std::nullopt;
    }
    if (sum == 0.0) {
        return Message(MessageId::ExposureAdvised, {"is black: no light reaches what it shows"});
    }
    const auto place = luminances.begin() + static_cast<std::ptrdiff_t>((1.0 - kExceeding) * (count - 1.0));
    std::nth_element(luminances.begin(), place, luminances.end());
    char share[32], stops[32];
    std::snprintf(share, sizeof share, burnt ? "%.0f %%" : "%.2g %%", burnt ? 100.0 * clipped / count : 100.0 * sum * scale / count);
    if (!(*place > 0.0)) {  // a few lights in the dark
        return Message(MessageId::ExposureAdvised, {"is almost black: its mean is ", part::value(share), " of white; ",
                                                    part::expected("--environment studio"), " lights it"});
    }
    const double advice = std::clamp(std::floor(10.0 * std::log2(kShownAs / *place)) / 10.0, -100.0, 100.0);
    std::snprintf(stops, sizeof stops, "%.1f", advice);
    return Message(MessageId::ExposureAdvised, {burnt ? "is burnt out: " : "is almost black: its mean is ", part::value(share),
                                                burnt ? " of what it shows is white; " : " of white; ", part::place("--exposure"), " ",
                                                part::expected(stops), " shows it"});
}

}  // namespace glim
