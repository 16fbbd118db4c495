#include "host/bench/picture_rate.hpp"

#include "host/render/measure_schedules.hpp"

#include <algorithm>

namespace glim {
namespace {

RenderSettings settingsOf(const RenderSettings& asked, Schedule schedule)
{
    RenderSettings settings = asked;
    settings.sampleEnd = kPictureSamples;
    settings.schedule = schedule;
    return settings;
}

// Of all renders so far.
double traceSecondsOf(const Renderer& renderer)
{
    const auto& kernels = renderer.statistics().kernels;
    const auto secondsOf = [&](const char* name) { return kernels.contains(name) ? kernels.at(name).seconds : 0.0; };
    return secondsOf("trace_closest") + secondsOf("trace_shadow");
}

}  // namespace

std::optional<PictureRate> measurePictureRate(Device& device, const FlatScene& scene, const FlatCamera& camera,
                                              const RenderSettings& settings, const std::function<bool(int round)>& goesOn)
{
    Renderer wavefront(device, scene, camera, settingsOf(settings, Schedule::Wavefront));
    Renderer renderer(wavefront, scene, camera, settingsOf(settings, settings.schedule));
    std::vector<double> seconds, traceSeconds;
    for (int round = -1; round < kPictureRenders; ++round) {
        if (!goesOn(std::max(0, round))) {
            return std::nullopt;
        }
        const double before = traceSecondsOf(wavefront);
        timeRender(wavefront, camera);
        const double took = timeRender(renderer, camera);
        if (round >= 0) {  // uncounted the first time: what is dispatched first takes longer
            seconds.push_back(took);
            traceSeconds.push_back(traceSecondsOf(wavefront) - before);
        }
    }
    const RenderStatistics& all = renderer.statistics();  // rays are those of the wavefront too, whose buffers it has
    constexpr std::uint64_t kRenders = kPictureRenders + 1;
    return PictureRate{all.schedule,
                       all.samples / kRenders,
                       all.cameraAndBounceRays / (2 * kRenders),
                       all.shadowRays / (2 * kRenders),
                       spreadOf(seconds),
                       spreadOf(traceSeconds).median};
}

}  // namespace glim
