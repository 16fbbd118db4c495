// The samples of a film in two independent halves, from which the error of a denoised picture is measured.
#pragma once

#include "host/render/film.hpp"
#include "host/render/settings.hpp"

#include <array>

namespace glim {

// Which half a block of samples goes to. Blocks have scrambles of their own, so halves of whole blocks are independent. The mean of both
// has the least variance if they have equally many samples: after 64 and 128 samples and each multiple of 256 they do.
class HalfSizes {
public:
    struct Place {
        bool joins;        // the first half takes over the second one, which begins again with the block
        std::size_t half;  // that the block goes to
    };
    // Of `samples`, at least one, of a block of `size`. The blocks at the beginning grow: where one is as large as all before it, these
    // become one half, and it is the other. Any other block goes to the smaller half.
    Place add(std::uint32_t samples, std::uint32_t size);

private:
    std::array<std::uint32_t, 2> sizes_{0, 0};
};

// Each half knows its variance from halves of its blocks; these share a scramble, so it is somewhat too large where Sobol points serve
// well.
class FilmHalves {
public:
    explicit FilmHalves(const RenderSettings& settings)
        : FilmHalves(settings, settings.sampleBegin)
    {}
    // `begin`: the end of a page, or the first sample of the render. The halves have what comes behind it.
    FilmHalves(const RenderSettings& settings, std::uint32_t begin);
    // Goes on from those that have the blocks from the first sample of the render to `sample`, and from the page before that.
    FilmHalves(const RenderSettings& settings, std::array<FilmMoments, 2> halves, FilmMoments page, std::uint32_t sample);

    // Whether a sweep that begins at `sample` must end here or before, to be taken: the first end of half a block behind it.
    static std::uint32_t nextEnd(std::uint32_t sample);

    // `page`: all samples of the page so far, before `sample`. To be called at each nextEnd. Blocks are taken when they are whole.
    void take(FilmMoments page, std::uint32_t sample);
    // At the end of the render: also takes a block that is not whole.
    void takeLast(FilmMoments page, std::uint32_t sample);

    // Of the blocks that are taken.
    const std::array<Film, 2>& films() const { return films_; }
    // Samples of the page when these were.
    const FilmMoments& page() const { return before_; }

private:
    std::array<Film, 2> films_;
    HalfSizes sizes_;
    FilmMoments before_, middle_;  // the page at the end of the last block, and in the middle of the block under way if that is reached
    std::uint32_t taken_;          // the end of the last block
};

// What is left of `all` without `part`, as one block.
PixelMoments withoutMoments(const PixelMoments& all, const PixelMoments& part);

}  // namespace glim
