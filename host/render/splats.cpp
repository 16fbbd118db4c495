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

SplatBuffer::SplatBuffer(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                         std::uint32_t count)
    : device_(device),
      count_(count),
      splats_(device, "picture's splats", BufferKind::Storage, count * sizeof(Splat))
{
    const BufferMap fixed = joined(constants, {{kBindSplats, &splats_}});
    even_.emplace(layout, joined(fixed, paths.buffers(0)));
    odd_.emplace(layout, joined(fixed, paths.buffers(1)));
    clear();
}

void SplatBuffer::clear()
{
    Commands commands(device_);
    commands.fillWithZero(splats_);
    commands.submitAndWait();
}

void SplatSums::add(std::span<const Splat> splats, std::uint32_t firstSample, std::uint32_t sampleCount)
{
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const Splat& splat = splats[i];
        sums_[i][0] += wide(splat.red);
        sums_[i][1] += wide(splat.green);
        sums_[i][2] += wide(splat.blue);
        sums_[i][3] += wide(splat.clamped);
    }
    samples_ += sampleCount;
    if (endsBlock(firstSample + sampleCount)) {
        closeBlock();
    }
}

void SplatSums::closeBlock()
{
    if (samples_ == 0) {
        return;
    }
    const double share = unit_ / samples_;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
        const auto mean = [&](std::size_t c) { return static_cast<float>(static_cast<double>(sums_[i][c]) * share); };
        const SplatMoments block{samples_, 1, {mean(0), mean(1), mean(2)}, glm::vec3(0.0F), mean(3)};
        page_[i] = foldMoments(page_[i], block);
        sums_[i] = {};
    }
    samples_ = 0;
}

void SplatSums::foldInto(std::vector<SplatMoments>& film)
{
    closeBlock();
    foldSplats(film, page_);
    std::ranges::fill(page_, SplatMoments{});
}

}  // namespace glim
