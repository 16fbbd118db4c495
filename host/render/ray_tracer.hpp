// Traces single rays without paths, for clicks in the window and for benchmarks.
#pragma once

#include "host/render/render_resources.hpp"

namespace glim {

// Between passes, at most the settings' pathCapacity rays at once. Uses the wavefront's kernels: throws std::bad_optional_access with the
// persistent schedule, which does not compile them.
class RayTracer {
public:
    explicit RayTracer(RenderResources& resources)
        : resources_(resources),
          tile_(resources.makeTile(0, 1))
    {}

    std::vector<PathHit> trace(std::span<const PathRay> rays);
    // Whether each is unoccluded. Light that has met one surface must count (--bounces 1 or more).
    std::vector<bool> trace(std::span<const ShadowRay> rays);

private:
    void recordTrace(Recording& recording, const std::optional<Kernel>& production, const std::optional<Kernel>& course, const Pass& pass,
                     std::uint64_t groupsOffset) const;

    RenderResources& resources_;
    std::unique_ptr<Tile> tile_;  // kernels want one; its pixels do not matter
};

}  // namespace glim
