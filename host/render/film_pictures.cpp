#include "host/render/film_pictures.hpp"

#include "host/image/picture_file.hpp"
#include "host/message.hpp"
#include "host/render/composite.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/luminance.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace glim {
namespace {

template <class Color>
std::vector<Color> draw(const Film& film, Aov aov, const Look& look,
                        Color (*display)(const PixelMoments&, Aov, const DisplayRange&, const Look&))
{
    const DisplayRange range = computeRange(film, aov);
    std::vector<Color> colors;
    for (const PixelMoments& pixel : aov == Aov::Radiance ? pictureOf(film) : shownPixels(film)) {
        colors.push_back(display(pixel, aov, range, look));
    }
    return colors;
}

}  // namespace

Aov getAov(const Film& film)
{
    const std::map<std::string, Aov> aovs = {
        {"normal", Aov::Normal}, {"depth", Aov::Depth}, {"albedo", Aov::Albedo}, {"bvh-steps", Aov::BvhSteps}, {"guide", Aov::Guide}};
    const auto found = aovs.find(findSetting(film.identity.settings, "view"));
    return found == aovs.end() ? Aov::Radiance : found->second;
}

bool showsSurfaces(Aov aov) { return aov != Aov::SampleCount && aov != Aov::BvhSteps && aov != Aov::Guide; }

void writeFilmPicture(const std::filesystem::path& path, const Film& film, Aov aov, const Look& look)
{
    const std::optional<PictureKind> kind = getPictureKind(path);
    if (film.showsBackground || !showsSurfaces(aov)) {
        writePicture(path, film.width, film.height, draw(film, aov, look, displayColor));
    } else if (!kind || hasAlpha(*kind)) {
        writePicture(path, film.width, film.height, draw(film, aov, look, displaySurfaces));
    } else {
        writePicture(path, film.width, film.height, draw(film, aov, look, displayColor));
        if (std::ranges::any_of(film.pixels, [](const PixelMoments& pixel) { return pixel.alpha < 1.0F; })) {
            say(MessageId::AlphaLost, {part::file(path), " is a JPEG, which has no alpha, so its background is black; ",
                                       part::expected("a PNG or WebP"), " is transparent there"});
        }
    }
}

double chooseExposure(const Film& film, Aov aov)
{
    std::vector<glm::vec3> pixels;
    for (const PixelMoments& pixel : shownPixels(film)) {
        if (pixel.count > 0) {
            pixels.push_back(aov == Aov::Albedo ? pixel.albedo : pixel.mean);
        }
    }
    return chooseExposure(pixels);
}

double chooseExposure(const std::vector<glm::vec3>& pixels)
{
    constexpr double kKey = 0.18, kMax = 100.0;
    double sum = 0.0, count = 0.0;
    for (const glm::vec3& pixel : pixels) {
        const double luminance = computeLuminance(glm::dvec3(pixel));
        if (luminance > 0.0 && std::isfinite(luminance)) {
            sum += std::log2(luminance);
            count += 1.0;
        }
    }
    const double stops = count > 0.0 ? std::log2(kKey) - sum / count : 0.0;
    return std::clamp(std::round(100.0 * stops) / 100.0 + 0.0, -kMax, kMax);  // + 0 makes 0 of -0
}

Tone chooseTone(const Scene& scene)
{
    if (!scene.environment || scene.environment->source != "studio") {
        return Tone::None;
    }
    say(MessageId::ToneChosen, {"the built-in studio lights the scene, so ", part::place("--tone"), " is ", part::value("neutral")});
    return Tone::Neutral;
}

}  // namespace glim
