#include "host/bench/kernel_rates.hpp"

#include "host/bench/trace_timer.hpp"

#include <algorithm>
#include <deque>

namespace glim {
namespace {

struct Variant {
    std::string name;
    RenderSettings settings;
    SceneFeatures features;
};

std::vector<Variant> variantsOf(const RenderSettings& settings, const SceneFeatures& features, const DeviceDescription& device)
{
    std::vector<Variant> variants{{"as rendered", settings, features}};
    for (const std::uint32_t workgroup : {32U, 64U, 128U, 256U}) {
        if (workgroup != settings.workgroup && workgroup <= device.maxWorkgroup) {
            variants.push_back({"workgroups of " + std::to_string(workgroup), settings, features});
            variants.back().settings.workgroup = workgroup;
        }
    }
    SceneFeatures every;
    every.spheres = every.slivers = every.smooth = every.mirrors = every.glasses = true;
    every.triangleLights = every.sphereLights = every.punctualLights = every.environment = true;
    variants.push_back({"for any scene", settings, every});
    variants.push_back({"Moller-Trumbore", settings, features});
    variants.back().settings.intersector = Intersector::MollerTrumbore;
    return variants;
}

// A set of rays and the seconds of each variant, round after round.
template <class Ray>
class Contest {
public:
    Contest(std::string name, std::span<const Ray> rays) : name_(std::move(name)), rays_(rays) {}

    // Uncounted the first time: what is dispatched first takes longer.
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
            rates.push_back({name_, variants[i].name, rays_.size(), spreadOf(rates_[i]), 0.0});
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

}  // namespace

Spread spreadOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back()};
}

std::vector<KernelRate> measureKernelRates(Device& device, FlatScene scene, const FlatCamera& camera, const RenderSettings& settings,
                                           const std::function<bool(int round)>& goesOn)
{
    const std::vector<Variant> variants = variantsOf(settings, scene.features, device.description());
    std::deque<TraceTimer> timers;
    for (const Variant& variant : variants) {
        scene.features = variant.features;
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
        if (!goesOn(std::max(0, round))) {
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

}  // namespace glim
