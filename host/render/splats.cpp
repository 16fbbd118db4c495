#include "host/render/splats.hpp"

#include "host/gpu/commands.hpp"
#include "host/render/sample_plan.hpp"
#include "shaders/shared/bindings.h"
#include "shaders/shared/limits.h"

#include <algorithm>
#include <array>

namespace glim {
namespace {

std::uint64_t wide(const uvec2& words) { return std::uint64_t{words.y} << 32U | words.x; }

struct Units {
    std::array<std::uint64_t, 3> light;
    std::uint64_t clamped;
};

Units unitsOf(const Splat& splat) { return {{wide(splat.red), wide(splat.green), wide(splat.blue)}, wide(splat.clamped)}; }

Units operator+(const Units& a, const Units& b)
{
    return {{a.light[0] + b.light[0], a.light[1] + b.light[1], a.light[2] + b.light[2]}, a.clamped + b.clamped};
}

BufferMap joined(BufferMap a, const BufferMap& b)
{
    a.insert(b.begin(), b.end());
    return a;
}

}  // namespace

SplatBuffer::Band::Band(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                        std::uint32_t begin, std::uint32_t count, std::uint32_t groups)
    : begin_(begin),
      count_(count),
      groups_(groups),
      pass_(device, "picture's splats", BufferKind::Storage, sumCount() * sizeof(Splat)),
      block_(device, "picture's sums of splats", BufferKind::Storage, sumCount() * sizeof(Splat))
{
    const BufferMap fixed = joined(constants, {{kBindSplats, &pass_}, {kBindBlocks, &block_}});
    even_.emplace(layout, joined(fixed, paths.buffers(0)));
    odd_.emplace(layout, joined(fixed, paths.buffers(1)));
}

SplatBuffer::SplatBuffer(Device& device, const KernelLayout& layout, const BufferMap& constants, const PathBuffers& paths,
                         const RenderSettings& settings)
    : device_(device)
{
    const std::uint32_t end = settings.firstPixel() + settings.pixelCount(), groups = std::max(1U, settings.groupCount());
    const std::uint32_t most = 4 * settings.tilePixels / groups;
    for (std::uint32_t first = settings.firstPixel(); first < end; first += most) {
        bands_.push_back(std::make_unique<Band>(device, layout, constants, paths, first, std::min(most, end - first), groups));
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

void SplatSums::foldBlock(FilmMoments& page) const
{
    if (samples_ == 0) {
        return;
    }
    const double share = unit_ / samples_;
    const auto mean = [&](std::uint64_t units) { return static_cast<float>(static_cast<double>(units) * share); };
    const auto meanOf = [&](const Units& sum) { return glm::vec3(mean(sum.light[0]), mean(sum.light[1]), mean(sum.light[2])); };
    std::vector<glm::vec3> ofGroups(momentsOfGroups(groups_));
    std::size_t pixel = 0;
    for (const auto& band : block_->bands()) {
        const std::vector<Splat> sums = band->readBlock();
        for (std::uint32_t i = 0; i < band->count(); ++i, ++pixel) {
            Units all = unitsOf(sums[i]);
            for (std::uint32_t group = 0; group < groups_; ++group) {
                const Units sum = unitsOf(sums[group * band->count() + i]);
                ofGroups[group] = meanOf(sum);
                all = group == 0 ? sum : all + sum;
            }
            SplatMoments& moments = page.splats[pixel];
            if (groups_ > 0) {
                foldGroups(page.splatGroups.of(pixel), moments.count, ofGroups, samples_, groups_);
            }
            moments = foldMoments(moments, {samples_, 1, meanOf(all), glm::vec3(0.0F), mean(all.clamped)});
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

FilmMoments SplatSums::pageSoFar() const
{
    FilmMoments page = page_;
    foldBlock(page);
    return page;
}

void SplatSums::foldInto(FilmMoments& film)
{
    closeBlock();
    foldSplats(film, page_);
    emptyPage();
}

void SplatSums::emptyPage()
{
    page_.splats.assign(pixels_, SplatMoments{});
    page_.splatGroups = GroupMoments(groups_, pixels_);
}

void SplatSums::setPage(FilmMoments page)
{
    page_.splats = std::move(page.splats);
    page_.splatGroups = std::move(page.splatGroups);
}

}  // namespace glim
