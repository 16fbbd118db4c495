#include "host/render/film_halves.hpp"

#include "host/render/film_identity.hpp"
#include "host/render/sample_plan.hpp"
#include "shaders/shared/limits.h"

#include <utility>

namespace glim {
namespace {

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

void foldRest(FilmMoments& half, const FilmMoments& all, const FilmMoments& part)
{
    foldRest(half.pixels, all.pixels, part.pixels);
    foldRest(half.splats, all.splats, part.splats);
}

// Leaves `other` empty.
void join(FilmMoments& half, FilmMoments& other)
{
    if (half.pixels.empty()) {
        std::swap(half, other);
    } else {
        foldMoments(half, std::exchange(other, {}));
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

HalfSizes::Place HalfSizes::add(std::uint32_t samples, std::uint32_t size)
{
    Place place{sizes_[0] + sizes_[1] <= size && samples >= size / 2, sizes_[1] < sizes_[0] ? 1U : 0U};
    if (place.joins) {
        sizes_ = {sizes_[0] + sizes_[1], 0};
        place.half = 1;
    }
    sizes_[place.half] += samples;
    return place;
}

FilmHalves::FilmHalves(const RenderSettings& settings, std::uint32_t begin)
    : films_{emptyFilm(settings), emptyFilm(settings)},
      taken_(begin)
{}

FilmHalves::FilmHalves(const RenderSettings& settings, std::array<FilmMoments, 2> halves, FilmMoments page, std::uint32_t sample)
    : FilmHalves(settings)
{
    for (std::size_t i = 0; i < 2; ++i) {
        static_cast<FilmMoments&>(films_[i]) = std::move(halves[i]);
    }
    before_ = std::move(page);
    while (taken_ < sample) {
        sizes_.add(blockEnd(taken_) - taken_, blockSamples(taken_));
        taken_ = blockEnd(taken_);
    }
}

std::uint32_t FilmHalves::nextEnd(std::uint32_t sample)
{
    const std::uint32_t half = blockSamples(sample) / 2;
    return (sample / half + 1) * half;
}

void FilmHalves::take(FilmMoments page, std::uint32_t sample)
{
    if (sample == blockEnd(taken_)) {
        takeLast(std::move(page), sample);
    } else {
        middle_ = std::move(page);
    }
}

void FilmHalves::takeLast(FilmMoments page, std::uint32_t sample)
{
    if (sample == taken_) {
        return;
    }
    const HalfSizes::Place place = sizes_.add(sample - taken_, blockSamples(taken_));
    if (place.joins) {
        join(films_[0], films_[1]);
    }
    Film& half = films_[place.half];
    if (!middle_.pixels.empty()) {
        foldRest(half, middle_, before_);
        before_ = std::exchange(middle_, {});
    }
    foldRest(half, page, before_);
    before_ = sample % kPageSamples == 0 ? FilmMoments() : std::move(page);
    taken_ = sample;
}

}  // namespace glim
