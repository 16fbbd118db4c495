// Renders: sweeps over the picture, pass after pass.
#pragma once

#include "host/render/film.hpp"
#include "host/render/wavefront.hpp"

#include <chrono>
#include <functional>

namespace glim {

struct RenderStatistics {
    double uploadSeconds = 0.0, compileSeconds = 0.0, renderSeconds = 0.0;
    std::map<std::string, KernelStatistics> kernels;
    double longestDispatch = 0.0;  // seconds, on the device, after compilation
    std::uint64_t samples = 0;     // over all pixels
    std::uint64_t cameraAndBounceRays = 0, shadowRays = 0;
    std::uint32_t loopCaps = 0, overflows = 0;  // of Status; a render that had any has thrown
    std::uint32_t nonFinite = 0;   // samples left out
    std::vector<Located> located;  // the first of them
    std::uint64_t peakDeviceMemory = 0;  // bytes
};

struct RenderProgress {
    std::uint64_t samples, totalSamples;  // over all pixels; of an adaptive render, total if no further pixel is done early
    double seconds;
};

// Called several times a second; false ends the render after the pass under way or, if that takes seconds, without it.
using RenderObserver = std::function<bool(const RenderProgress&)>;

class Renderer {
public:
    // Uploads the scene and compiles the kernels for what it needs.
    Renderer(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Samples until sampleEnd, the stop rule, the time limit or the observer ends it. Every pixel of the film has what was
    // finished; the counts say how much. Throws DeviceError if the driver cut a loop short or a queue overflowed: no film is
    // better than a wrong one. Once per object.
    Film render(const RenderObserver& observer);

    const RenderStatistics& statistics() const { return statistics_; }

private:
    using Clock = std::chrono::steady_clock;

    bool isAdaptive() const { return settings_.adaptive != Adaptive::Off; }
    std::uint32_t sweepEnd(std::uint32_t sample) const;
    bool sweep(std::uint32_t first, std::uint32_t count, bool endsBlock, const RenderObserver& observer);
    bool runPass(const Slab& slab, const Pass& pass, const RenderObserver& observer);
    bool asks(const RenderObserver& observer);
    void resizePasses(std::uint32_t paths, const Wavefront::Seconds& seconds);
    std::uint64_t choosePixels();
    void foldPages(Film& film, bool closesBlocks);
    bool isOver(const RenderObserver& observer);
    void refuseBrokenStatus() const;
    void readCounters();

    Device& device_;
    RenderSettings settings_;
    std::string fingerprint_;
    RenderStatistics statistics_;
    Clock::time_point start_;
    std::uint32_t pathsPerPass_;
    std::uint64_t plannedSamples_;
    bool ended_ = false;  // by the observer

    std::unique_ptr<Wavefront> wavefront_;
    std::vector<std::unique_ptr<Slab>> slabs_;
};

}  // namespace glim
