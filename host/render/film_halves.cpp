#include "host/render/film_halves.hpp"

#include "host/render/film_identity.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {
namespace {

// The number of the block, counted from sample 0.
std::uint32_t ordinalOf(std::uint32_t sample)
{
    return sample < 2 * kFirstBlockSamples ? sample / kFirstBlockSamples : sample < kBlockSamples ? 2 : 2 + sample / kBlockSamples;
}

SplatMoments withoutMoments(const SplatMoments& all, const SplatMoments& part)
{
    return narrowed(withoutMoments(widened(all), widened(part)));
}

template <class Moments>
void foldRest(std::vector<Moments>& film, const std::vector<Moments>& all, const std::vector<Moments>& part)
{
    film.resize(all.size(), Moments{});
    for (std::size_t i = 0; i < all.size(); ++i) {
        film[i] = foldMoments(film[i], part.empty() ? withoutMoments(all[i], Moments{}) : withoutMoments(all[i], part[i]));
    }
}

}  // namespace

PixelMoments withoutMoments(const PixelMoments& all, const PixelMoments& part)
{
    PixelMoments rest{};
    rest.count = all.count - part.count;
    if (rest.count == 0) {
        return rest;
    }
    rest.blocks = 1;
    const double a = all.count, b = part.count, share = 1.0 / (a - b);
    const auto difference = [&](float whole, float gone) {
        return static_cast<float>((a * static_cast<double>(whole) - b * static_cast<double>(gone)) * share);
    };
    for (int c = 0; c < 3; ++c) {
        rest.mean[c] = difference(all.mean[c], part.mean[c]);
        rest.albedo[c] = difference(all.albedo[c], part.albedo[c]);
        rest.normal[c] = difference(all.normal[c], part.normal[c]);
    }
    rest.alpha = difference(all.alpha, part.alpha);
    rest.clamped = difference(all.clamped, part.clamped);
    rest.depth = all.depth;
    return rest;
}

FilmHalves::FilmHalves(const RenderSettings& settings, std::uint32_t begin)
    : films_{emptyFilm(settings), emptyFilm(settings)},
      taken_(begin)
{}

std::uint32_t FilmHalves::nextEnd(std::uint32_t sample)
{
    const std::uint32_t half = blockSamples(sample) / 2;
    return (sample / half + 1) * half;
}

void FilmHalves::take(const FilmMoments& page, std::uint32_t sample)
{
    if (sample == taken_) {
        return;
    }
    Film& half = films_[ordinalOf(taken_) % 2];
    foldRest(half.pixels, page.pixels, before_.pixels);
    foldRest(half.splats, page.splats, before_.splats);
    before_ = sample % kPageSamples == 0 ? FilmMoments() : page;
    taken_ = sample;
}

}  // namespace glim
