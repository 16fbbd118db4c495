// Chooses where samples lower the error of a picture most.
#pragma once

#include "host/render/film.hpp"

#include <cstdint>
#include <vector>

namespace glim {

// The error to minimise: mean squared error, absolute or relative to squared radiance.
enum class SquaredError { Absolute, Relative };

// Returns each pixel's share of the samples, 1 on average: in proportion to the standard deviation of a sample (Neyman 1934). This is
// estimated from the 7x7 neighbours without the pixel itself: one that has missed a bright path so far would look converged, be left
// alone, and stay too dark. `film` has equally many samples of each pixel, none of them allocated by earlier shares. Otherwise a bright
// path in a pixel would give its neighbours samples, these would find bright paths, and the pixel would get samples that dilute its own.
std::vector<double> computeShares(const Film& film, SquaredError error);

// Returns the blocks that each pixel should get besides the `samples` it has. All pixels together then have `meanSamples` times their
// number, half a block more or less. Each is as close to its share as the pixels that already have more allow.
std::vector<std::uint32_t> allocateBlocks(const std::vector<double>& shares, const std::vector<std::uint32_t>& samples, double meanSamples);

}  // namespace glim
