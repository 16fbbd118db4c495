// The kernels in their order: traces the paths of a pass to their end (wavefront.cpp).
#pragma once

#include "host/render/device_scene.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/light_rounds.hpp"
#include "host/render/pass_size.hpp"
#include "host/render/path_buffers.hpp"
#include "host/render/recording.hpp"

#include <memory>

namespace glim {

// Told after each kernel of a path: its name, its pass, and where to look.
using PathWatch = std::function<void(const std::string& kernel, const Pass& pass, PathBuffers& paths)>;

// The one that is to be used where each hit has `rounds` of direct light. Throws InputError if what was asked for cannot be.
Schedule chooseSchedule(const RenderSettings& settings, std::size_t rounds, const DeviceDescription& device);

class Wavefront {
public:
    // Uploads the scene and compiles the kernels for what it needs.
    Wavefront(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // The same of the scene and in the buffers of `lender`, which must outlive it and be at rest while it traces.
    Wavefront(Wavefront& lender, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Of the passes from now on. The camera has a lens if and only if the first one had.
    void setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    void setSeed(std::uint32_t seed) { template_.seed = seed; }

    // Pixels of the film; every one is chosen.
    std::unique_ptr<Slab> makeSlab(std::uint32_t begin, std::uint32_t count);

    // A pass over `slab` with nothing in it yet.
    Pass passOf(const Slab& slab) const;
    // Traces the pass and adds its samples to the film. Returns what it took; nothing, and the film is as it was, if `goesOn`, asked
    // every so many dispatches, ended it.
    std::optional<PassSeconds> trace(const Slab& slab, Pass pass, const std::function<bool()>& goesOn);
    // One sample of one pixel alone, added to no film. With a watch that takes radiance, what it has left.
    PathRadiance traceSample(std::uint32_t pixel, std::uint32_t sample, const PathWatch& watch = nullptr);
    // Calls `watch` after each kernel of a pass that is added to no film.
    void watch(const Slab& slab, Pass pass, const PathWatch& watch);
    // Rays alone, no more than the settings' pathCapacity; between passes, and by the wavefront's kernels: std::bad_optional_access
    // with the persistent schedule, which does not compile them.
    std::vector<PathHit> traceRays(const Slab& slab, std::span<const PathRay> rays);
    // Whether each is free.
    std::vector<bool> traceShadowRays(const Slab& slab, std::span<const ShadowRay> rays);
    // Folds the blocks of all pixels, chosen or not, that are under way into their pages.
    void closeBlocks(const Slab& slab);
    // Chooses the pixels that still need samples.
    void choosePixels(Slab& slab);

    const PathBuffers& paths() const { return paths_; }
    Schedule schedule() const { return schedule_; }  // never Auto
    double compileSeconds() const { return compileSeconds_; }
    const std::map<std::string, KernelStatistics>& statistics() const { return statistics_; }

private:
    void compile();
    void tracePaths(Recording& recording, const Slab& slab, Pass& pass);
    // In wavefront_persistent.cpp.
    void tracePersistently(Recording& recording, const Slab& slab, Pass& pass);
    void recordBounce(Recording& recording, const Slab& slab, const Pass& pass) const;
    void recordRounds(Recording& recording, const Bindings& bindings, const Pass& pass) const;
    void recordRound(Recording& recording, const Bindings& bindings, const Pass& round, bool hemisphere) const;
    void recordTrace(Recording& recording, const Kernel& kernel, const Bindings& bindings, Pass pass,
                     std::uint64_t groupsOffset) const;
    void recordSize(Recording& recording, const Bindings& bindings, Pass pass, std::uint32_t queues) const;
    std::uint32_t groupsOf(std::uint32_t count) const;

    Device& device_;
    RenderSettings settings_;
    std::vector<LightRound> rounds_;  // of direct light at each hit
    Schedule schedule_;
    Pass template_;  // what all passes have in common
    std::map<std::string, KernelStatistics> statistics_;
    double compileSeconds_ = 0.0;

    std::optional<DeviceScene> ownScene_;  // absent if they are lent
    std::optional<PathBuffers> ownPaths_;
    const DeviceScene& scene_;
    PathBuffers& paths_;
    DeviceCamera camera_;
    KernelLayout layout_;
    KernelSet kernels_;
};

}  // namespace glim
