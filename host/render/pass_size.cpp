#include "host/render/pass_size.hpp"

#include "host/render/course_rounds.hpp"
#include "shaders/shared/limits.h"

#include <algorithm>

namespace glim {
namespace {

// The target for the longest dispatch of a pass: far below any watchdog.
constexpr double kTargetDispatchSeconds = 0.05;
// The target for a whole pass is settings.passSeconds, since --time ends between passes; many rounds of direct light or long brute force
// make many dispatches. But the longest dispatch gets at least this share of it, or else starting dispatches costs more than their work:
// at 32x32 with passes of a second, 512 rounds took three times as long with 1 ms for the longest as with 10, since those of later
// bounces have a hundredth of its rays.
constexpr double kMinDispatchShare = 0.01;
// The paths of a first pass, for one round of direct light and rays of kUsualSteps steps.
constexpr std::uint32_t kFirstPassPaths = 1U << 14;
constexpr std::uint64_t kUsualSteps = 64;
// The next pass may cost much more than the last one, as where the sky ends. So it is no larger than this unless the longest dispatch is
// to take less than kFastDispatchSeconds.
constexpr std::uint32_t kUnsurePaths = 1U << 17;
constexpr double kFastDispatchSeconds = 0.005;

std::uint32_t firstPassPaths(const FlatScene& scene, const RenderSettings& settings, std::uint32_t capacity)
{
    const std::uint64_t refs = scene.primitiveRefs.size() / kPrimitiveRefTexels;
    const std::uint64_t steps = settings.course.accelerator == Accelerator::None ? std::max(refs, kUsualSteps) : kUsualSteps;
    const std::uint64_t work = steps * lightRounds(scene, settings).size();
    return std::clamp(static_cast<std::uint32_t>(kFirstPassPaths * kUsualSteps / work), kBlockSamples, capacity);
}

}  // namespace

PassSize::PassSize(const FlatScene& scene, const RenderSettings& settings, std::uint32_t capacity)
    : paths_(firstPassPaths(scene, settings, capacity)),
      capacity_(capacity),
      passSeconds_(settings.passSeconds)
{}

// The short pass at the end of a sweep says little about a full one, unless it took too long.
void PassSize::learn(std::uint32_t paths, const PassSeconds& seconds)
{
    if (seconds.longest <= kTargetDispatchSeconds && (seconds.longest <= 0.0 || 2 * std::uint64_t{paths} <= paths_)) {
        return;
    }
    const double byPass = passSeconds_ * std::max(1.0 / seconds.total, kMinDispatchShare / seconds.longest);
    const double scale = std::clamp(std::min(kTargetDispatchSeconds / seconds.longest, byPass), 0.5, 2.0);
    const double fast = std::max(paths * (kFastDispatchSeconds / seconds.longest), double{kUnsurePaths});
    paths_ = static_cast<std::uint32_t>(std::clamp(paths * scale, double{kBlockSamples}, std::min(fast, double(capacity_))));
}

}  // namespace glim
