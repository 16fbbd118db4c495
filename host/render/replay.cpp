#include "host/render/replay.hpp"

#include "host/render/check_status.hpp"
#include "shaders/shared/limits.h"

namespace glim {
namespace {

template <class T>
T firstOf(const Buffer& buffer)
{
    return download<T>(buffer, 1)[0];
}

// Looks at the only path after each kernel. What a kernel adds is taken away at once, so that it is known exactly.
class PathRecorder {
public:
    explicit PathRecorder(std::vector<PathVertex>& vertices) : vertices_(vertices) {}

    void look(const std::string& kernel, const Pass& pass, PathBuffers& paths)
    {
        const bool whole = pass.endRecord == pass.recordCount;  // brute force: the last of several dispatches
        if (kernel == "trace_closest" && whole) {
            alive_ = firstOf<QueueSizes>(paths.queueSizes()).closest > 0;
            if (alive_) {
                beginVertex(pass, paths);
            }
        } else if (alive_ && kernel == "sample_lights") {
            takeSampled(pass, paths);
        } else if (alive_ && kernel == "sample_hemisphere") {
            vertices_.back().tries.emplace_back().hemisphere = true;
        } else if (alive_ && (kernel == "trace_shadow" || kernel == "trace_hemisphere") && whole) {
            takeTraced(paths);
        } else if (alive_ && kernel == "bounce") {
            endVertex(pass, paths);
        }
        if (kernel == "sample_lights" || kernel == "sample_hemisphere") {
            ray_ = firstOf<ShadowRay>(paths.shadowRays());  // brute force changes it
        }
    }

private:
    void beginVertex(const Pass& pass, PathBuffers& paths)
    {
        PathVertex& vertex = vertices_.emplace_back();
        vertex.bounce = pass.bounce;
        vertex.ray = firstOf<PathRay>(paths.rays());
        vertex.before = firstOf<PathState>(paths.states());
        vertex.hit = firstOf<PathHit>(paths.hits());
        paths.takeNote();
        paths.takeRadiance();
    }

    void takeSampled(const Pass& pass, PathBuffers& paths)
    {
        PathVertex& vertex = vertices_.back();
        const PathNote note = paths.takeNote();
        if (pass.addsFound != 0) {
            vertex.met = note;
            vertex.found = paths.takeRadiance();
        }
        if (note.light != kNothing) {
            vertex.tries.emplace_back().note = note;
        }
    }

    void takeTraced(PathBuffers& paths)
    {
        if (firstOf<QueueSizes>(paths.queueSizes()).shadow > 0) {
            LightTry& last = vertices_.back().tries.back();
            last.asked = true;
            last.ray = ray_;
            last.added = paths.takeRadiance();
        }
    }

    void endVertex(const Pass& pass, PathBuffers& paths)
    {
        PathVertex& vertex = vertices_.back();
        vertex.scattered = paths.takeNote();
        vertex.after = firstOf<PathState>(paths.states());
        const bool goesOn = firstOf<QueueTails>(paths.queueTails()).next > 0;
        vertex.fate = goesOn                                          ? PathFate::GoesOn
                      : vertex.hit.record == kNoRecord                ? PathFate::Missed
                      : pass.bounce == pass.maxBounces                ? PathFate::LastBounce
                      : vertex.scattered.survival > 0.0F              ? PathFate::Roulette
                      : vertex.scattered.throughput == glm::vec3(0.0F) ? PathFate::Absorbed
                                                                      : PathFate::Redundant;
    }

    std::vector<PathVertex>& vertices_;
    ShadowRay ray_{};
    bool alive_ = false;
};

// One path needs no more, and every path is independent of who else is sampled.
RenderSettings settingsOfOne(RenderSettings settings)
{
    settings.adaptive = Adaptive::Off;
    settings.suspects = 0;
    settings.notes = true;
    settings.schedule = Schedule::Wavefront;  // between whose kernels there is something to see
    settings.pathCapacity = kBlockSamples;
    return settings;
}

}  // namespace

Replay::Replay(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
    : device_(device), wavefront_(device, scene, camera, settingsOfOne(settings))
{
}

ReplayedPath Replay::trace(std::uint32_t pixel, std::uint32_t sample)
{
    ReplayedPath path;
    path.radiance = wavefront_.traceSample(pixel, sample);
    PathRecorder recorder(path.vertices);
    wavefront_.traceSample(pixel, sample, [&](const std::string& kernel, const Pass& pass, PathBuffers& paths) {
        recorder.look(kernel, pass, paths);
    });
    refuseBrokenStatus(device_.description(), wavefront_.paths());
    return path;
}

}  // namespace glim
