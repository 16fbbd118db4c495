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
    // Of every pixel from sample `begin` on, which begins a block.
    BlockQueue(std::size_t pixels, std::uint32_t begin) : begin_(begin), samples_(pixels, 0), blocks_(pixels, 0) {}

    void add(const std::vector<std::uint32_t>& blocks);
    // Takes the same power of two of blocks of every pixel that still needs as many: the most that some pixel needs, but no more
    // than a block or `mostSamples`. Nothing once all are taken.
    std::optional<Sweep> take(std::uint32_t mostSamples);

    // How many were taken of every pixel, and the first index beyond all of them.
    const std::vector<std::uint32_t>& samples() const { return samples_; }
    std::uint32_t begin() const { return begin_; }
    std::uint32_t end() const;
    bool isEmpty() const;

private:
    std::uint32_t begin_ = 0;
    std::vector<std::uint32_t> samples_, blocks_;
};

}  // namespace glim
