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
    snapshot_.emplace(resources_.device, std::min(settings_.tileSize(), settings_.pixelCount()) * sizeof(PixelMoments));
    const std::uint32_t end = settings_.firstPixel() + settings_.pixelCount();
    for (std::uint32_t first = settings_.firstPixel(); first < end; first += settings_.tileSize()) {
        tiles_.push_back(resources_.makeTile(first, std::min(settings_.tileSize(), end - first)));
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
    static_cast<FilmMoments&>(film_) = emptyMoments();
    common_ = isNeighbours(settings_.adaptive) ? film_ : Film{};
    halves_.reset();
    keepsHalves_ = settings_.halves && !settings_.halvesLate;
    if (splatScale_) {
        splats_.reset();  // so that no two are on the device
        splats_.emplace(resources_.makeSplatBuffer(settings_), settings_, *splatScale_);
    }
    foldVersion_ = 0;
}

FilmMoments FilmAccumulator::emptyMoments() const
{
    FilmMoments moments;
    moments.pixels.resize(settings_.pixelCount());
    moments.catcher.resize(settings_.catcher ? settings_.pixelCount() : 0);
    moments.groups = GroupMoments(settings_.groupCount(), settings_.pixelCount());
    return moments;
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

void FilmAccumulator::foldPages(const std::vector<FilmMoments*>& films, const std::vector<std::unique_ptr<Tile>>& tiles)
{
    for (const auto& tile : tiles) {
        tracer_.closeBlocks(*tile);
        finishFold();  // the tile before this one, or the page before this one
        const std::span<const PixelMoments> pages = tile->takePages(*snapshot_);
        folding_ = std::async(std::launch::async, [films, pages, catchers = tile->takeCatchers(), groups = tile->takeGroups(),
                                                   begin = tile->begin() - settings_.firstPixel()] {
            for (FilmMoments* film : films) {
                foldPage(*film, begin, {pages, catchers, groups});
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
        splats_->foldInto(film_);
    }
    beginPage();
}

void FilmAccumulator::foldCommon()
{
    foldPages({&film_, &common_}, tiles_);
    if (splats_) {
        splats_->foldInto(film_);
    }
    common_.splats = film_.splats;
    common_.splatGroups = film_.splatGroups;
    beginPage();
}

void FilmAccumulator::beginPage()
{
    if (halves_) {
        halves_->beginPage();
    }
    renewVersion();
}

// What the device has and is not folded yet.
FilmMoments FilmAccumulator::tilesSoFar()
{
    FilmMoments page = emptyMoments();
    std::vector<std::unique_ptr<Tile>> copies;
    for (const auto& tile : tiles_) {
        copies.push_back(resources_.makeTile(tile->begin(), tile->count()));
        copies.back()->copySamples(*tile, 0);
    }
    foldPages({&page}, copies);
    finishFold();
    return page;
}

// With the open block of light paths.
FilmMoments FilmAccumulator::pageSoFar()
{
    FilmMoments page = tilesSoFar();
    if (splats_) {
        foldSplats(page, splats_->pageSoFar());
    }
    return page;
}

void FilmAccumulator::openHalves(std::uint32_t sample)
{
    const bool isFirst = sample <= FilmHalves::nextEnd(settings_.sampleBegin);
    if (keepsHalves_ && !halves_ && (isFirst || sample % kPageSamples == 0)) {
        halves_.emplace(settings_, isFirst ? settings_.sampleBegin : sample);
    }
}

void FilmAccumulator::takeHalves(std::uint32_t sample, bool isLast)
{
    openHalves(sample);
    if (halves_) {
        halves_->take(tilesSoFar(), sample, isLast);
    }
}

void FilmAccumulator::takeSplatHalves(std::uint32_t sample, bool isLast)
{
    openHalves(sample);
    if (halves_ && splats_) {
        halves_->takeSplats(splats_->pageSoFar(), sample, isLast);
    }
}

void FilmAccumulator::takeChosenHalves(std::size_t half)
{
    if (halves_) {
        halves_->takeChosen(half, tilesSoFar());
    }
}

Film FilmAccumulator::sum()
{
    Film film = folded();
    foldMoments(film, pageSoFar());
    return film;
}

PixelMoments FilmAccumulator::sum(std::uint32_t pixel)
{
    const Tile& tile = *tiles_[pixel / settings_.tileSize()];
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
    FilmMoments page = emptyMoments();
    foldPages({&page}, tiles_);
    finishFold();
    return std::move(page.pixels);
}

Checkpoint FilmAccumulator::checkpoint(SampleProgress progress) const
{
    Checkpoint checkpoint;
    checkpoint.progress = std::move(progress);
    checkpoint.film = folded();
    FilmMoments& page = checkpoint.page;
    page.groups = GroupMoments(settings_.groupCount(), 0);
    const auto append = [](auto& pages, const auto& more) { pages.insert(pages.end(), more.begin(), more.end()); };
    for (const auto& tile : tiles_) {
        append(page.pixels, tile->readPages());
        append(page.catcher, tile->readCatchers());
        append(page.groups.values, tile->readGroups());
    }
    const auto isEmpty = [](const auto& moments) {
        return std::ranges::all_of(moments, [](const auto& pixel) { return pixel.count == 0; });
    };
    if (isEmpty(page.pixels)) {
        page = {};
    }
    if (halves_) {
        checkpoint.halves = {halves_->films()[0], halves_->films()[1]};
        if (isChoosing(checkpoint.progress)) {
            checkpoint.before.pixels = halves_->page().pixels;
        } else {
            page = halves_->page();
        }
    }
    if (splats_ && !isEmpty(splats_->page().splats)) {
        foldSplats(page, splats_->page());
    }
    checkpoint.common = common_;
    return checkpoint;
}

void FilmAccumulator::resume(Checkpoint checkpoint)
{
    finishFold();
    if (keepsHalves_) {
        const SampleProgress& progress = checkpoint.progress;
        FilmMoments page = isChoosing(progress) ? std::move(checkpoint.before) : checkpoint.page, splats;
        page.splats.clear();
        page.splatGroups = {};
        splats.splats = checkpoint.page.splats;
        halves_.emplace(settings_, std::move(checkpoint.halves), std::move(page), progress.sample, std::move(splats), progress.lightSample);
    }
    const Film fresh = std::exchange(film_, std::move(checkpoint.film));
    film_.identity = fresh.identity;  // without what a film's file says of its camera
    film_.device += film_.device.find(fresh.device) == std::string::npos ? "; " + fresh.device : "";
    addArithmetic(film_, fresh.arithmetic);
    const std::size_t perPixel = momentsOfGroups(settings_.groupCount());
    for (const auto& tile : tiles_) {
        const std::size_t begin = tile->begin() - settings_.firstPixel(), count = tile->count();
        const FilmMoments& page = checkpoint.page;
        if (!page.pixels.empty()) {
            tile->writePages(std::span(page.pixels).subspan(begin, count));
        }
        if (!page.catcher.empty()) {
            tile->writeCatchers(std::span(page.catcher).subspan(begin, count));
        }
        if (!page.groups.isEmpty()) {
            tile->writeGroups(std::span(page.groups.values).subspan(begin * perPixel, count * perPixel));
        }
    }
    if (splats_ && !checkpoint.page.splats.empty()) {
        splats_->setPage(std::move(checkpoint.page));
    }
    static_cast<FilmMoments&>(common_) = std::move(checkpoint.common);
    renewVersion();
}

}  // namespace glim
