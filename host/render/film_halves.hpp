// The samples of a film in two independent halves, from which the error of a denoised picture is measured.
#pragma once

#include "host/render/film.hpp"
#include "host/render/settings.hpp"

#include <array>
#include <utility>

namespace glim {

// Which half a block of samples goes to. Blocks have scrambles of their own, so halves of whole blocks are independent. The mean of both
// has the least variance if they have equally many samples: after 64 and 128 samples and each multiple of 256 they do.
class HalfSizes {
public:
    struct Place {
        bool joins;        // the first half takes over the second one, which begins again with the block
        std::size_t half;  // that the block goes to
    };
    // `joins`: whether halves may join. They may not if a half has other samples besides.
    explicit HalfSizes(bool joins)
        : joins_(joins)
    {}
    // Of `samples`, at least one, of a block of `size`. The blocks at the beginning grow: where one is as large as all before it, these
    // become one half, and it is the other. Any other block goes to the smaller half.
    Place add(std::uint32_t samples, std::uint32_t size);

private:
    bool joins_;
    std::array<std::uint32_t, 2> sizes_{0, 0};
};

// How many of a pixel's next `blocks`, of kBlockSamples each, go to the first half, so that both become as equal as they can. An odd one
// goes to the second half if that is as good: the next block that all pixels share, of 64 samples, goes to the first.
std::uint32_t blocksOfFirstHalf(std::uint32_t first, std::uint32_t second, std::uint32_t blocks);

// The halves of what pixels, or light paths, have of a run of samples. `kMoments`: a member of FilmMoments, theirs.
template <auto kMoments>
class HalvedRun {
public:
    // From `begin` on.
    HalvedRun(std::uint32_t begin, bool joins)
        : sizes_(joins),
          taken_(begin)
    {}
    // Goes on from halves that have the blocks up to `sample`, with the page so far.
    void resume(FilmMoments page, std::uint32_t sample);
    // `page`: all samples of the page so far, before `sample`. `isLast`: also takes a block that is not whole.
    void take(std::array<Film, 2>& halves, FilmMoments page, std::uint32_t sample, bool isLast);
    // Samples beside the run, which the page has so far, go to one half.
    void takeOthers(Film& half, FilmMoments page);
    // The next samples are of a new page.
    void beginPage() { before_ = {}; }
    // When samples were last taken.
    const FilmMoments& page() const { return before_; }

private:
    HalfSizes sizes_;
    FilmMoments before_, middle_;  // the page at the end of the last block, and in the middle of the block under way
    std::uint32_t taken_;          // the end of the last block
};

// Each half knows its variance from halves of its blocks; these share a scramble, so it is somewhat too large where Sobol points serve
// well. Samples that an adaptive render gives to chosen pixels come besides, half by half.
class FilmHalves {
public:
    explicit FilmHalves(const RenderSettings& settings)
        : FilmHalves(settings, settings.sampleBegin)
    {}
    // `begin`: the end of a page, or the first sample of the render. The halves have what comes behind it.
    FilmHalves(const RenderSettings& settings, std::uint32_t begin);
    // Goes on from those that have the blocks from the first sample of the render to `sample`, and the light paths to `splatSample`; and
    // from the pages when these were taken.
    FilmHalves(const RenderSettings& settings, std::array<FilmMoments, 2> halves, FilmMoments page, std::uint32_t sample,
               FilmMoments splatPage, std::uint32_t splatSample);

    // Whether a sweep that begins at `sample` must end here or before, to be taken: the first end of half a block behind it.
    static std::uint32_t nextEnd(std::uint32_t sample);

    // `page`: all samples of the page so far, before `sample`. To be called at each nextEnd. Blocks are taken when they are whole. At the
    // end of the render (`isLast`) also one that is not.
    void take(FilmMoments page, std::uint32_t sample, bool isLast) { pixels_.take(films_, std::move(page), sample, isLast); }
    void takeSplats(FilmMoments page, std::uint32_t sample, bool isLast) { splats_.take(films_, std::move(page), sample, isLast); }
    // The chosen pixels' samples of the page so far.
    void takeChosen(std::size_t half, FilmMoments page) { pixels_.takeOthers(films_[half], std::move(page)); }
    void beginPage();

    // Of what is taken.
    const std::array<Film, 2>& films() const { return films_; }
    // The pixels' samples of the page when these were.
    const FilmMoments& page() const { return pixels_.page(); }

private:
    std::array<Film, 2> films_;
    HalvedRun<&FilmMoments::pixels> pixels_;
    HalvedRun<&FilmMoments::splats> splats_;
};

extern template class HalvedRun<&FilmMoments::pixels>;
extern template class HalvedRun<&FilmMoments::splats>;

// What is left of `all` without `part`, as one block.
PixelMoments withoutMoments(const PixelMoments& all, const PixelMoments& part);

}  // namespace glim
