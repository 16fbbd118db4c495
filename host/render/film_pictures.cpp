#include "host/render/film_pictures.hpp"

#include "host/image/heat_color.hpp"
#include "host/render/settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr float kFarthest = 0.125F;  // of depth: above the black of what is not there

bool isFinite(const glm::vec3& value) { return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z); }

// Calls shade(pixel) wherever the mean is finite.
template <class Shade>
std::vector<Rgb8> shadePixels(const Film& film, Shade shade)
{
    std::vector<Rgb8> colors(film.pixels.size(), kMagenta);
    std::transform(film.pixels.begin(), film.pixels.end(), colors.begin(), [&](const PixelMoments& pixel) {
        return isFinite(pixel.mean) ? shade(pixel) : kMagenta;
    });
    return colors;
}

std::uint8_t plainByte(float value) { return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F))); }

Image imageOf(const Film& film)
{
    Image image{film.width, film.height, {}, {}, {}};
    for (const PixelMoments& pixel : film.pixels) {
        image.channels["R"].push_back(pixel.mean.r);
        image.channels["G"].push_back(pixel.mean.g);
        image.channels["B"].push_back(pixel.mean.b);
    }
    return image;
}

std::vector<Rgb8> shadeNormals(const Film& film)
{
    return shadePixels(film, [](const PixelMoments& pixel) {
        const glm::vec3 color = 0.5F + 0.5F * pixel.mean / pixel.alpha;
        return pixel.alpha > 0.0F ? Rgb8{plainByte(color.r), plainByte(color.g), plainByte(color.b)} : Rgb8{};
    });
}

// Of the surfaces in a pixel alone: what missed has added 0 to the mean.
float depthOf(const PixelMoments& pixel) { return pixel.mean.r / pixel.alpha; }

std::vector<Rgb8> shadeDepths(const Film& film)
{
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0.0F;
    for (const PixelMoments& pixel : film.pixels) {
        if (pixel.alpha > 0.0F && std::isfinite(pixel.mean.r)) {
            nearest = std::min(nearest, depthOf(pixel));
            farthest = std::max(farthest, depthOf(pixel));
        }
    }
    return shadePixels(film, [=](const PixelMoments& pixel) {
        if (!(pixel.alpha > 0.0F)) {
            return Rgb8{};
        }
        const float share = farthest > nearest ? (depthOf(pixel) - nearest) / (farthest - nearest) : 0.0F;
        const std::uint8_t grey = plainByte(std::lerp(1.0F, kFarthest, share));
        return Rgb8{grey, grey, grey};
    });
}

std::vector<Rgb8> shadeSteps(const Film& film)
{
    std::vector<float> steps;
    for (const PixelMoments& pixel : film.pixels) {
        steps.push_back(std::isfinite(pixel.mean.r) ? pixel.mean.r : 0.0F);
    }
    const auto most = steps.begin() + static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(steps.size() - 1));
    std::nth_element(steps.begin(), most, steps.end());
    const double scale = *most > 0.0F ? 1.0 / static_cast<double>(*most) : 0.0;
    return shadePixels(film, [scale](const PixelMoments& pixel) {
        return heatColor(scale * static_cast<double>(pixel.mean.r));
    });
}

}  // namespace

void writeFilmPng(const std::filesystem::path& path, const Film& film, double exposure)
{
    const std::string view = findSetting(film.identity.settings, "view");
    if (view == "normal" || view == "depth" || view == "bvh-steps") {
        const std::vector<Rgb8> colors = view == "normal"  ? shadeNormals(film)
                                         : view == "depth" ? shadeDepths(film)
                                                           : shadeSteps(film);
        writePng(path, film.width, film.height, colors);
        return;
    }
    writePng(path, imageOf(film), exposure);
}

void writeRatesPng(const std::filesystem::path& path, const Film& film)
{
    const auto fewer = [](const PixelMoments& a, const PixelMoments& b) { return a.count < b.count; };
    const auto [least, most] = std::minmax_element(film.pixels.begin(), film.pixels.end(), fewer);
    const double range = std::max(1.0, static_cast<double>(most->count - least->count));
    std::vector<Rgb8> colors;
    for (const PixelMoments& pixel : film.pixels) {
        colors.push_back(heatColor(static_cast<double>(pixel.count - least->count) / range));
    }
    writePng(path, film.width, film.height, colors);
}

}  // namespace glim
