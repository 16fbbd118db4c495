// Dispatches the kernels in their order: traces the paths of a pass to their end (wavefront.cpp).
#pragma once

#include "host/render/course.hpp"
#include "host/render/device_scene.hpp"
#include "host/render/kernel_set.hpp"
#include "host/render/parameters.hpp"
#include "host/render/pass_size.hpp"
#include "host/render/path_buffers.hpp"
#include "host/render/recording.hpp"
#include "host/render/splats.hpp"

#include <memory>

namespace glim {

// Called after each kernel of a path with its name, its pass (and round, for a kernel of the course), and the buffers to look at.
using PathWatch = std::function<void(const std::string& kernel, const CoursePass& pass, PathBuffers& paths)>;

// The schedule that a render is to use. Throws InputError if the one asked for cannot render the other settings.
Schedule chooseSchedule(const RenderSettings& settings, const DeviceDescription& device);

// What several renders of one scene may share. Only one of them may render at a time.
struct SharedResources {
    DeviceScene scene;
    PathBuffers paths;
};

// What the scene at another time may use again.
struct LastingResources {
    std::shared_ptr<const CompiledKernels> kernels;
    LastingBuffers buffers;
};

class Wavefront {
public:
    // Uploads the scene and compiles the kernels for what it needs, unless those of `lasting`, made for the same settings, serve it too.
    Wavefront(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
              LastingResources lasting = {});

    // Uses the resources of another one of the same scene, which must outlive this one and be idle while it traces.
    Wavefront(Device& device, SharedResources& shared, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);
    SharedResources& shared() { return shared_; }
    LastingResources lasting() const { return {compiled_, shared_.scene.lasting()}; }

    // Takes other kernels if the present ones do not serve this camera, and compiles them if need be: a camera close to large triangles
    // needs kFeatureLargeTriangles. The kernels before stay for cameras that come back.
    void adapt(const FlatScene& scene, const FlatCamera& camera);
    // Sets the camera of the following passes.
    void setCamera(const FlatCamera& camera, std::uint32_t width, std::uint32_t height);
    void setSeed(std::uint32_t seed) { parameters_.setSeed(seed); }

    // A tile of the film's pixels, all of them chosen.
    std::unique_ptr<Tile> makeTile(std::uint32_t begin, std::uint32_t count);

    // For the picture's bands of pixels.
    std::unique_ptr<SplatBuffer> makeSplatBuffer(std::uint32_t count);

    // An empty pass over `tile`.
    Pass passOf(const Tile& tile) const;
    // Traces the pass and adds its samples to the film. Returns the time it took. Returns nothing, and leaves the film as it was, if
    // `shouldContinue`, asked after each portion of dispatches, ended it.
    std::optional<PassSeconds> trace(const Tile& tile, Pass pass, const std::function<bool()>& shouldContinue);
    // Traces `count` light paths from number `first` on, counted from the first of sample `firstSample`, and adds what they bring to the
    // pixels from `pixel` on to `splats`. Returns nothing if `shouldContinue` ended it; what is in `splats` is then of no use.
    std::optional<PassSeconds> traceLight(const SplatBuffer& splats, std::uint32_t pixel, std::uint32_t firstSample, std::uint32_t first,
                                          std::uint32_t count, const std::function<bool()>& shouldContinue);
    // Traces one sample of one pixel, and adds it to no film. If the watch takes radiance, returns what it has left.
    PathRadiance traceSample(std::uint32_t pixel, std::uint32_t sample, const PathWatch& watch = nullptr);
    // Traces a pass that is added to no film, and calls `watch` after each kernel.
    void watch(const Tile& tile, Pass pass, const PathWatch& watch);
    // Traces rays alone, at most the settings' pathCapacity, between passes. Uses the wavefront's kernels: throws
    // std::bad_optional_access with the persistent schedule, which does not compile them.
    std::vector<PathHit> traceRays(const Tile& tile, std::span<const PathRay> rays);
    // Whether each is unoccluded. Light that has met one surface must count (--bounces 1 or more).
    std::vector<bool> traceShadowRays(const Tile& tile, std::span<const ShadowRay> rays);
    // Folds the open blocks of all pixels, chosen or not, into their pages.
    void closeBlocks(const Tile& tile);
    // Chooses the pixels that have `samples` samples and still need some.
    void choosePixels(Tile& tile, std::uint32_t samples);

    const PathBuffers& paths() const { return shared_.paths; }
    Schedule schedule() const { return schedule_; }  // never Auto
    double compileSeconds() const { return compileSeconds_; }
    const std::map<std::string, KernelStatistics>& statistics() const { return statistics_; }
    // Counters on the device too.
    void clearStatistics();

private:
    const KernelSet& kernels() const { return compiled_->set; }
    void compile();
    BufferMap constants() const;
    void tracePaths(Recording& recording, const Tile& tile, Pass& pass);
    void traceByWavefront(Recording& recording, const Tile& tile, Pass& pass);
    void tracePersistently(Recording& recording, const Tile& tile, Pass& pass);
    void recordBounce(Recording& recording, const Bindings& bindings, const Pass& pass) const;
    void recordTrace(Recording& recording, const std::optional<Kernel>& production, const std::optional<Kernel>& course,
                     const Bindings& bindings, const Pass& pass, std::uint64_t groupsOffset) const;
    void recordSize(Recording& recording, const Bindings& bindings, Pass pass, std::uint32_t queues) const;
    bool isAnyPathAlive(const Recording& recording) const;
    std::uint32_t groupsOf(std::uint32_t count) const;

    Device& device_;
    RenderSettings settings_;
    std::uint32_t lightCount_;
    Schedule schedule_;
    std::map<std::string, KernelStatistics> statistics_;
    double compileSeconds_ = 0.0;

    std::optional<SharedResources> own_;  // absent if they belong to another one
    SharedResources& shared_;
    DeviceParameters parameters_;
    CourseEstimators course_;
    std::shared_ptr<const CompiledKernels> compiled_, spare_;
};

}  // namespace glim
