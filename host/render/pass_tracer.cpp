// A pass traces some samples of some pixels to their end. The wavefront:
//
//   generate_rays
//   per bounce:  trace_closest -> shade_surface -> trace_shadow (where lights are sampled)
//     or, where volumes scatter, per part of a walk, until no path is left
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
// Short passes are recorded and submitted while the device still traces the one before. If paths of that one are left at the end of what
// was recorded, the pass behind it finds so, and does nothing.
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

// How many of the pass's rounds had a path.
std::uint32_t countRounds(const std::vector<Round>& rounds, std::uint32_t first)
{
    const auto begin = rounds.begin() + first, end = begin + kRoundsOfPass;
    const auto empty = std::find_if(begin, end, [](const Round& round) { return round.paths.count == 0; });
    return static_cast<std::uint32_t>(empty - begin);
}

}  // namespace

std::optional<PassSeconds> PassTracer::trace(const Tile& tile, const Pass& pass, const std::function<bool()>& shouldContinue)
{
    Recording recording(resources_.device, resources_.statistics, portion(), shouldContinue);
    PassProgress progress = begin(recording, tile, pass, true);
    return finish(recording, tile, progress) ? std::optional(secondsOf(recording)) : std::nullopt;
}

void PassTracer::tracePaths(Recording& recording, const Tile& tile, const Pass& pass)
{
    PassProgress progress = begin(recording, tile, pass, false);
    finish(recording, tile, progress);
}

// A sample has a second path where shadow catchers are (shaders/access/catcher.glsl).
std::uint32_t PassTracer::pathsOf(const Pass& pass) const
{
    return pass.pixelCount * pass.sampleCount * (resources_.settings.catcher ? 2 : 1);
}

bool PassTracer::startsAhead() const
{
    const bool isTimed = resources_.device.description().nanosecondsPerTick > 0.0F;  // the host would time the pass before too
    const RenderSettings& settings = resources_.settings;
    return isTimed && portion() == kMaxTimed && resources_.history.rounds <= kMaxRounds && !usesCourseEstimators(settings) &&
           !isCourse(settings.adaptive);
}

std::unique_ptr<StartedPass> PassTracer::start(const Tile& tile, const Pass& pass)
{
    const auto always = [] { return true; };
    std::unique_ptr<StartedPass> started(new StartedPass{{resources_.device, resources_.statistics, kMaxTimed, always}, tile, {}});
    Pass stopping = pass;
    stopping.accumulate |= kStopsNext;
    started->progress = begin(started->recording, tile, stopping, true);
    started->recording.start();
    return started;
}

PassTracer::Ended PassTracer::end(StartedPass& started)
{
    finish(started.recording, started.tile, started.progress);
    return {secondsOf(started.recording), (started.progress.pass.accumulate & kStopsNext) == 0};
}

PassSeconds PassTracer::secondsOf(const Recording& recording) const
{
    if (recording.total() > 0.0) {
        resources_.history.seconds = recording.total();
    }
    return {recording.longest(), recording.total()};
}

std::uint32_t PassTracer::portion() const
{
    return resources_.history.seconds < resources_.settings.uncheckedSeconds ? kMaxTimed : resources_.settings.portion;
}

// Records as many rounds, bounces or dispatches of trace_paths, as may suffice, and the end of the pass, whose kernels do nothing while a
// path is alive. So the host waits once per pass, and rarely again.
PassProgress PassTracer::begin(Recording& recording, const Tile& tile, Pass pass, bool addsSamples) const
{
    resources_.history.firstRound = kRoundsOfPass - resources_.history.firstRound;
    pass.round = resources_.history.firstRound;
    PassProgress progress{pass, addsSamples, pass.round, 0, pathsOf(pass)};
    writeRounds(recording, progress.firstRound, progress.alive, isPersistent() ? pathsPerThread() : 1);
    // generate_rays fills the queue that bounce 0 reads: the next queue of the odd bindings.
    recording.dispatch(*kernels().generateRays, tile.bindings(1), pass, resources_.countGroups(progress.alive));
    recordRounds(recording, tile, progress, resources_.history.rounds);
    return progress;
}

// Runs what begin() recorded, and more rounds while paths are alive. Returns false if the recording was stopped before the end.
bool PassTracer::finish(Recording& recording, const Tile& tile, PassProgress& progress) const
{
    for (;;) {
        const bool isWhole = !recording.isStopped();
        recording.finish();
        if (isWhole && isOver(progress)) {
            return true;
        }
        if (recording.isStopped() || progress.pass.bounce > lastBounce()) {
            return false;
        }
        if ((progress.pass.accumulate & kStopsNext) != 0) {
            progress.pass.accumulate &= ~kStopsNext;
            const Round none = makeRounds(0, 0)[kLeftRound];
            recording.write(resources_.paths().rounds(), kLeftRound * sizeof(Round), std::span(&none, 1));
        }
        progress.from = progress.pass.bounce;
        writeRounds(recording, progress.firstRound, progress.alive, isPersistent() ? pathsPerThread() : 1);
        recordRounds(recording, tile, progress, isPersistent() ? 1 : kMoreBounces);
    }
}

bool PassTracer::isOver(PassProgress& progress) const
{
    const std::vector<Round> rounds = resources_.paths().readRounds();
    progress.alive = rounds[progress.pass.round].paths.count;
    if (progress.alive > 0) {
        return false;
    }
    // Of many paths the longest varies by a few surfaces.
    const std::uint32_t needed = progress.from + countRounds(rounds, progress.firstRound);
    std::uint32_t& usual = resources_.history.rounds;
    usual = std::max(needed + (isPersistent() ? 0 : 2 + needed / 8), usual - 1);
    return true;
}

void PassTracer::recordRounds(Recording& recording, const Tile& tile, PassProgress& progress, std::uint32_t count) const
{
    Pass& pass = progress.pass;
    const std::uint32_t end = progress.firstRound + std::min(count, kMaxRounds);
    for (pass.round = progress.firstRound; pass.round < end && pass.bounce <= lastBounce(); ++pass.round, ++pass.bounce) {
        recordRound(recording, tile.bindings(pass.bounce % 2), pass);
    }
    if (progress.addsSamples) {
        recordEnd(recording, tile, pass);
    }
}

// Begins round `first` with `paths`, of which a thread takes `share`.
void PassTracer::writeRounds(Recording& recording, std::uint32_t first, std::uint32_t paths, std::uint32_t share) const
{
    const std::vector<Round> rounds = makeRounds(paths, resources_.countGroups((paths + share - 1) / share));
    recording.write(resources_.paths().rounds(), first * sizeof(Round), std::span(rounds).first(kRoundsOfPass));
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
    if (kernels().ofPaths()) {
        recording.dispatchIndirect(*kernels().ofPaths(), bindings, pass, rounds, groupsOfPaths(pass.round));
        return;
    }
    if (usesCourseEstimators(resources_.settings)) {
        resources_.course.recordBounce(recording, kernels(), bindings, pass, rounds);
        return;
    }
    recording.dispatchIndirect(*kernels().traceClosest, bindings, pass, rounds, groupsOfPaths(pass.round));
    recording.dispatchIndirect(*kernels().shadeSurface, bindings, pass, rounds, groupsOfPaths(pass.round));
    const PathLengths lengths = pathLengths(resources_.settings);
    if (resources_.scatters || samplesLights(pass.bounce, lengths.maxBounces, lengths.min, resources_.lightCount)) {
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
    for (std::uint32_t alive = count; alive > 0 && !recording.isStopped(); ++pass.bounce) {
        writeRounds(recording, 0, alive, pathsPerThread());
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
        pass.pixelCount = band->sumCount();
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
