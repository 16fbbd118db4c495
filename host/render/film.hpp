// A picture, what is known of its error, and what it shows.
#pragma once

#include "shaders/shared/pixel_moments.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace glim {

// Two films may be merged exactly if all of this agrees (their sample ranges must be disjoint).
struct FilmIdentity {
    std::string scene;     // hash of what was rendered: geometry, materials, lights, camera
    std::string settings;  // every option that changes a sample: "seed=1 sampler=sobol bounces=64 ..."
    std::uint32_t seed = 0;
    std::string kernels;  // fingerprint (film_origin.hpp); films of others are not of the same bits, but may be merged
};

// What light paths have brought to a pixel: caustics, which camera paths leave out. Samples are those of the picture, the same for all
// pixels.
struct SplatMoments {
    std::uint32_t count = 0, blocks = 0;
    glm::vec3 mean{0.0F}, squares{0.0F};  // as in PixelMoments
    float clamped = 0.0F;
};

struct Film {
    std::uint32_t width = 0, height = 0;
    std::uint32_t rowsAbove = 0, rowsBelow = 0;                         // of the picture, which the film lacks
    std::vector<PixelMoments> pixels;                                   // row 0 at the top, left to right; of camera paths
    std::vector<SplatMoments> splats;                                   // of light paths; empty if there were none
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sampleRanges;  // [begin, end), ascending, disjoint
    bool complete = true;                                               // each pixel has all of sampleRanges or, if adaptive, its own share
    FilmIdentity identity;
    double seconds = 0.0;    // spent sampling
    std::string device;      // names the device and driver
    std::string arithmetic;  // fingerprints (film_origin.hpp) of all devices, with spaces between them
    std::string sceneFile;   // as given
};

// SHA-256 of what makes the film: its identity, sample ranges and moments, not when and where it was rendered.
std::string digestOf(const Film& film);

// SHA-256 of the moments alone: equal for films of the same bits, whatever kernels and devices they are of.
std::string pixelsDigestOf(const Film& film);

// Chan, Golub, LeVeque 1983 for the mean and the sum of squares between blocks. Exactly this order of float32 operations makes a merged
// film equal to the single run bit for bit.
PixelMoments foldMoments(const PixelMoments& a, const PixelMoments& b);

SplatMoments foldMoments(const SplatMoments& a, const SplatMoments& b);

// Folds `page` onto `film`. Either may be empty.
void foldSplats(std::vector<SplatMoments>& film, const std::vector<SplatMoments>& page);

// Whether all of it is of one arithmetic: only then can it be bit-identical to a single run.
bool isOfOneArithmetic(const Film& film);
void addArithmetic(Film& film, const std::string& arithmetic);

// Folds `page` onto the pixels of `film` from index `begin` on.
void foldPage(Film& film, std::size_t begin, const std::vector<PixelMoments>& page);

// Variance of a pixel's mean from its block means; NaN where fewer than two blocks are known.
glm::vec3 varianceOfMean(const PixelMoments& moments);

// The pixel as the film shows it: its moments with the mean, the variance of the mean and the clamped light of camera and light paths
// together.
PixelMoments shownPixel(const Film& film, std::size_t i);
std::vector<PixelMoments> shownPixels(const Film& film);

}  // namespace glim
