// Schedules samples for pixels that need different numbers of them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace glim {

// A pixel of the picture, and the index of the first of its samples.
struct PixelStart {
    std::uint32_t pixel;
    std::uint32_t sample;
};

// The same number of samples for each of some pixels, which are in ascending order.
struct Sweep {
    std::uint32_t sampleCount = 0;
    std::vector<PixelStart> pixels;
};

// The whole blocks of samples that are still to be taken of each pixel, in order of sample index.
class BlockQueue {
public:
    BlockQueue() = default;
    // Every pixel starts at sample `begin`, which begins a block.
    BlockQueue(std::size_t pixels, std::uint32_t begin)
        : begin_(begin),
          samples_(pixels, 0),
          blocks_(pixels, 0)
    {}

    // What `samples()` and `blocks()` have returned.
    BlockQueue(std::uint32_t begin, std::vector<std::uint32_t> samples, std::vector<std::uint32_t> blocks)
        : begin_(begin),
          samples_(std::move(samples)),
          blocks_(std::move(blocks))
    {}

    void add(const std::vector<std::uint32_t>& blocks);
    // Takes the same number of blocks of every pixel that still needs as many: the largest power of two that some pixel needs, at most
    // `maxSamples` but at least one block. Returns nothing once all are taken.
    std::optional<Sweep> take(std::uint32_t maxSamples);

    // The samples taken of each pixel, and the first index beyond all of them.
    const std::vector<std::uint32_t>& samples() const { return samples_; }
    // The blocks that are still to be taken of each.
    const std::vector<std::uint32_t>& blocks() const { return blocks_; }
    std::uint32_t begin() const { return begin_; }
    std::uint32_t end() const;
    bool isEmpty() const;

private:
    std::uint32_t begin_ = 0;
    std::vector<std::uint32_t> samples_, blocks_;
};

}  // namespace glim
