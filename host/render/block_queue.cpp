#include "host/render/block_queue.hpp"

#include "shaders/shared/limits.h"

#include <algorithm>
#include <bit>
#include <functional>

namespace glim {

void BlockQueue::add(const std::vector<std::uint32_t>& blocks)
{
    std::transform(blocks.begin(), blocks.end(), blocks_.begin(), blocks_.begin(), std::plus<>());
}

std::optional<Sweep> BlockQueue::take(std::uint32_t maxSamples)
{
    if (isEmpty()) {
        return std::nullopt;
    }
    const std::uint32_t most = *std::max_element(blocks_.begin(), blocks_.end());
    const std::uint32_t blocks = std::bit_floor(std::min(most, std::max(1U, maxSamples / kBlockSamples)));
    Sweep sweep{blocks * kBlockSamples, {}};
    for (std::uint32_t pixel = 0; pixel < blocks_.size(); ++pixel) {
        if (blocks_[pixel] >= blocks) {
            sweep.pixels.push_back({pixel, begin_ + samples_[pixel]});
            blocks_[pixel] -= blocks;
            samples_[pixel] += sweep.sampleCount;
        }
    }
    return sweep;
}

std::uint32_t BlockQueue::end() const { return begin_ + *std::max_element(samples_.begin(), samples_.end()); }

bool BlockQueue::isEmpty() const
{
    return std::all_of(blocks_.begin(), blocks_.end(), [](std::uint32_t blocks) { return blocks == 0; });
}

}  // namespace glim
