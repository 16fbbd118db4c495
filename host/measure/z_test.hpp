// Tests whether a picture equals the reference up to the noise that both are known to have. The noise of single pixels is far from
// normal, and testing them would reject correct pictures; sums over blocks and over the picture are near enough to normal. Three tests:
// the mean of each channel, each 8x8 block of each channel, and the mean of z^2 over the blocks, which also notices a wrong variance. The
// variances must come from enough samples: about 100 skewness^2 of them, over a block.
#pragma once

#include "host/measure/picture.hpp"

#include <array>

namespace glim {

struct ZTest {
    std::size_t compared = 0;              // pixels
    std::array<double, 3> meanZ{};         // of each channel's mean
    double meanLimit = 0.0;                // Sidak over three
    double worstZ = 0.0;                   // of all blocks and channels,
    std::uint32_t worstX = 0, worstY = 0;  // of the block with this upper left pixel
    int worstChannel = 0;
    double blockLimit = 0.0;                   // Sidak over all
    std::array<std::size_t, 3> blocks{};       // with noise above the rounding of float32, by channel
    std::array<double, 3> meanSquare{};        // of z over them
    std::array<double, 3> meanSquareMargin{};  // allowed distance from 1: 4 sqrt(2 / blocks)
    double detectableBias = 0.0;               // relative to a channel's mean: found by the first test with 95 % probability

    bool meansAgree() const;
    bool blocksAgree() const;
    bool spreadAgrees() const;
    bool agrees() const { return meansAgree() && blocksAgree() && spreadAgrees(); }
};

// Both variances must be known (an exact reference has zeros); pixels where one is not finite are left out, but a test of
// no pixel at all is refused (InputError). `alpha` is the probability with which each of the first two tests rejects a
// correct picture.
ZTest zTest(const Picture& picture, const Picture& reference, double alpha = 0.01);

}  // namespace glim
