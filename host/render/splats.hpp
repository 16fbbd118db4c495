// Splats: light that light paths add to pixels. Here they go from the device to the film.
#pragma once

#include "host/render/film.hpp"
#include "host/render/path_buffers.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace glim {

// What the light paths of a pass add to pixels [begin, begin + count) of the picture. A storage buffer's limit cuts large pictures into
// bands; each traces all light paths again.
class SplatBuffer {
public:
    // `constants`: buffers of the scene and the parameters.
    SplatBuffer(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths, std::uint32_t count);

    // The pixels of a band.
    static std::uint32_t countFor(const RenderSettings& settings)
    {
        return static_cast<std::uint32_t>(std::min<std::uint64_t>(settings.pixelCount(), 4 * std::uint64_t{settings.tilePixels}));
    }
    static std::uint64_t bytesFor(const RenderSettings& settings) { return countFor(settings) * sizeof(Splat); }

    std::uint32_t count() const { return count_; }
    const Bindings& bindings(std::uint32_t parity) const { return parity == 0 ? *even_ : *odd_; }
    void clear();
    // The first `count` pixels.
    std::vector<Splat> read(std::uint32_t count) const { return download<Splat>(splats_, count); }

private:
    Device& device_;
    std::uint32_t count_;
    Buffer splats_;
    std::optional<Bindings> even_, odd_;
};

// The sums of the open block in fixed point, and the moments of the page's blocks. Folds as accumulate.comp does for camera samples.
class SplatSums {
public:
    // `scale`: units per W/(sr m^2), as in RenderParameters.
    SplatSums(std::size_t pixels, float scale)
        : unit_(1.0 / static_cast<double>(scale)),
          sums_(pixels),
          page_(pixels)
    {}

    // Adds what a pass has brought of samples [firstSample, firstSample + sampleCount), all of one block, and closes the block at its end.
    void add(std::span<const Splat> splats, std::uint32_t firstSample, std::uint32_t sampleCount);
    // Closes the block, whole or not, and folds the page into `film`.
    void foldInto(std::vector<SplatMoments>& film);
    // Without the open block.
    const std::vector<SplatMoments>& page() const { return page_; }
    void setPage(std::vector<SplatMoments> page) { page_ = std::move(page); }

private:
    using Sum = std::array<std::uint64_t, 4>;  // red, green, blue, clamped

public:
    static constexpr std::uint64_t kPixelBytes = sizeof(Sum) + sizeof(SplatMoments) + sizeof(Splat);

private:
    void closeBlock();

    double unit_;
    std::uint32_t samples_ = 0;  // of the block
    std::vector<Sum> sums_;
    std::vector<SplatMoments> page_;
};

}  // namespace glim
