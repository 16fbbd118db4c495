// The state that a render needs to continue as if it had never stopped.
#pragma once

#include "host/render/learned_guide.hpp"
#include "host/render/sample_plan.hpp"

#include <array>
#include <optional>

namespace glim {

// A render at the end of a pass.
struct Checkpoint {
    SampleProgress progress;
    Film film;         // what is folded; sample ranges and completeness are those of the whole
    FilmMoments page;  // finished blocks that are not folded; what there is none of is empty
    FilmMoments
        common;  // of --adaptive neighbours: the samples that all pixels share, and the light paths with them. The film has them too
    // Of a render that keeps halves (FilmHalves): those of film and page together, and, while it is at its chosen pixels, the page when
    // these were last taken.
    std::array<FilmMoments, 2> halves;
    FilmMoments before;
    std::optional<LearnedGuide> guide;  // the answer of learnGuide() to the picture, if it was asked

    bool hasHalves() const { return !halves[0].pixels.empty() || !halves[1].pixels.empty(); }
};

// The film that it shows.
Film makeFilm(Checkpoint checkpoint);

// Of a film without a checkpoint, by uniform sampling. Returns nothing if its last page has blocks that cannot be told apart any more, or
// if it lacks samples.
std::optional<Checkpoint> makeCheckpoint(Film film);

// SHA-256 of all of it but its halves, its guide, which has its own, and its film's time and device.
std::string computeDigest(const Checkpoint& checkpoint);
// That of the halves, which earlier builds do not know; empty if there are none.
std::string computeHalvesDigest(const Checkpoint& checkpoint);

}  // namespace glim
