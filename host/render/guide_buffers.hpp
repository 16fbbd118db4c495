// The guide on the device, and what learning paths write down.
#pragma once

#include "host/gpu/buffer.hpp"
#include "host/render/guide.hpp"
#include "shaders/shared/guide_types.h"

#include <optional>

namespace glim {

class GuideBuffers {
public:
    // `recordedPaths`: at once; 0 unless paths learn.
    GuideBuffers(Device& device, const Guide& guide, std::uint32_t recordedPaths);

    // No kernel may be running; bindings made before are of no use afterwards.
    void set(Device& device, const Guide& guide);

    const Buffer& texels() const { return *texels_; }
    const Buffer& records() const { return records_; }
    std::uint32_t recordedPaths() const { return static_cast<std::uint32_t>(records_.size() / (kGuideRecords * sizeof(GuideRecord))); }

private:
    std::optional<Buffer> texels_;
    Buffer records_;
};

}  // namespace glim
