#include "host/render/film_halves.hpp"

#include "host/render/film_identity.hpp"
#include "host/render/sample_plan.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <utility>

namespace glim {
namespace {

SplatMoments withoutMoments(const SplatMoments& all, const SplatMoments& part)
{
    return narrowed(withoutMoments(widened(all), widened(part)));
}

template <class Moments>
void foldRest(std::vector<Moments>& half, const std::vector<Moments>& all, const std::vector<Moments>& part)
{
    half.resize(all.size(), Moments{});
    for (std::size_t i = 0; i < all.size(); ++i) {
        half[i] = foldMoments(half[i], withoutMoments(all[i], part.empty() ? Moments{} : part[i]));
    }
}

// Leaves `other` empty.
template <class Moments>
void join(std::vector<Moments>& half, std::vector<Moments>& other)
{
    half.resize(other.size(), Moments{});
    for (std::size_t i = 0; i < other.size(); ++i) {
        half[i] = foldMoments(half[i], other[i]);
    }
    other.clear();
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
    Place place{joins_ && sizes_[0] + sizes_[1] <= size && samples >= size / 2, sizes_[1] < sizes_[0] ? 1U : 0U};
    if (place.joins) {
        sizes_ = {sizes_[0] + sizes_[1], 0};
        place.half = 1;
    }
    sizes_[place.half] += samples;
    return place;
}

std::uint32_t blocksOfFirstHalf(std::uint32_t first, std::uint32_t second, std::uint32_t blocks)
{
    const std::int64_t lead = std::int64_t{first} - std::int64_t{second}, all = std::int64_t{blocks} * kBlockSamples;
    const std::int64_t doubled = std::clamp<std::int64_t>(all - lead, 0, 2 * all);  // samples of the first half's share, twice
    return static_cast<std::uint32_t>((doubled + kBlockSamples - 1) / (2 * kBlockSamples));
}

template <auto kMoments>
void HalvedRun<kMoments>::resume(FilmMoments page, std::uint32_t sample)
{
    before_ = std::move(page);
    while (taken_ < sample) {
        sizes_.add(blockEnd(taken_) - taken_, blockSamples(taken_));
        taken_ = blockEnd(taken_);
    }
}

template <auto kMoments>
void HalvedRun<kMoments>::take(std::array<Film, 2>& halves, FilmMoments page, std::uint32_t sample, bool isLast)
{
    if (sample == taken_) {
        return;
    }
    if (sample != blockEnd(taken_) && !isLast) {
        middle_ = std::move(page);
        return;
    }
    const HalfSizes::Place place = sizes_.add(sample - taken_, blockSamples(taken_));
    if (place.joins) {
        join(halves[0].*kMoments, halves[1].*kMoments);
    }
    if (!(middle_.*kMoments).empty()) {
        takeOthers(halves[place.half], std::exchange(middle_, {}));
    }
    takeOthers(halves[place.half], std::move(page));
    taken_ = sample;
}

template <auto kMoments>
void HalvedRun<kMoments>::takeOthers(Film& half, FilmMoments page)
{
    foldRest(half.*kMoments, page.*kMoments, before_.*kMoments);
    before_ = std::move(page);
}

template class HalvedRun<&FilmMoments::pixels>;
template class HalvedRun<&FilmMoments::splats>;

FilmHalves::FilmHalves(const RenderSettings& settings, std::uint32_t begin)
    : films_{emptyFilm(settings), emptyFilm(settings)},
      pixels_(begin, !isNeighbours(settings.adaptive)),
      splats_(begin, true)
{}

FilmHalves::FilmHalves(const RenderSettings& settings, std::array<FilmMoments, 2> halves, FilmMoments page, std::uint32_t sample,
                       FilmMoments splatPage, std::uint32_t splatSample)
    : FilmHalves(settings)
{
    for (std::size_t i = 0; i < 2; ++i) {
        static_cast<FilmMoments&>(films_[i]) = std::move(halves[i]);
    }
    pixels_.resume(std::move(page), sample);
    splats_.resume(std::move(splatPage), splatSample);
}

std::uint32_t FilmHalves::nextEnd(std::uint32_t sample)
{
    const std::uint32_t half = blockSamples(sample) / 2;
    return (sample / half + 1) * half;
}

void FilmHalves::beginPage()
{
    pixels_.beginPage();
    splats_.beginPage();
}

}  // namespace glim
