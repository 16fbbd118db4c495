#include "host/render/splats.hpp"

#include "host/gpu/commands.hpp"
#include "host/render/sample_plan.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {
namespace {

std::uint64_t wide(const uvec2& words) { return std::uint64_t{words.y} << 32U | words.x; }

BufferMap joined(BufferMap a, const BufferMap& b)
{
    a.insert(b.begin(), b.end());
    return a;
}

}  // namespace

SplatBuffer::Band::Band(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                        std::uint32_t begin, std::uint32_t count)
    : begin_(begin),
      count_(count),
      pass_(device, "picture's splats", BufferKind::Storage, count * sizeof(Splat)),
      block_(device, "picture's sums of splats", BufferKind::Storage, count * sizeof(Splat))
{
    const BufferMap fixed = joined(constants, {{kBindSplats, &pass_}, {kBindBlocks, &block_}});
    even_.emplace(layout, joined(fixed, paths.buffers(0)));
    odd_.emplace(layout, joined(fixed, paths.buffers(1)));
}

SplatBuffer::SplatBuffer(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                         const RenderSettings& settings)
    : device_(device)
{
    const std::uint32_t end = settings.firstPixel() + settings.pixelCount(), most = 4 * settings.tilePixels;
    for (std::uint32_t first = settings.firstPixel(); first < end; first += most) {
        bands_.push_back(std::make_unique<Band>(device, layout, constants, paths, first, std::min(most, end - first)));
    }
    emptyPass();
    emptyBlock();
}

void SplatBuffer::emptyPass() const
{
    Commands commands(device_);
    for (const auto& band : bands_) {
        commands.fillWithZero(band->pass_);
    }
    commands.submitAndWait();
}

void SplatBuffer::emptyBlock() const
{
    Commands commands(device_);
    for (const auto& band : bands_) {
        commands.fillWithZero(band->block_);
    }
    commands.submitAndWait();
}

void SplatSums::add(std::uint32_t firstSample, std::uint32_t sampleCount)
{
    samples_ += sampleCount;
    if (endsBlock(firstSample + sampleCount)) {
        closeBlock();
    }
}

void SplatSums::foldBlock(std::vector<SplatMoments>& page) const
{
    if (samples_ == 0) {
        return;
    }
    const double share = unit_ / samples_;
    auto pixel = page.begin();
    for (const auto& band : block_->bands()) {
        for (const Splat& sum : band->readBlock()) {
            const auto mean = [&](const uvec2& words) { return static_cast<float>(static_cast<double>(wide(words)) * share); };
            const SplatMoments block{samples_, 1, {mean(sum.red), mean(sum.green), mean(sum.blue)}, glm::vec3(0.0F), mean(sum.clamped)};
            *pixel = foldMoments(*pixel, block);
            ++pixel;
        }
    }
}

void SplatSums::closeBlock()
{
    if (samples_ > 0) {
        foldBlock(page_);
        block_->emptyBlock();
        samples_ = 0;
    }
}

std::vector<SplatMoments> SplatSums::pageSoFar() const
{
    std::vector<SplatMoments> page = page_;
    foldBlock(page);
    return page;
}

void SplatSums::foldInto(std::vector<SplatMoments>& film)
{
    closeBlock();
    foldSplats(film, page_);
    std::ranges::fill(page_, SplatMoments{});
}

}  // namespace glim
