#include "host/bench/ray_sets.hpp"

#include <algorithm>

namespace glim {
namespace {

// Elements of `values` at the first `count` entries of a queue, whose order is that of the slots: which thread came first decides the
// queue's own.
template <class T>
std::vector<T> queued(const Buffer& values, const Buffer& queue, std::size_t count, std::size_t slots)
{
    const std::vector<T> all = download<T>(values, slots);
    std::vector<uint> entries = download<uint>(queue, count);
    std::sort(entries.begin(), entries.end());
    std::vector<T> chosen(count);
    std::transform(entries.begin(), entries.end(), chosen.begin(), [&all](uint slot) { return all[slot]; });
    return chosen;
}

}  // namespace

RaySets captureRays(Wavefront& wavefront, const Slab& slab)
{
    RaySets sets;
    Pass pass = wavefront.passOf(slab);
    pass.pixelCount = slab.count();
    pass.sampleCount = 1;
    pass.maxBounces = 1;
    wavefront.watch(slab, pass, [&](const std::string& kernel, const Pass& at, PathBuffers& paths) {
        const QueueTails tails = download<QueueTails>(paths.queueTails(), 1)[0];
        if (kernel == "generate_rays") {
            sets.primary = download<PathRay>(paths.rays(), slab.count());
        } else if (kernel == "sample_lights" && at.bounce == 0) {
            sets.shadow = queued<ShadowRay>(paths.shadowRays(), paths.shadowQueue(), tails.shadow, slab.count());
        } else if (kernel == "bounce" && at.bounce == 0) {
            sets.diffuse = queued<PathRay>(paths.rays(), paths.nextQueue(0), tails.next, slab.count());
        }
    });
    return sets;
}

}  // namespace glim
