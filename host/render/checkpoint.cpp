#include "host/render/checkpoint.hpp"

#include "host/digest.hpp"
#include "shaders/shared/limits.h"

namespace glim {

std::uint32_t blockEnd(std::uint32_t sample) { return (sample / blockSamples(sample) + 1) * blockSamples(sample); }

bool endsBlock(std::uint32_t end) { return end > 0 && end % blockSamples(end - 1) == 0; }

Film filmOf(Checkpoint checkpoint)
{
    foldPage(checkpoint.film, 0, checkpoint.page);
    foldSplats(checkpoint.film.splats, checkpoint.pageSplats);
    return std::move(checkpoint.film);
}

std::optional<Checkpoint> checkpointOf(Film film)
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
    checkpoint.sample = checkpoint.lightSample = end;
    checkpoint.film = std::move(film);
    if (end % kPageSamples != 0) {
        std::swap(checkpoint.page, checkpoint.film.pixels);
        std::swap(checkpoint.pageSplats, checkpoint.film.splats);
        checkpoint.film.pixels.resize(checkpoint.page.size());
    }
    return checkpoint;
}

std::string digestOf(const Checkpoint& checkpoint)
{
    Digest digest;
    digest.add(std::vector<std::uint32_t>{checkpoint.sample, checkpoint.pixelsAhead, checkpoint.lightSample});
    if (const auto& adaptive = checkpoint.adaptive) {
        digest.add(std::vector<std::uint32_t>{adaptive->mean, adaptive->roundEnd, adaptive->commonEnd, adaptive->chosenBegin,
                                              adaptive->choosing ? 1U : 0U});
    }
    for (const auto* moments : {&checkpoint.film.pixels, &checkpoint.page, &checkpoint.common}) {
        digest.add(*moments);
    }
    for (const auto* moments : {&checkpoint.film.splats, &checkpoint.pageSplats, &checkpoint.commonSplats}) {
        digest.add(*moments);
    }
    digest.add(checkpoint.chosen);
    digest.add(checkpoint.blocksLeft);
    return digest.finish();
}

}  // namespace glim
