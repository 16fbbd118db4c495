#include "host/bench/kernel_rates.hpp"

#include "host/bench/trace_timer.hpp"
#include "host/clock.hpp"
#include "host/render/course_rounds.hpp"
#include "host/render/renderer.hpp"

#include <algorithm>
#include <deque>

namespace glim {
namespace {

struct Variant {
    std::string name;
    RenderSettings settings;
    FeatureMask features;
    std::uint32_t stackLevels;
};

// Renders the whole picture again, from the same random numbers. Returns the seconds it took.
double timeRender(Renderer& renderer, const FlatCamera& camera)
{
    renderer.restart(camera, renderer.settings().seed);
    const auto start = Clock::now();
    renderer.render([](const RenderProgress&) { return true; });
    return secondsSince(start);
}

std::vector<Variant> variantsOf(const RenderSettings& settings, const FlatScene& scene, const DeviceDescription& device)
{
    std::vector<Variant> variants{{"as rendered", settings, scene.features, scene.stackLevels}};
    for (const std::uint32_t workgroup : {32U, 64U, 128U, 256U}) {
        if (workgroup != settings.workgroup && workgroup <= device.maxWorkgroup) {
            variants.push_back({"workgroups of " + std::to_string(workgroup), settings, scene.features, scene.stackLevels});
            variants.back().settings.workgroup = workgroup;
        }
    }
    variants.push_back({"for any scene", settings, kAllFeatures & ~(kFeatureCatcher | kFeatureLightGroups), kMaxStackLevels});
    if (!missingInCourse(scene.features)) {
        variants.push_back({"Moller-Trumbore", settings, scene.features, scene.stackLevels});
        variants.back().settings.course.intersector = Intersector::MollerTrumbore;
    }
    return variants;
}

// A set of rays and the seconds of each variant, round after round.
template <class Ray>
class Contest {
public:
    Contest(std::string name, std::span<const Ray> rays)
        : name_(std::move(name)),
          rays_(rays)
    {}

    // The first round does not count: first dispatches take longer.
    void run(std::deque<TraceTimer>& timers, bool counts)
    {
        rates_.resize(timers.size());
        for (std::size_t i = 0; i < timers.size() && !rays_.empty(); ++i) {
            const double seconds = timers[i].trace(rays_).seconds;
            if (counts) {
                rates_[i].push_back(static_cast<double>(rays_.size()) / seconds);
            }
        }
    }

    void report(const std::vector<Variant>& variants, std::vector<KernelRate>& rates) const
    {
        double best = 0.0;
        for (std::size_t i = 0; i < variants.size() && !rays_.empty(); ++i) {
            rates.push_back({name_, variants[i].name, rays_.size(), computeSpread(rates_[i]), 0.0});
            best = std::max(best, rates.back().rate.median);
        }
        for (KernelRate& rate : rates) {
            rate.ofBest = rate.rays == name_ ? rate.rate.median / best : rate.ofBest;
        }
    }

private:
    std::string name_;
    std::span<const Ray> rays_;
    std::vector<std::vector<double>> rates_;
};

RenderSettings makeSettings(const RenderSettings& asked, Schedule schedule)
{
    RenderSettings settings = asked;
    settings.sampleEnd = kPictureSamples;
    settings.schedule = schedule;
    return settings;
}

// Seconds of the tracing kernels in all renders so far.
double measureTraceSeconds(const Renderer& renderer)
{
    const auto& kernels = renderer.statistics().kernels;
    const auto getSeconds = [&](const char* name) { return kernels.contains(name) ? kernels.at(name).seconds : 0.0; };
    return getSeconds("trace_closest") + getSeconds("trace_shadow");
}

}  // namespace

Spread computeSpread(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back()};
}

std::vector<KernelRate> measureKernelRates(Device& device, FlatScene scene, const FlatCamera& camera, const RenderSettings& settings,
                                           const std::function<bool(int round)>& shouldContinue)
{
    const std::vector<Variant> variants = variantsOf(settings, scene, device.description());
    std::deque<TraceTimer> timers;
    for (const Variant& variant : variants) {
        scene.features = variant.features;
        scene.stackLevels = variant.stackLevels;
        if (timers.empty()) {
            timers.emplace_back(device, scene, camera, variant.settings);
        } else {
            timers.emplace_back(timers.front(), scene, camera, variant.settings);
        }
    }
    const RaySets& rays = timers.front().rays();
    Contest<PathRay> primary("primary", rays.primary), diffuse("diffuse", rays.diffuse);
    Contest<ShadowRay> shadow("shadow", rays.shadow);
    for (int round = -1; round < kRateRounds; ++round) {
        if (!shouldContinue(std::max(0, round))) {
            return {};
        }
        primary.run(timers, round >= 0);
        diffuse.run(timers, round >= 0);
        shadow.run(timers, round >= 0);
    }
    std::vector<KernelRate> rates;
    primary.report(variants, rates);
    diffuse.report(variants, rates);
    shadow.report(variants, rates);
    return rates;
}

std::optional<PictureRate> measurePictureRate(Device& device, const FlatScene& scene, const FlatCamera& camera,
                                              const RenderSettings& settings, const std::function<bool(int round)>& shouldContinue)
{
    Renderer wavefront(device, scene, camera, makeSettings(settings, Schedule::Wavefront));
    Renderer renderer(wavefront, scene, camera, makeSettings(settings, settings.schedule));
    std::vector<double> seconds, traceSeconds;
    for (int round = -1; round < kPictureRenders; ++round) {
        if (!shouldContinue(std::max(0, round))) {
            return std::nullopt;
        }
        const double before = measureTraceSeconds(wavefront);
        timeRender(wavefront, camera);
        const double took = timeRender(renderer, camera);
        if (round >= 0) {  // the first round does not count: first dispatches take longer
            seconds.push_back(took);
            traceSeconds.push_back(measureTraceSeconds(wavefront) - before);
        }
    }
    const RenderStatistics& all = renderer.statistics();  // its rays include the wavefront's, whose buffers it shares
    constexpr std::uint64_t kRenders = kPictureRenders + 1;
    return PictureRate{all.schedule,
                       all.samples / kRenders,
                       all.cameraAndBounceRays / (2 * kRenders),
                       all.shadowRays / (2 * kRenders),
                       computeSpread(seconds),
                       computeSpread(traceSeconds).median};
}

}  // namespace glim
