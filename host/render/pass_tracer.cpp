// A pass traces some samples of some pixels to their end. The wavefront:
//
//   generate_rays
//   per bounce:  trace_closest -> shade_surface -> trace_shadow (where lights are sampled)
//   accumulate, which does nothing while a path is alive
//
// The persistent schedule, in which one kernel traces path after path to its end:
//
//   generate_rays
//   until no path is left:  trace_paths
//   accumulate
//
// Nearly always one dispatch of trace_paths suffices: its threads put a path aside only once they have taken as many steps as a dispatch
// may take. No path waits for others, nor for memory between its steps.
//
// Caustics: trace_light_paths, and again for paths that were too long for one dispatch, for each sample of the picture; then add_splats.
//
// The host empties the queues of all rounds that it records; kernels count the workgroups that a queue needs as they fill it.
//
// AOVs insert show_aov before accumulate. The course's estimators have bounces of their own (course.hpp).
#include "host/render/pass_tracer.hpp"

#include "shaders/shared/bindings.h"

#include <algorithm>
#include <cstddef>

namespace glim {
namespace {

// Bounces recorded at once, after those that earlier passes needed: then the host checks whether any path is alive.
constexpr std::uint32_t kMoreBounces = 8;

// The first rounds of those recorded at once that had a path.
std::uint32_t countRounds(const std::vector<Round>& rounds)
{
    const auto empty = std::find_if(rounds.begin(), rounds.end(), [](const Round& round) { return round.paths.count == 0; });
    return static_cast<std::uint32_t>(empty - rounds.begin());
}

}  // namespace

std::optional<PassSeconds> PassTracer::trace(const Tile& tile, Pass pass, const std::function<bool()>& shouldContinue)
{
    Recording recording(resources_.device, resources_.statistics, portion(), shouldContinue);
    if (!traceToEnd(recording, tile, pass, [&](const Pass& end) { recordEnd(recording, tile, end); })) {
        return std::nullopt;
    }
    if (recording.total() > 0.0) {
        resources_.history.seconds = recording.total();
    }
    return PassSeconds{recording.longest(), recording.total()};
}

void PassTracer::tracePaths(Recording& recording, const Tile& tile, const Pass& pass)
{
    traceToEnd(recording, tile, pass, [](const Pass&) {});
}

std::uint32_t PassTracer::portion() const
{
    return resources_.history.seconds < resources_.settings.uncheckedSeconds ? kMaxTimed : resources_.settings.portion;
}

// Records as many rounds, bounces or dispatches of trace_paths, as may suffice, and the end of the pass, whose kernels do nothing while a
// path is alive. So the host waits once per pass, and rarely again. Returns false if the recording was stopped before the end.
bool PassTracer::traceToEnd(Recording& recording, const Tile& tile, Pass pass, const std::function<void(const Pass&)>& recordEnd)
{
    const bool persistent = kernels().tracePaths.has_value();
    const std::uint32_t last = persistent ? ~0U : pathLengths(resources_.settings).maxBounces;
    std::uint32_t& usual = resources_.history.rounds;
    std::uint32_t alive = pass.pixelCount * pass.sampleCount;
    // generate_rays fills the queue that bounce 0 reads: the next queue of the odd bindings.
    recording.dispatch(*kernels().generateRays, tile.bindings(1), pass, resources_.countGroups(alive));
    std::uint32_t rounds = usual;
    while (!recording.isStopped() && pass.bounce <= last) {
        const std::uint32_t before = pass.bounce;
        recordRounds(recording, alive, persistent ? rulesOf(resources_.device.description().deviceClass).pathsPerThread : 1);
        for (pass.round = 0; pass.round < std::min(rounds, kMaxRounds) && pass.bounce <= last; ++pass.round, ++pass.bounce) {
            recordRound(recording, tile.bindings(pass.bounce % 2), pass);
            if (!persistent && pass.bounce == 0 && rounds > 1) {
                recording.start();  // most paths are in bounce 0: the host records the others meanwhile
            }
        }
        recordEnd(pass);
        const bool isWhole = !recording.isStopped();
        recording.finish();
        const std::vector<Round> traced = resources_.paths().readRounds();
        alive = traced[pass.round].paths.count;
        if (isWhole && alive == 0) {
            // Of many paths the longest varies by a few surfaces.
            const std::uint32_t needed = before + countRounds(traced);
            usual = std::max(needed + (persistent ? 0 : 2 + needed / 8), usual - 1);
            return true;
        }
        rounds = persistent ? 1 : kMoreBounces;
    }
    return false;
}

// Begins round 0 with `paths`, of which a thread takes `share`.
void PassTracer::recordRounds(Recording& recording, std::uint32_t paths, std::uint32_t share) const
{
    const std::vector<Round> rounds = makeRounds(paths, resources_.countGroups((paths + share - 1) / share));
    recording.write(resources_.paths().rounds(), 0, std::span<const Round>(rounds));
}

// Adds the samples to the film.
void PassTracer::recordEnd(Recording& recording, const Tile& tile, const Pass& pass) const
{
    const std::uint32_t pixelGroups = resources_.countGroups(pass.pixelCount);
    recording.keepTogether(3);
    if (kernels().showAov) {  // of rays that end at their first hit
        recording.dispatch(*kernels().showAov, tile.bindings(0), pass, resources_.countGroups(pass.pixelCount * pass.sampleCount));
    }
    recording.dispatch(*kernels().accumulate, tile.bindings(0), pass, pixelGroups);
    resources_.course.recordLuminance(recording, kernels(), tile.bindings(0), pass, pixelGroups);
}

void PassTracer::recordRound(Recording& recording, const Bindings& bindings, const Pass& pass) const
{
    const Buffer& rounds = resources_.paths().rounds();
    if (kernels().tracePaths) {
        recording.dispatchIndirect(*kernels().tracePaths, bindings, pass, rounds, groupsOfPaths(pass.round));
        return;
    }
    if (usesCourseEstimators(resources_.settings)) {
        resources_.course.recordBounce(recording, kernels(), bindings, pass, rounds);
        return;
    }
    recording.dispatchIndirect(*kernels().traceClosest, bindings, pass, rounds, groupsOfPaths(pass.round));
    recording.dispatchIndirect(*kernels().shadeSurface, bindings, pass, rounds, groupsOfPaths(pass.round));
    const PathLengths lengths = pathLengths(resources_.settings);
    if (samplesLights(pass.bounce, lengths.maxBounces, lengths.min, resources_.lightCount)) {
        recording.dispatchIndirect(*kernels().traceShadow, bindings, pass, rounds, groupsOfShadowRays(pass.round));
    }
}

std::optional<PassSeconds> PassTracer::traceLight(const SplatBuffer::Band& band, std::uint32_t firstSample, std::uint32_t first,
                                                  std::uint32_t count, const std::function<bool()>& shouldContinue)
{
    Pass pass{};
    pass.tileBegin = band.begin();
    pass.firstPixel = first;
    pass.pixelCount = count;
    pass.firstSample = firstSample;
    pass.sampleCount = 1;
    Recording recording(resources_.device, resources_.statistics, portion(), shouldContinue);
    const std::uint32_t share = rulesOf(resources_.device.description().deviceClass).pathsPerThread;
    for (std::uint32_t alive = count; alive > 0 && !recording.isStopped(); ++pass.bounce) {
        recordRounds(recording, alive, share);
        recording.dispatchIndirect(*kernels().traceLightPaths, band.bindings(1 - pass.bounce % 2), pass, resources_.paths().rounds(),
                                   groupsOfPaths(0));
        recording.finish();
        alive = resources_.paths().readRounds()[1].paths.count;
    }
    if (recording.isStopped()) {
        return std::nullopt;
    }
    return PassSeconds{recording.longest(), recording.total()};
}

void PassTracer::addSplats(const SplatBuffer& splats)
{
    Recording recording(resources_.device, resources_.statistics);
    for (const auto& band : splats.bands()) {
        Pass pass{};
        pass.pixelCount = band->count();
        recording.dispatch(*kernels().addSplats, band->bindings(0), pass, resources_.countGroups(pass.pixelCount));
    }
    recording.finish();
}

void PassTracer::closeBlocks(const Tile& tile)
{
    Pass pass = tile.pass();
    pass.pixelCount = tile.count();
    pass.accumulate = kEndsBlock | kEveryPixel;
    pass.round = kEmptyRound;
    Recording recording(resources_.device, resources_.statistics);
    recording.dispatch(*kernels().accumulate, tile.bindings(0), pass, resources_.countGroups(pass.pixelCount));
    recording.finish();
}

std::uint32_t PassTracer::choosePixels(Tile& tile, std::uint32_t samples)
{
    tile.chooseNone();
    CoursePass all{tile.pass(), {}};
    all.pass.pixelCount = tile.count();
    all.pass.firstSample = samples;
    Recording recording(resources_.device, resources_.statistics);
    recording.dispatch(*kernels().course.choosePixels, tile.bindings(0), all, resources_.countGroups(tile.count()));
    recording.finish();
    return tile.readChosenCount();
}

}  // namespace glim
