#include "host/render/learn_guide.hpp"

#include "host/error.hpp"
#include "host/render/build_guide.hpp"
#include "host/render/check_status.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glim {
namespace {

constexpr double kLearningPixels = 16384.0;
constexpr std::uint32_t kSamples = 4;  // of a pixel, in a portion
constexpr std::uint32_t kPasses = 5;   // each has twice the portions of the one before, and is guided by what that has learned
constexpr std::uint32_t kPathsBetweenPauses = 8192;  // a twentieth of a second on two cores; no guide depends on it
// No film has these samples, so no picture is guided by what its own samples have met.
constexpr std::uint32_t kFirstLearningSample = 0x80000000U;

RenderSettings learningSettings(const RenderSettings& settings)
{
    RenderSettings learning;
    const double scale = std::min(1.0, std::sqrt(kLearningPixels / (static_cast<double>(settings.width) * settings.height)));
    const auto sideOf = [&](std::uint32_t side) { return static_cast<std::uint32_t>(std::max(1.0, std::floor(scale * side))); };
    learning.width = sideOf(settings.width);
    learning.height = sideOf(settings.height);
    learning.bounces = settings.bounces;
    learning.caustics = settings.caustics;
    learning.workgroup = settings.workgroup;
    learning.schedule = Schedule::Persistent;
    learning.sampler = Sampler::Independent;
    learning.learns = true;
    return learning;
}

class Learner {
public:
    explicit Learner(RenderResources& resources, const LearningPause& pause = nullptr)
        : resources_(resources),
          pause_(pause),
          capacity_(std::min({resources_.paths().capacity(), resources_.guide->recordedPaths(), pause ? kPathsBetweenPauses : ~0U}))
    {}

    // Nothing if a pause has ended it.
    std::optional<Guide> learn()
    {
        const auto start = Clock::now();
        Guide guide = emptyGuide();
        std::uint32_t sample = kFirstLearningSample;
        for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
            resources_.setGuide(guide);
            tile_ = resources_.makeTile(0, resources_.settings.pixelCount());
            records_.clear();
            for (std::uint32_t portion = 0; portion < 1U << pass; ++portion, sample += kSamples) {
                if (!trace(sample)) {
                    return std::nullopt;
                }
            }
            if (!goesOn(false)) {
                return std::nullopt;
            }
            guide = buildGuide(records_);
            if (!goesOn(true)) {
                return std::nullopt;
            }
        }
        guide.paths = std::uint64_t{sample - kFirstLearningSample} * resources_.settings.pixelCount();
        guide.seconds = secondsSince(start);
        return guide;
    }

private:
    bool goesOn(bool needsDevice) const { return !pause_ || pause_(needsDevice); }

    bool trace(std::uint32_t sample)
    {
        const std::uint32_t pixels = resources_.settings.pixelCount(), atOnce = std::max(1U, capacity_ / kSamples);
        for (std::uint32_t first = 0; first < pixels; first += atOnce) {
            if (!goesOn(true)) {
                return false;
            }
            Pass pass = tile_->pass();
            pass.firstPixel = first;
            pass.pixelCount = std::min(atOnce, pixels - first);
            pass.firstSample = sample;
            pass.sampleCount = kSamples;
            Recording recording(resources_.device, resources_.statistics);
            PassTracer(resources_).tracePaths(recording, *tile_, pass);
            refuseBrokenStatus(resources_.device.description(), resources_.paths());
            const auto records =
                download<GuideRecord>(resources_.guide->records(), std::size_t{pass.pixelCount} * kSamples * kGuideRecords);
            std::copy_if(records.begin(), records.end(), std::back_inserter(records_),
                         [](const GuideRecord& record) { return record.throughput > 0.0F; });
        }
        return true;
    }

    RenderResources& resources_;
    const LearningPause& pause_;
    const std::uint32_t capacity_;
    std::unique_ptr<Tile> tile_;
    std::vector<GuideRecord> records_;
};

void refuseSlowCompiler(const DeviceDescription& device)
{
    if (!rulesOf(device.deviceClass).compilesPaths) {
        throw DeviceError(MessageId::DeviceLimit,
                          {part::place("--guiding"), " ", part::value("on"), ": device \"", device.name,
                           "\" would take minutes to compile the kernel that learns; expected ", part::expected("--guiding off"), "."});
    }
}

}  // namespace

std::shared_ptr<const Guide> learnGuide(const Renderer& renderer, const FlatScene& scene, const FlatCamera& camera,
                                        const RenderSettings& settings, const LearningPause& pause)
{
    refuseSlowCompiler(renderer.resources().device.description());
    RenderResources resources(renderer.resources(), scene, camera, learningSettings(settings));
    std::optional<Guide> guide = Learner(resources, pause).learn();
    return guide ? std::make_shared<const Guide>(*std::move(guide)) : nullptr;
}

std::shared_ptr<const Guide> learnGuide(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings)
{
    refuseSlowCompiler(device.description());
    RenderResources resources(device, scene, camera, learningSettings(settings));
    return std::make_shared<const Guide>(*Learner(resources).learn());
}

}  // namespace glim
