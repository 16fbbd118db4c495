// The samples of a film in two independent halves, from which the error of a denoised picture is measured.
#pragma once

#include "host/render/film.hpp"
#include "host/render/settings.hpp"

#include <array>

namespace glim {

// Blocks of samples take turns: the first goes to the first half, the second to the other one. Blocks have scrambles of their own, so the
// halves are independent. Each half knows its variance from halves of its blocks; these share a scramble, so it is somewhat too large
// where Sobol points serve well.
class FilmHalves {
public:
    explicit FilmHalves(const RenderSettings& settings)
        : FilmHalves(settings, settings.sampleBegin)
    {}
    // `begin`: the end of a page, or the first sample of the render. The halves have what comes behind it.
    FilmHalves(const RenderSettings& settings, std::uint32_t begin);

    // Whether a sweep that begins at `sample` must end here or before, to be taken: the first end of half a block behind it.
    static std::uint32_t nextEnd(std::uint32_t sample);

    // `page`: all samples of the page so far, before `sample`. To be called at each nextEnd and at the end of the render.
    void take(const FilmMoments& page, std::uint32_t sample);

    const std::array<Film, 2>& films() const { return films_; }

private:
    std::array<Film, 2> films_;
    FilmMoments before_;  // the page when it was last taken
    std::uint32_t taken_;
};

// What is left of `all` without `part`, as one block.
PixelMoments withoutMoments(const PixelMoments& all, const PixelMoments& part);

}  // namespace glim
