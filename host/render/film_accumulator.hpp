// Sums a picture's samples: on the device block by block and page by page, then folded into a film on the host.
#pragma once

#include "host/render/checkpoint.hpp"
#include "host/render/film_halves.hpp"
#include "host/render/pass_tracer.hpp"

#include <future>

namespace glim {

class FilmAccumulator {
public:
    // `resources` must stay. `film`: what is known of the picture before it has samples. `splatScale`: as of SplatSums, if light paths are
    // traced.
    FilmAccumulator(RenderResources& resources, const RenderSettings& settings, Film film, std::optional<float> splatScale);
    // Starts another picture.
    void restart(const RenderSettings& settings, Film film);

    // The tiles on the device have what is not folded yet, folded() has the rest. The version changes whenever folded() does; it is 0
    // while nothing is folded, and unique over all accumulators.
    const std::vector<std::unique_ptr<Tile>>& tiles() const { return tiles_; }
    const Film& folded() const
    {
        finishFold();
        return film_;
    }
    std::uint64_t foldVersion() const { return foldVersion_; }
    // Null unless the settings ask for them; if they are late, until keepHalves() was called and the next page begins.
    const FilmHalves* halves() const { return halves_ ? &*halves_ : nullptr; }
    // Of --adaptive neighbours: the samples that all pixels share, at the end of their part of a round.
    const Film& common() const
    {
        finishFold();
        return common_;
    }
    // Of renders that trace light paths: where a pass adds its splats, and that it has.
    const SplatBuffer& splats() const { return splats_->block(); }
    void addSplats(const LightPass& pass) { splats_->add(pass.firstSample, pass.sampleCount); }

    void chooseAllPixels();
    // In ascending order.
    void choosePixels(const std::vector<PixelStart>& pixels);
    // Chooses those that the course's rule has not stopped after this many samples. Returns how many of each tile these are.
    std::vector<std::uint32_t> testPixels(std::uint32_t samples);

    // Close the open blocks, which may be partial in adaptive renders and at the end, and fold all pages: in the background, while the
    // device goes on.
    void fold();
    void foldCommon();
    // Of this picture, if the settings ask for halves that are late. Before there is half a block they lose no sample.
    void keepHalves() { keepsHalves_ = settings_.halves; }
    // The samples that are not folded into the halves, if there are any: those of all pixels, of light paths, and of chosen pixels, whose
    // blocks go to one half after the other. They end before `sample`. Last: the render is at its end.
    void takeHalves(std::uint32_t sample, bool isLast);
    void takeSplatHalves(std::uint32_t sample, bool isLast);
    void takeChosenHalves(std::size_t half);

    // All samples so far; sampling may go on.
    Film sum();
    PixelMoments sum(std::uint32_t pixel);
    // All samples; only restart() may follow.
    Film takeFilm();
    // The samples that are not folded, as a film of its own. They are gone then.
    std::vector<PixelMoments> takePages();

    // Without the blocks that are not finished; if halves are kept, without those that all pixels should have and some have not finished.
    Checkpoint checkpoint(SampleProgress progress) const;
    void resume(Checkpoint checkpoint);

private:
    void makeTiles();
    void begin(Film film);
    // Into each of the films, which stay until finishFold() has returned.
    void foldPages(const std::vector<FilmMoments*>& films, const std::vector<std::unique_ptr<Tile>>& tiles);
    void finishFold() const;
    FilmMoments emptyMoments() const;
    FilmMoments tilesSoFar();
    FilmMoments pageSoFar();
    void beginPage();
    void openHalves(std::uint32_t sample);
    void renewVersion();

    RenderResources& resources_;
    PassTracer tracer_;
    RenderSettings settings_;
    std::optional<float> splatScale_;
    std::vector<std::unique_ptr<Tile>> tiles_;
    std::optional<HostBuffer> snapshot_;        // of the pages of one tile
    std::vector<std::unique_ptr<Tile>> spare_;  // tiles of the previous size, to which a window soon returns
    std::optional<HostBuffer> spareSnapshot_;
    glm::uvec2 spareSize_{0, 0};
    std::optional<SplatSums> splats_;
    Film film_, common_;
    std::optional<FilmHalves> halves_;
    bool keepsHalves_ = false;
    std::uint64_t foldVersion_ = 0;
    mutable std::future<void> folding_;  // from the snapshot into films
};

}  // namespace glim
