#include "host/render/replay.hpp"

#include "host/render/check_status.hpp"
#include "host/render/pass_tracer.hpp"
#include "shaders/shared/limits.h"

#include <cstring>

namespace glim {
namespace {

template <class T>
T firstOf(const Buffer& buffer)
{
    return download<T>(buffer, 1)[0];
}

// Records the only path after each kernel. What a kernel adds is taken out at once, so that it is known exactly.
class PathRecorder {
public:
    PathRecorder(std::vector<PathVertex>& vertices, std::uint32_t maxBounces, std::uint32_t refCount)
        : vertices_(vertices),
          maxBounces_(maxBounces),
          refCount_(refCount)
    {}

    void record(const std::string& kernel, const CoursePass& at, PathBuffers& paths)
    {
        const bool whole = at.lightRound.endRef == refCount_;  // brute force: the last of several dispatches
        if (kernel == "trace_closest" || (kernel == "course_trace_closest" && whole)) {
            alive_ = paths.readRounds()[at.pass.round].paths.count > 0;
            isScattered_ = alive_ && firstOf<PathHit>(paths.hits()).primitiveRef == kScatteredRef;
            if (alive_ && !isScattered_) {
                beginVertex(paths);
            }
            return;
        }
        if (isScattered_) {
            recordScattering(kernel, at.pass, paths);
            return;
        }
        if (!alive_) {
            return;
        }
        if (kernel == "shade_surface") {
            const PathNote note = paths.takeNote();
            takeSampled(note, true, paths);
            endVertex(note, at.pass, paths);
        } else if (kernel == "course_sample_lights") {
            takeSampled(paths.takeNote(), at.lightRound.addsEmission != 0, paths);
        } else if (kernel == "course_sample_hemisphere") {
            vertices_.back().sampledLights.emplace_back().hemisphere = true;
            ray_ = firstOf<ShadowRay>(paths.shadowRays());
        } else if (kernel == "trace_shadow" || (whole && (kernel == "course_trace_shadow" || kernel == "course_trace_hemisphere"))) {
            takeTraced(at.pass, paths);
        } else if (kernel == "course_bounce") {
            endVertex(paths.takeNote(), at.pass, paths);
        }
    }

private:
    void recordScattering(const std::string& kernel, const Pass& pass, PathBuffers& paths)
    {
        if (kernel == "shade_surface" && !vertices_.empty() && paths.readRounds()[pass.round + 1].paths.count == 0) {
            vertices_.back().end = PathEnd::WithinVolume;
        }
    }

    void beginVertex(PathBuffers& paths)
    {
        PathVertex& vertex = vertices_.emplace_back();
        vertex.ray = firstOf<PathRay>(paths.rays());
        vertex.before = firstOf<PathState>(paths.states());
        vertex.bounce = vertex.before.bounce;
        vertex.hit = firstOf<PathHit>(paths.hits());
        paths.takeNote();
        paths.takeRadiance();
    }

    // Records the light that the ray has hit, if the kernel adds it, and the light that was sampled.
    void takeSampled(const PathNote& note, bool addsEmission, PathBuffers& paths)
    {
        PathVertex& vertex = vertices_.back();
        if (addsEmission) {
            vertex.surface = note;
            vertex.emitted = paths.takeRadiance();
        }
        if (note.light != kNoLightIndex) {
            vertex.sampledLights.emplace_back().note = note;
        }
        ray_ = firstOf<ShadowRay>(paths.shadowRays());  // brute force changes it
    }

    void takeTraced(const Pass& pass, PathBuffers& paths)
    {
        if (paths.readRounds()[pass.round].shadowRays.count > 0) {
            SampledLight& last = vertices_.back().sampledLights.back();
            last.hasShadowRay = true;
            last.ray = ray_;
            last.added = paths.takeRadiance();
        }
    }

    void endVertex(const PathNote& note, const Pass& pass, PathBuffers& paths)
    {
        PathVertex& vertex = vertices_.back();
        vertex.bsdf = note;
        vertex.after = firstOf<PathState>(paths.states());
        const bool continues = paths.readRounds()[pass.round + 1].paths.count > 0;
        vertex.end = continues                                    ? PathEnd::Continues
                     : vertex.hit.primitiveRef == kNoPrimitiveRef ? PathEnd::Missed
                     : vertex.bounce == maxBounces_               ? PathEnd::LastBounce
                     : vertex.bsdf.continuation > 0.0F            ? PathEnd::Roulette
                     : vertex.bsdf.throughput == glm::vec3(0.0F)  ? PathEnd::Absorbed
                                                                  : PathEnd::Redundant;
    }

    std::vector<PathVertex>& vertices_;
    std::uint32_t maxBounces_, refCount_;
    ShadowRay ray_{};
    bool alive_ = false, isScattered_ = false;
};

// The settings for one path, which does not depend on the others of its render.
RenderSettings settingsOfOne(RenderSettings settings)
{
    settings.adaptive = Adaptive::Off;
    settings.suspects = 0;
    settings.notes = true;
    settings.schedule = Schedule::Wavefront;  // the path can be looked at between its kernels
    settings.pathCapacity = kBlockSamples;
    settings.caustics = settings.caustics && !settings.catcher;  // as in the film
    settings.lightGroups.clear();
    settings.catcher = false;  // the path with all objects is the same
    return settings;
}

}  // namespace

void watchPass(RenderResources& resources, const Tile& tile, Pass pass, const PathWatch& watch)
{
    Recording::Watch watchKernel;
    if (watch) {
        watchKernel = [&](const Kernel& kernel, std::span<const std::byte> push) {
            CoursePass dispatched{};
            std::memcpy(&dispatched, push.data(), push.size());
            watch(kernel.name(), dispatched, resources.paths());
        };
    }
    Recording recording(resources.device, resources.statistics, watchKernel);
    PassTracer(resources).tracePaths(recording, tile, pass);
    recording.finish();
}

PathRadiance traceSample(RenderResources& resources, std::uint32_t pixel, std::uint32_t sample, const PathWatch& watch)
{
    const std::unique_ptr<Tile> tile = resources.makeTile(pixel, 1);
    Pass pass = tile->pass();
    pass.pixelCount = pass.sampleCount = 1;
    pass.firstSample = sample;
    watchPass(resources, *tile, pass, watch);
    return resources.paths().takeRadiance();
}

Replay::Replay(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : maxBounces_(pathLengths(settings).maxBounces),
      refCount_(static_cast<std::uint32_t>(scene.primitiveRefs.size()) / kPrimitiveRefTexels),
      resources_(device, scene, camera, settingsOfOne(settings))
{}

ReplayedPath Replay::trace(std::uint32_t pixel, std::uint32_t sample)
{
    ReplayedPath path;
    path.radiance = traceSample(resources_, pixel, sample);
    PathRecorder recorder(path.vertices, maxBounces_, refCount_);
    traceSample(resources_, pixel, sample,
                [&](const std::string& kernel, const CoursePass& pass, PathBuffers& paths) { recorder.record(kernel, pass, paths); });
    refuseBrokenStatus(resources_.device.description(), resources_.paths());
    return path;
}

}  // namespace glim
