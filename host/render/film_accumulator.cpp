#include "host/render/film_accumulator.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace glim {

FilmAccumulator::FilmAccumulator(RenderResources& resources, const RenderSettings& settings, Film film, std::optional<float> splatScale)
    : resources_(resources),
      tracer_(resources),
      settings_(settings),
      splatScale_(splatScale)
{
    makeTiles();
    begin(std::move(film));
}

void FilmAccumulator::makeTiles()
{
    tiles_.clear();
    snapshot_.emplace(resources_.device, std::min(settings_.tilePixels, settings_.pixelCount()) * sizeof(PixelMoments));
    const std::uint32_t end = settings_.firstPixel() + settings_.pixelCount();
    for (std::uint32_t first = settings_.firstPixel(); first < end; first += settings_.tilePixels) {
        tiles_.push_back(resources_.makeTile(first, std::min(settings_.tilePixels, end - first)));
    }
}

void FilmAccumulator::restart(const RenderSettings& settings, Film film)
{
    finishFold();
    const glm::uvec2 before(settings_.width, settings_.height), size(settings.width, settings.height);
    settings_ = settings;
    if (size != before) {
        std::swap(tiles_, spare_);
        std::swap(snapshot_, spareSnapshot_);
        if (size != std::exchange(spareSize_, before)) {
            makeTiles();
        }
    }
    for (const auto& tile : tiles_) {
        tile->clear();
    }
    begin(std::move(film));
}

void FilmAccumulator::begin(Film film)
{
    film_ = std::move(film);
    film_.pixels.assign(settings_.pixelCount(), PixelMoments{});
    film_.catcher.assign(settings_.catcher ? settings_.pixelCount() : 0, CatcherMoments{});
    common_ = isNeighbours(settings_.adaptive) ? film_ : Film{};
    halves_.reset();
    keepsHalves_ = settings_.halves && !settings_.halvesLate;
    if (splatScale_) {
        splats_.reset();  // so that no two are on the device
        splats_.emplace(resources_.makeSplatBuffer(settings_), settings_.pixelCount(), *splatScale_);
    }
    foldVersion_ = 0;
}

// Display keeps folded pages of one accumulator, and would take those of another for them.
void FilmAccumulator::renewVersion()
{
    static std::atomic<std::uint64_t> last = 0;
    foldVersion_ = ++last;
}

void FilmAccumulator::chooseAllPixels()
{
    for (const auto& tile : tiles_) {
        tile->chooseAll();
    }
}

void FilmAccumulator::choosePixels(const std::vector<PixelStart>& pixels)
{
    auto from = pixels.begin();
    for (const auto& tile : tiles_) {
        std::vector<ChosenPixel> chosen;
        for (; from != pixels.end() && from->pixel < tile->begin() + tile->count(); ++from) {
            chosen.push_back({from->pixel - tile->begin(), from->sample});
        }
        tile->choose(chosen);
    }
}

std::vector<std::uint32_t> FilmAccumulator::testPixels(std::uint32_t samples)
{
    std::vector<std::uint32_t> chosen;
    for (const auto& tile : tiles_) {
        chosen.push_back(tracer_.choosePixels(*tile, samples));
    }
    return chosen;
}

void FilmAccumulator::foldPages(const std::vector<Film*>& films, const std::vector<std::unique_ptr<Tile>>& tiles)
{
    for (const auto& tile : tiles) {
        tracer_.closeBlocks(*tile);
        finishFold();  // the tile before this one, or the page before this one
        const std::span<const PixelMoments> pages = tile->takePages(*snapshot_);
        folding_ =
            std::async(std::launch::async, [films, pages, catchers = tile->takeCatchers(), begin = tile->begin() - settings_.firstPixel()] {
                for (Film* film : films) {
                    foldPage(*film, begin, pages);
                    foldCatcher(film->catcher, begin, catchers);
                }
            });
    }
}

void FilmAccumulator::finishFold() const
{
    if (folding_.valid()) {
        folding_.get();
    }
}

void FilmAccumulator::fold()
{
    foldPages({&film_}, tiles_);
    if (splats_) {
        splats_->foldInto(film_.splats);
    }
    renewVersion();
}

void FilmAccumulator::foldCommon()
{
    foldPages({&film_, &common_}, tiles_);
    if (splats_) {
        splats_->foldInto(film_.splats);
    }
    common_.splats = film_.splats;
    renewVersion();
}

// What the device and the open block of light paths have, which is not folded yet.
Film FilmAccumulator::pageSoFar()
{
    Film page;
    page.pixels.resize(settings_.pixelCount());
    std::vector<std::unique_ptr<Tile>> copies;
    for (const auto& tile : tiles_) {
        copies.push_back(resources_.makeTile(tile->begin(), tile->count()));
        copies.back()->copySamples(*tile, 0);
    }
    foldPages({&page}, copies);
    finishFold();
    if (splats_) {
        page.splats = splats_->pageSoFar();
    }
    return page;
}

void FilmAccumulator::takeHalves(std::uint32_t sample)
{
    const bool isFirst = sample <= FilmHalves::nextEnd(settings_.sampleBegin);
    if (keepsHalves_ && !halves_ && (isFirst || sample % kPageSamples == 0)) {
        halves_.emplace(settings_, isFirst ? settings_.sampleBegin : sample);
    }
    if (halves_) {
        halves_->take(pageSoFar(), sample);
    }
}

Film FilmAccumulator::sum()
{
    Film film = folded();
    const Film page = pageSoFar();
    foldPage(film, 0, page.pixels);
    foldSplats(film.splats, page.splats);
    foldCatcher(film.catcher, 0, page.catcher);
    return film;
}

PixelMoments FilmAccumulator::sum(std::uint32_t pixel)
{
    const Tile& tile = *tiles_[pixel / settings_.tilePixels];
    const std::unique_ptr<Tile> copy = resources_.makeTile(pixel, 1);
    copy->copySamples(tile, pixel - tile.begin());
    tracer_.closeBlocks(*copy);
    return foldMoments(folded().pixels[pixel], copy->readPages().front());
}

Film FilmAccumulator::takeFilm()
{
    fold();
    finishFold();
    return std::move(film_);
}

std::vector<PixelMoments> FilmAccumulator::takePages()
{
    Film page;
    page.pixels.resize(settings_.pixelCount());
    foldPages({&page}, tiles_);
    finishFold();
    return std::move(page.pixels);
}

Checkpoint FilmAccumulator::checkpoint() const
{
    Checkpoint checkpoint;
    checkpoint.film = folded();
    checkpoint.page.reserve(settings_.pixelCount());
    for (const auto& tile : tiles_) {
        const std::vector<PixelMoments> pages = tile->readPages();
        checkpoint.page.insert(checkpoint.page.end(), pages.begin(), pages.end());
        const std::vector<CatcherMoments> catchers = tile->readCatchers();
        checkpoint.pageCatcher.insert(checkpoint.pageCatcher.end(), catchers.begin(), catchers.end());
    }
    if (splats_) {
        checkpoint.pageSplats = splats_->page();
    }
    const auto clearIfEmpty = [](auto& moments) {
        if (std::ranges::all_of(moments, [](const auto& pixel) { return pixel.count == 0; })) {
            moments.clear();
        }
    };
    clearIfEmpty(checkpoint.page);
    clearIfEmpty(checkpoint.pageSplats);
    clearIfEmpty(checkpoint.pageCatcher);
    checkpoint.common = common_.pixels;
    checkpoint.commonSplats = common_.splats;
    checkpoint.commonCatcher = common_.catcher;
    return checkpoint;
}

void FilmAccumulator::resume(Checkpoint checkpoint)
{
    finishFold();
    const Film fresh = std::exchange(film_, std::move(checkpoint.film));
    film_.identity = fresh.identity;  // without what a film's file says of its camera
    film_.device += film_.device.find(fresh.device) == std::string::npos ? "; " + fresh.device : "";
    addArithmetic(film_, fresh.arithmetic);
    const auto partOf = [this](const auto& page, const Tile& tile) {
        return std::span(page).subspan(tile.begin() - settings_.firstPixel(), tile.count());
    };
    for (const auto& tile : tiles_) {
        if (!checkpoint.page.empty()) {
            tile->writePages(partOf(checkpoint.page, *tile));
        }
        if (!checkpoint.pageCatcher.empty()) {
            tile->writeCatchers(partOf(checkpoint.pageCatcher, *tile));
        }
    }
    if (splats_ && !checkpoint.pageSplats.empty()) {
        splats_->setPage(std::move(checkpoint.pageSplats));
    }
    common_.pixels = std::move(checkpoint.common);
    common_.splats = std::move(checkpoint.commonSplats);
    common_.catcher = std::move(checkpoint.commonCatcher);
    renewVersion();
}

}  // namespace glim
