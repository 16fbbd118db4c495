#include "host/render/measure_schedules.hpp"

#include <algorithm>

namespace glim {
namespace {

// 2^17 paths: a tenth of a second on two cores, and more than any GPU traces at once.
constexpr std::uint32_t kSide = 128, kSamples = 8;
constexpr int kRounds = 3;

RenderSettings settingsOf(const RenderSettings& asked, Schedule schedule)
{
    RenderSettings settings = asked;
    settings.width = settings.height = kSide;
    settings.rows.reset();
    settings.sampleBegin = 0;
    settings.sampleEnd = kSamples;
    settings.adaptive = Adaptive::Off;
    settings.seconds.reset();
    settings.suspects = 0;
    settings.schedule = schedule;
    return settings;
}

double samplesPerSecond(Renderer& renderer, const FlatCamera& camera) { return kSide * kSide * kSamples / timeRender(renderer, camera); }

}  // namespace

double timeRender(Renderer& renderer, const FlatCamera& camera)
{
    renderer.restart(camera, renderer.settings().seed);
    const auto start = std::chrono::steady_clock::now();
    renderer.render([](const RenderProgress&) { return true; });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool canMeasureSchedules(const RenderSettings& settings)
{
    RenderSettings wish = settings;
    wish.fastest = Schedule::Persistent;
    return settings.schedule == Schedule::Auto && chooseSchedule(wish, {}) == Schedule::Persistent;
}

ScheduleRates measureSchedules(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    Renderer wavefront(device, scene, camera, settingsOf(settings, Schedule::Wavefront));
    Renderer persistent(wavefront, scene, camera, settingsOf(settings, Schedule::Persistent));
    ScheduleRates best{0.0, 0.0};
    for (int round = 0; round < kRounds; ++round) {
        best.wavefront = std::max(best.wavefront, samplesPerSecond(wavefront, camera));
        best.persistent = std::max(best.persistent, samplesPerSecond(persistent, camera));
    }
    return best;
}

}  // namespace glim
