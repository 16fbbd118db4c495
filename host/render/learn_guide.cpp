#include "host/render/learn_guide.hpp"

#include "host/error.hpp"
#include "host/render/build_guide.hpp"
#include "host/render/check_status.hpp"
#include "host/render/noise.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace glim {
namespace {

constexpr double kLearningPixels = 8192.0;
constexpr std::uint32_t kSamples = 4;  // of a pixel, in a portion
// Each pass has twice the portions of the one before, and is guided by what those before have learned. From the fourth on, one that brings
// less than a tenth off the work is the last.
constexpr std::uint32_t kLeastPasses = 4, kMostPasses = 7;
constexpr double kHelps = 0.9;
constexpr std::uint32_t kPathsBetweenPauses = 8192;  // a twentieth of a second on two cores; no guide depends on it
// No film has these samples, so no picture is guided by what its own samples have met.
constexpr std::uint32_t kFirstLearningSample = 0x80000000U;
// A picture with less variance is done before learning pays.
constexpr double kHard = 1.0;
constexpr double kLookups = 1.55;               // time of a guided ray over that of another (tests/bench/guiding.md)
constexpr double kLookupsOfScatterings = 1.25;  // and over that, if scatterings are guided too

RenderSettings learningSettings(const RenderSettings& settings, bool scatterings)
{
    RenderSettings learning = pilotSettings(settings, pilotSizeAtMost(settings, kLearningPixels));
    learning.schedule = Schedule::Persistent;
    learning.sampler = Sampler::Independent;
    learning.learns = true;
    learning.guide = std::make_shared<const Guide>(emptyGuide(scatterings));
    return learning;
}

class Learner {
public:
    // `settings`: learningSettings().
    Learner(const Renderer& renderer, NoiseMeter& meter, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
            const LearningObserver& observer)
        : resources_(renderer.resources(), scene, camera, settings),
          meter_(meter),
          observer_(observer),
          atOnce_(
              std::max(1U, std::min({resources_.paths().capacity(), resources_.guide->recordedPaths(), kPathsBetweenPauses}) / kSamples))
    {}

    // Null if the observer has ended it.
    std::shared_ptr<Guide> learn()
    {
        auto best = std::make_shared<Guide>(*resources_.settings.guide);
        for (std::uint32_t pass = 0; pass < kMostPasses; ++pass) {
            resources_.setGuide(*best);
            tile_ = resources_.makeTile(0, resources_.settings.pixelCount());
            for (std::uint32_t i = 0; i < 1U << pass; ++i, ++portions_) {
                if (!trace(kFirstLearningSample + portions_ * kSamples)) {
                    return nullptr;
                }
            }
            if (!goesOn(false)) {
                return nullptr;
            }
            auto guide = std::make_shared<Guide>(builder_.build());
            if (!goesOn(true)) {
                return nullptr;
            }
            guide->paths = std::uint64_t{portions_} * kSamples * resources_.settings.pixelCount();
            if (pass + 1 >= kLeastPasses) {
                const auto noise = meter_.measure(guide, [this] { return goesOn(true); });
                if (!noise) {
                    return nullptr;
                }
                const double before = std::exchange(work_, std::min(work_, noise->work()));
                if (noise->work() > before) {
                    break;
                }
                best = std::move(guide);
                if (noise->work() > kHelps * before) {
                    break;
                }
            } else {
                best = std::move(guide);
            }
        }
        return best;
    }

    double work() const { return work_; }  // by the guide

private:
    bool goesOn(bool needsDevice) const { return observer_({static_cast<double>(portions_) / ((1U << kMostPasses) - 1), needsDevice}); }

    bool trace(std::uint32_t sample)
    {
        const std::uint32_t pixels = resources_.settings.pixelCount();
        for (std::uint32_t first = 0; first < pixels; first += atOnce_) {
            if (!goesOn(true)) {
                return false;
            }
            Pass pass = tile_->pass();
            pass.firstPixel = first;
            pass.pixelCount = std::min(atOnce_, pixels - first);
            pass.firstSample = sample;
            pass.sampleCount = kSamples;
            Recording recording(resources_.device, resources_.statistics);
            PassTracer(resources_).tracePaths(recording, *tile_, pass);
            refuseBrokenStatus(resources_.device.description(), resources_.paths());
            builder_.add(download<GuideRecord>(resources_.guide->records(), std::size_t{pass.pixelCount} * kSamples * kGuideRecords));
        }
        return true;
    }

    RenderResources resources_;
    NoiseMeter& meter_;
    const LearningObserver& observer_;
    const std::uint32_t atOnce_;  // pixels
    std::unique_ptr<Tile> tile_;
    GuideBuilder builder_{guideScatterings(resources_.settings.guide->texels)};
    std::uint32_t portions_ = 0;  // traced
    double work_ = std::numeric_limits<double>::infinity();
};

// Whether the device can learn. Throws if it is to.
bool canLearn(const DeviceDescription& device, GuideUse use)
{
    const bool compiles = rulesOf(device.deviceClass).compilesPaths;
    if (!compiles && use == GuideUse::Always) {
        throw DeviceError(MessageId::DeviceLimit,
                          {part::place("--guiding"), ": device \"", device.name,
                           "\" would take minutes to compile the kernel that learns; expected ", part::expected("--guiding off"), "."});
    }
    return compiles;
}

}  // namespace

LearnedGuide learnGuide(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings,
                        GuideUse use, const LearningObserver& observer)
{
    if (!canLearn(renderer.resources().device.description(), use)) {
        return {};
    }
    NoiseMeter meter(renderer, scene, camera, settings);
    std::optional<Noise> plain;
    if (use == GuideUse::IfItPays) {
        plain = meter.measure(nullptr, [&] { return observer({0.0, true}); });
        if (!plain || plain->variance < kHard) {
            return {};
        }
    }
    // Where media scatter, one for surfaces alone and one for scatterings too.
    const auto start = Clock::now();
    const std::uint32_t kinds = (scene.features & kFeatureScattering) != 0 ? 2 : 1;
    std::shared_ptr<Guide> best;
    double leastWork = 0.0;
    for (std::uint32_t kind = 0; kind < kinds; ++kind) {
        const LearningObserver ofKind = [&](LearningPause pause) {
            pause.done = (kind + pause.done) / kinds;
            return observer(pause);
        };
        Learner learner(renderer, meter, scene, camera, learningSettings(settings, kind == 1), ofKind);
        auto guide = learner.learn();
        if (!guide) {
            return {};
        }
        const double work = learner.work() * (guideScatterings(guide->texels) ? kLookupsOfScatterings : 1.0);
        if (!best || work < leastWork) {
            best = std::move(guide);
            leastWork = work;
        }
    }
    best->seconds = secondsSince(start);
    if (plain) {
        const double gain = plain->work() / (kLookups * leastWork);
        return {gain > 1.0 ? std::move(best) : nullptr, gain};
    }
    return {std::move(best), std::nullopt};
}

LearnedGuide learnGuide(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings, GuideUse use)
{
    if (!canLearn(device.description(), use)) {
        return {};
    }
    RenderSettings small = learningSettings(settings, false);
    small.learns = false;
    small.guide = use == GuideUse::Always ? small.guide : nullptr;  // so that one set of kernels is enough
    return learnGuide(Renderer(device, scene, camera, small), scene, camera, settings, use, [](const LearningPause&) { return true; });
}

}  // namespace glim
