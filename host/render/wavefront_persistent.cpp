// The persistent schedule: one kernel that traces path after path to its end.
//
//   generate_rays
//   until no path is left:  size_dispatch -> trace_paths
//   accumulate
//
// Nearly always one dispatch does it: its threads put paths aside once they have gone as many steps as a dispatch may take. No path
// waits for others, nor for memory between its steps; but a hit has one round of direct light, and a ray the BVH.
#include "host/error.hpp"
#include "host/render/wavefront.hpp"

#include <cstddef>

namespace glim {

Schedule chooseSchedule(const RenderSettings& settings, std::size_t rounds, const DeviceDescription& device)
{
    if (settings.schedule == Schedule::Auto) {
        const bool can = settings.accelerator != Accelerator::None && rounds <= 1;
        const bool known = settings.fastest != Schedule::Auto;
        return can && (known ? settings.fastest == Schedule::Persistent : device.software) ? Schedule::Persistent : Schedule::Wavefront;
    }
    if (settings.schedule == Schedule::Persistent && settings.accelerator == Accelerator::None) {
        throw InputError("--schedule persistent: one kernel cannot try every primitive within a dispatch, as --accelerator none asks; "
                         "expected --schedule wavefront or --accelerator bvh.");
    }
    if (settings.schedule == Schedule::Persistent && rounds > 1) {
        throw InputError("--schedule persistent: one kernel traces one shadow ray per hit, but --direct and the scene's lights ask for " +
                         std::to_string(rounds) + " rounds of them; expected --schedule wavefront or --direct mis.");
    }
    return settings.schedule;
}

void Wavefront::tracePersistently(Recording& recording, const Slab& slab, Pass& pass)
{
    const LightRound& round = rounds_.front();
    pass.light = round.light;
    pass.lightSample = round.sample;
    pass.lightSamples = round.samples;
    pass.sizes = kSizesShares;
    recording.dispatch(*kernels_.generateRays, slab.bindings(1), pass, groupsOf(pass.pixelCount * pass.sampleCount));
    recording.dispatch(*kernels_.sizeDispatch, slab.bindings(0), pass, 1);
    pass.bounce = 1;  // the queue is no longer that of all slots
    bool alive = true;
    for (std::uint32_t parity = 0; alive; parity = 1 - parity) {
        const Bindings& bindings = slab.bindings(parity);
        recording.dispatchIndirect(*kernels_.tracePaths, bindings, pass, paths_.queueSizes(), offsetof(QueueSizes, closestGroups));
        recording.dispatch(*kernels_.sizeDispatch, bindings, pass, 1);
        recording.finish();
        alive = !recording.isStopped() && download<QueueSizes>(paths_.queueSizes(), 1)[0].closest > 0;
    }
}

}  // namespace glim
