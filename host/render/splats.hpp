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
             std::uint32_t count, std::uint32_t groups);

        std::uint32_t begin() const { return begin_; }
        std::uint32_t count() const { return count_; }
        // Sums: of each pixel, and of each light group if there are some.
        std::uint32_t sumCount() const { return count_ * groups_; }
        const Bindings& bindings(std::uint32_t parity) const { return parity == 0 ? *even_ : *odd_; }
        std::vector<Splat> readBlock() const { return download<Splat>(block_, sumCount()); }

    private:
        friend class SplatBuffer;

        std::uint32_t begin_, count_, groups_;
        Buffer pass_, block_;
        std::optional<Bindings> even_, odd_;
    };

    SplatBuffer(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                const RenderSettings& settings);

    static std::uint64_t bytesFor(const RenderSettings& settings)
    {
        return 2 * sizeof(Splat) * std::max(1U, settings.groupCount()) * std::uint64_t{settings.pixelCount()};
    }

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
    SplatSums(std::unique_ptr<SplatBuffer> block, const RenderSettings& settings, float scale)
        : block_(std::move(block)),
          unit_(1.0 / static_cast<double>(scale)),
          pixels_(settings.pixelCount()),
          groups_(settings.groupCount())
    {
        emptyPage();
    }

    const SplatBuffer& block() const { return *block_; }
    // A pass has added samples [firstSample, firstSample + sampleCount), all of one block, to it. Closes the block at its end.
    void add(std::uint32_t firstSample, std::uint32_t sampleCount);
    // Closes the block, whole or not, and folds the page into `film`.
    void foldInto(FilmMoments& film);
    // With the open block, which goes on.
    FilmMoments pageSoFar() const;
    // Without the open block.
    const FilmMoments& page() const { return page_; }
    void setPage(FilmMoments page);

    // On the host, for each pixel.
    static std::uint64_t bytesPerPixel(const RenderSettings& settings)
    {
        return sizeof(SplatMoments) + momentsOfGroups(settings.groupCount()) * sizeof(glm::vec3) +
               std::max(1U, settings.groupCount()) * sizeof(Splat);
    }

private:
    void foldBlock(FilmMoments& page) const;
    void closeBlock();
    void emptyPage();

    std::unique_ptr<SplatBuffer> block_;
    double unit_;
    std::uint32_t samples_ = 0;  // of the block
    std::size_t pixels_;
    std::uint32_t groups_;
    FilmMoments page_;  // splats alone
};

}  // namespace glim
