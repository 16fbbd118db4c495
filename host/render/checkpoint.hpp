// What a render needs to go on as if it had never stopped.
#pragma once

#include "host/render/film.hpp"

#include <optional>

namespace glim {

// How far --adaptive neighbours is.
struct AdaptiveProgress {
    std::uint32_t mean = 0, roundEnd = 0;  // samples per pixel on average after the last round, and after the one under way
    std::uint32_t commonEnd = 0;           // of the samples that all pixels share in this round
    std::uint32_t chosenBegin = 0;         // index of the first samples that pixels have besides
    bool choosing = false;                 // the round is at these
};

// A render at the end of a pass.
struct Checkpoint {
    Film film;                             // what is folded; sample ranges and completeness are those of the whole
    std::vector<PixelMoments> page;        // finished blocks that are not folded; empty if there are none
    std::vector<SplatMoments> pageSplats;  // the same of light paths
    std::uint32_t sample = 0;              // the first one that some pixel lacks; begins a block
    std::uint32_t pixelsAhead = 0;         // so many pixels, from the first on, have this block too
    std::uint32_t lightSample = 0;         // the first one whose light paths are missing

    // --adaptive neighbours.
    std::optional<AdaptiveProgress> adaptive;
    std::vector<PixelMoments> common;        // the samples that all pixels share, which are in the film too
    std::vector<SplatMoments> commonSplats;  // that were there with them
    std::vector<std::uint32_t> chosen;       // how many samples each pixel has besides, and
    std::vector<std::uint32_t> blocksLeft;   // how many blocks it is still to get in this round
};

// The film that it shows.
Film filmOf(Checkpoint checkpoint);

// Of a film without a checkpoint, by uniform sampling. Returns nothing if its last page has blocks that cannot be told apart any more, or
// if it lacks samples.
std::optional<Checkpoint> checkpointOf(Film film);

// SHA-256 of all of it but its film's time and device.
std::string digestOf(const Checkpoint& checkpoint);

// The end of the block that begins with this sample.
std::uint32_t blockEnd(std::uint32_t sample);
bool endsBlock(std::uint32_t end);

}  // namespace glim
