#include "host/render/checkpoint.hpp"

#include "host/digest.hpp"
#include "shaders/shared/limits.h"

namespace glim {

Film makeFilm(Checkpoint checkpoint)
{
    foldPage(checkpoint.film, 0, checkpoint.page);
    foldSplats(checkpoint.film.splats, checkpoint.pageSplats);
    foldCatcher(checkpoint.film.catcher, 0, checkpoint.pageCatcher);
    return std::move(checkpoint.film);
}

std::optional<Checkpoint> makeCheckpoint(Film film)
{
    if (!film.complete || film.sampleRanges.size() != 1) {
        return std::nullopt;
    }
    const auto [begin, end] = film.sampleRanges.front();
    const bool onePage = begin / kPageSamples == (end - 1) / kPageSamples;
    if (!endsBlock(end) || (end % kPageSamples != 0 && !onePage)) {
        return std::nullopt;
    }
    Checkpoint checkpoint;
    checkpoint.progress.sample = checkpoint.progress.lightSample = end;
    checkpoint.film = std::move(film);
    if (end % kPageSamples != 0) {
        std::swap(checkpoint.page, checkpoint.film.pixels);
        std::swap(checkpoint.pageSplats, checkpoint.film.splats);
        std::swap(checkpoint.pageCatcher, checkpoint.film.catcher);
        checkpoint.film.pixels.resize(checkpoint.page.size());
        checkpoint.film.catcher.resize(checkpoint.pageCatcher.size());
    }
    return checkpoint;
}

std::string computeDigest(const Checkpoint& checkpoint)
{
    const SampleProgress& progress = checkpoint.progress;
    const AdaptiveProgress adaptive = progress.adaptive.value_or(AdaptiveProgress{});
    Digest digest;
    digest.add(std::vector<std::uint32_t>{progress.sample, progress.pixelsAhead, progress.lightSample});
    if (progress.adaptive) {
        digest.add(std::vector<std::uint32_t>{adaptive.mean, adaptive.roundEnd, adaptive.commonEnd, adaptive.chosenBegin,
                                              adaptive.choosing ? 1U : 0U});
    }
    for (const auto* moments : {&checkpoint.film.pixels, &checkpoint.page, &checkpoint.common}) {
        digest.add(*moments);
    }
    for (const auto* moments : {&checkpoint.film.splats, &checkpoint.pageSplats, &checkpoint.commonSplats}) {
        digest.add(*moments);
    }
    for (const auto* moments : {&checkpoint.film.catcher, &checkpoint.pageCatcher, &checkpoint.commonCatcher}) {
        digest.add(*moments);
    }
    digest.add(adaptive.chosen);
    digest.add(adaptive.blocksLeft);
    return digest.finish();
}

}  // namespace glim
