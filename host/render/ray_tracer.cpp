#include "host/render/ray_tracer.hpp"

#include <algorithm>
#include <cstddef>

namespace glim {

void RayTracer::recordTrace(Recording& recording, const std::optional<Kernel>& production, const std::optional<Kernel>& course,
                            const Pass& pass, std::uint64_t groupsOffset) const
{
    if (usesCourseEstimators(resources_.settings)) {
        CoursePass round{pass, {}};
        round.lightRound.lightSamples = 1;
        resources_.course.recordTrace(recording, course.value(), tile_->bindings(0), round, resources_.paths().rounds(), groupsOffset);
    } else {
        recording.dispatchIndirect(production.value(), tile_->bindings(0), pass, resources_.paths().rounds(), groupsOffset);
    }
}

std::vector<PathHit> RayTracer::trace(std::span<const PathRay> rays)
{
    resources_.paths().queueRays(rays, resources_.countGroups(static_cast<std::uint32_t>(rays.size())));
    Pass pass = tile_->pass();
    pass.pixelCount = static_cast<std::uint32_t>(rays.size());
    pass.sampleCount = 1;
    Recording recording(resources_.device, resources_.statistics);
    recordTrace(recording, resources_.kernels().traceClosest, resources_.kernels().course.traceClosest, pass, groupsOfPaths(0));
    recording.finish();
    return download<PathHit>(resources_.paths().hits(), rays.size());
}

std::vector<bool> RayTracer::trace(std::span<const ShadowRay> rays)
{
    resources_.paths().queueShadowRays(rays, resources_.countGroups(static_cast<std::uint32_t>(rays.size())));
    Pass pass = tile_->pass();
    pass.pixelCount = static_cast<std::uint32_t>(rays.size());
    pass.sampleCount = 1;
    Recording recording(resources_.device, resources_.statistics);
    recordTrace(recording, resources_.kernels().traceShadow, resources_.kernels().course.traceShadow, pass, groupsOfShadowRays(0));
    recording.finish();
    const std::vector<PathRadiance> found = download<PathRadiance>(resources_.paths().radiance(), rays.size());
    std::vector<bool> free(rays.size());
    std::transform(found.begin(), found.end(), free.begin(), [](const PathRadiance& each) { return each.radiance.r > 0.0F; });
    return free;
}

}  // namespace glim
