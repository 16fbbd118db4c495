#include "host/cli/film_figures.hpp"

#include <algorithm>

namespace glim {
namespace {

template <class Value>
double computeMean(const Film& film, Value value)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        sum += static_cast<double>(value(pixel));
    }
    return sum / static_cast<double>(film.pixels.size());
}

}  // namespace

Rates computeRates(const Film& film)
{
    const auto fewer = [](const PixelMoments& a, const PixelMoments& b) { return a.count < b.count; };
    const auto [least, most] = std::minmax_element(film.pixels.begin(), film.pixels.end(), fewer);
    const auto blocks = std::min_element(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& a, const PixelMoments& b) {
        return a.blocks < b.blocks;
    });
    return {computeMean(film, [](const PixelMoments& p) { return p.count; }), least->count, most->count, blocks->blocks};
}

Steps computeSteps(const Film& film)
{
    const auto fewer = [](const PixelMoments& a, const PixelMoments& b) { return a.mean.r < b.mean.r; };
    return {computeMean(film, [](const PixelMoments& p) { return p.mean.r; }),
            computeMean(film, [](const PixelMoments& p) { return p.mean.g; }),
            static_cast<double>(std::max_element(film.pixels.begin(), film.pixels.end(), fewer)->mean.r)};
}

ClampedEnergy computeClampedEnergy(const Film& film)
{
    return {computeMean(film, [](const PixelMoments& p) { return p.clamped; }),
            computeMean(film, [](const PixelMoments& p) { return p.mean.r + p.mean.g + p.mean.b; }) / 3.0};
}

}  // namespace glim
