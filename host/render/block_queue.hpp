// Which samples pixels should have next that need different numbers of them.
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

// Work of one kind: each of its pixels, in ascending order, has as many samples.
struct Sweep {
    std::uint32_t sampleCount = 0;
    std::vector<PixelStart> pixels;
};

// Whole blocks of samples still to be taken, of every pixel in the order of their index.
class BlockQueue {
public:
    BlockQueue() = default;
    // All pixels go on from sample `begin`, which begins a block.
    BlockQueue(std::size_t pixels, std::uint32_t begin) : next_(pixels, begin), blocks_(pixels, 0) {}

    void add(const std::vector<std::uint32_t>& blocks);
    // Takes the same power of two of blocks of every pixel that still needs as many: the most that some pixel needs and that does not
    // exceed `mostSamples`, of which a block is always one. Nothing once all are taken.
    std::optional<Sweep> take(std::uint32_t mostSamples);

    // Where every pixel goes on, and the furthest of them.
    const std::vector<std::uint32_t>& next() const { return next_; }
    std::uint32_t end() const;
    bool isEmpty() const;

private:
    std::vector<std::uint32_t> next_, blocks_;
};

}  // namespace glim
