// Splats: light that light paths add to pixels. Here they go from the device to the film.
#pragma once

#include "host/render/film.hpp"
#include "host/render/path_buffers.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace glim {

// What light paths add to the pixels of a film, on the device: in a pass, which may be stopped, and in the block that is open. A storage
// buffer's limit cuts large pictures into bands; for each of them all light paths of a pass are traced again.
class SplatBuffer {
public:
    class Band {
    public:
        // Of pixels [begin, begin + count) of the picture. `constants`: buffers of the scene and the parameters.
        Band(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths, std::uint32_t begin,
             std::uint32_t count);

        std::uint32_t begin() const { return begin_; }
        std::uint32_t count() const { return count_; }
        const Bindings& bindings(std::uint32_t parity) const { return parity == 0 ? *even_ : *odd_; }
        std::vector<Splat> readBlock() const { return download<Splat>(block_, count_); }

    private:
        friend class SplatBuffer;

        std::uint32_t begin_, count_;
        Buffer pass_, block_;
        std::optional<Bindings> even_, odd_;
    };

    SplatBuffer(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                const RenderSettings& settings);

    static std::uint64_t bytesFor(const RenderSettings& settings) { return 2 * sizeof(Splat) * std::uint64_t{settings.pixelCount()}; }

    const std::vector<std::unique_ptr<Band>>& bands() const { return bands_; }
    void emptyPass() const;
    void emptyBlock() const;

private:
    Device& device_;
    std::vector<std::unique_ptr<Band>> bands_;
};

// The open block's sums, in fixed point on the device, and the moments of the page's blocks. Folds as accumulate.comp does for camera
// samples.
class SplatSums {
public:
    // `scale`: units per W/(sr m^2), as in RenderParameters.
    SplatSums(std::unique_ptr<SplatBuffer> block, std::size_t pixels, float scale)
        : block_(std::move(block)),
          unit_(1.0 / static_cast<double>(scale)),
          page_(pixels)
    {}

    const SplatBuffer& block() const { return *block_; }
    // A pass has added samples [firstSample, firstSample + sampleCount), all of one block, to it. Closes the block at its end.
    void add(std::uint32_t firstSample, std::uint32_t sampleCount);
    // Closes the block, whole or not, and folds the page into `film`.
    void foldInto(std::vector<SplatMoments>& film);
    // With the open block, which goes on.
    std::vector<SplatMoments> pageSoFar() const;
    // Without the open block.
    const std::vector<SplatMoments>& page() const { return page_; }
    void setPage(std::vector<SplatMoments> page) { page_ = std::move(page); }

    static constexpr std::uint64_t kPixelBytes = sizeof(SplatMoments) + sizeof(Splat);  // on the host

private:
    void foldBlock(std::vector<SplatMoments>& page) const;
    void closeBlock();

    std::unique_ptr<SplatBuffer> block_;
    double unit_;
    std::uint32_t samples_ = 0;  // of the block
    std::vector<SplatMoments> page_;
};

}  // namespace glim
