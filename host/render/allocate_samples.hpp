// Where samples lower the error of a picture most.
#pragma once

#include "host/render/film.hpp"

#include <cstdint>
#include <vector>

namespace glim {

// What is to become small: the mean of squared errors, or of squared errors over squared radiance.
enum class SquaredError { Absolute, Relative };

// What share of the samples each pixel should have, 1 on average: in proportion to the standard deviation of a sample (Neyman 1934),
// which its 7x7 neighbours tell, but not the pixel itself: one that has missed a bright path so far would look calm, be left
// alone, and stay too dark. `film` has as many samples of each pixel, none of which earlier shares have asked for: else a bright
// path in a pixel gave its neighbours samples, these found bright paths, and the pixel got samples that dilute its own.
std::vector<double> computeShares(const Film& film, SquaredError error);

// Blocks that each pixel should have besides the `samples` it has: together all pixels then have `meanSamples` times their number,
// half a block more or less, each as close to its share as those allow that already have more.
std::vector<std::uint32_t> allocateBlocks(const std::vector<double>& shares, const std::vector<std::uint32_t>& samples,
                                          double meanSamples);

}  // namespace glim
