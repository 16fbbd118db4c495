#include "host/render/guide_buffers.hpp"

#include <algorithm>

namespace glim {

GuideBuffers::GuideBuffers(Device& device, const Guide& guide, std::uint32_t recordedPaths)
    : records_(device, "guide's records", BufferKind::Storage, std::max(1U, recordedPaths * kGuideRecords) * sizeof(GuideRecord))
{
    set(device, guide);
}

void GuideBuffers::set(Device& device, const Guide& guide)
{
    texels_.emplace(device, "guide", BufferKind::Texel, guide.texels.size() * sizeof(uvec4));
    upload(*texels_, std::span<const uvec4>(guide.texels));
}

}  // namespace glim
