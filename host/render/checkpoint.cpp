#include "host/render/checkpoint.hpp"

#include "host/digest.hpp"
#include "shaders/shared/limits.h"

namespace glim {

Film makeFilm(Checkpoint checkpoint)
{
    foldMoments(checkpoint.film, checkpoint.page);
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
        FilmMoments& folded = checkpoint.film;
        std::swap(checkpoint.page, folded);
        folded.pixels.resize(checkpoint.page.pixels.size());
        folded.catcher.resize(checkpoint.page.catcher.size());
        folded.groups = GroupMoments(checkpoint.page.groups.groups, checkpoint.page.groups.pixelCount());
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
                                              adaptive.choosing ? 1U + (adaptive.second ? 1U : 0U) : 0U});
    }
    const FilmMoments* parts[] = {&checkpoint.film, &checkpoint.page, &checkpoint.common};
    const auto add = [&](auto member) {
        for (const FilmMoments* part : parts) {
            digest.add(part->*member);
        }
    };
    add(&FilmMoments::pixels);
    add(&FilmMoments::splats);
    add(&FilmMoments::catcher);
    for (const FilmMoments* part : parts) {
        digest.add(part->groups.values);
        digest.add(part->splatGroups.values);
    }
    digest.add(adaptive.chosen);
    digest.add(adaptive.blocksLeft);
    digest.add(adaptive.blocksLater);
    return digest.finish();
}

std::string computeHalvesDigest(const Checkpoint& checkpoint)
{
    if (!checkpoint.hasHalves()) {
        return "";
    }
    Digest digest;
    for (const FilmMoments& half : checkpoint.halves) {
        digest.add(half.pixels);
        digest.add(half.splats);
    }
    digest.add(checkpoint.before.pixels);
    return digest.finish();
}

}  // namespace glim
