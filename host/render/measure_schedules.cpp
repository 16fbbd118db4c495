#include "host/render/measure_schedules.hpp"

#include "host/clock.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// 2^17 paths: more than any GPU traces at once.
constexpr std::uint32_t kSide = 128, kSamples = 8;
constexpr int kRounds = 5;

RenderSettings makeSettings(const RenderSettings& asked, Schedule schedule)
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

// By the device's own clock, which the load of the CPU does not slow. Infinite if the device has none.
double samplesPerSecond(Renderer& renderer, const FlatCamera& camera)
{
    const double before = renderer.statistics().passSeconds;
    timeRender(renderer, camera);
    return kSide * kSide * kSamples / (renderer.statistics().passSeconds - before);
}

}  // namespace

double timeRender(Renderer& renderer, const FlatCamera& camera)
{
    renderer.restart(camera, renderer.settings().seed);
    const auto start = Clock::now();
    renderer.render([](const RenderProgress&) { return true; });
    return secondsSince(start);
}

bool canMeasureSchedules(const RenderSettings& settings)
{
    RenderSettings wish = settings;
    wish.fastest = Schedule::Persistent;
    return settings.schedule == Schedule::Auto && chooseSchedule(wish, {}) == Schedule::Persistent;
}

Schedule ScheduleRates::fastest() const
{
    const auto isFaster = [](const std::vector<double>& a, const std::vector<double>& b) {
        return !a.empty() && std::ranges::equal(a, b, [](double x, double y) { return x > kScheduleMargin * y; });
    };
    return isFaster(persistent, wavefront) ? Schedule::Persistent : isFaster(wavefront, persistent) ? Schedule::Wavefront : Schedule::Auto;
}

ScheduleRates measureSchedules(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    Renderer wavefront(device, scene, camera, makeSettings(settings, Schedule::Wavefront));
    Renderer persistent(wavefront, scene, camera, makeSettings(settings, Schedule::Persistent));
    ScheduleRates rates;
    for (int round = 0; round <= kRounds; ++round) {
        const double first = samplesPerSecond(wavefront, camera), second = samplesPerSecond(persistent, camera);
        if (!std::isfinite(first) || !std::isfinite(second)) {
            return {};
        }
        if (round > 0) {  // the first warms up
            rates.wavefront.push_back(first);
            rates.persistent.push_back(second);
        }
    }
    return rates;
}

}  // namespace glim
