// What a render is asked for.
#pragma once

#include "host/render/guide.hpp"
#include "shaders/shared/limits.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glim {

enum class Sampler { Sobol, Independent };
enum class Intersector { Watertight, MollerTrumbore };
enum class Accelerator { Bvh, None };

// How direct light is estimated at a hit. All have the same expectation: each samples the lights that no ray can hit (point, spot,
// directional).
enum class DirectLight {
    Mis,         // one light by importance and one BSDF sample, weighted by the power heuristic
    Lights,      // every light, lightSamples times each
    Hemisphere,  // lightSamples directions, uniform over the hemisphere
    Bsdf,        // the BSDF sample alone
};

// Which kernels trace a pass, with the same bits: one for each step of all paths, or one that traces path after path to its end
// (pass_tracer.cpp).
// Auto: the faster one on devices of this class (device_class.hpp), if it can.
enum class Schedule { Auto, Wavefront, Persistent };

// Light by the number of surfaces between source and camera: any, none, one, two or more.
enum class PathParts { All, Emission, Direct, Indirect };

enum class Roulette { Throughput, Fixed, None };

// Arbitrary output variables: what a picture shows. The values are those of kAovRadiance ... (shaders/shared/bindings.h). Renders of
// Normal, Depth, Albedo, BvhSteps and Guide end at the camera ray's first hit; SampleCount is known of every film.
enum class Aov : std::uint32_t { Radiance, Normal, Depth, Albedo, BvhSteps, Guide, SampleCount };

// Course: Berkeley's CS 184 path tracer, which stops a pixel once 1.96 s / sqrt(n) <= tolerance * mean of luminance. Neighbours: a pixel
// gets more samples the noisier its neighbours are, relative to their radiance or in absolute terms (allocate_samples.hpp).
enum class Adaptive { Off, Course, CourseLiteral, Neighbours, NeighboursAbsolute };

// The fewest samples from `begin` on whose error can be estimated: up to the end of a second block.
inline std::uint32_t minSamplesForError(std::uint32_t begin)
{
    const std::uint32_t second = (begin / blockSamples(begin) + 1) * blockSamples(begin);
    return second + blockSamples(second) - begin;
}

// The samples of every pixel that Neighbours begins with. Two blocks are the fewest that give a variance; 48 neighbours give it well
// enough.
inline constexpr std::uint32_t kPilotSamples = 2 * kFirstBlockSamples;

// Light paths for each sample of the picture: one for ten pixels (tests/bench/EXPERIMENTS.md).
inline std::uint32_t lightPathCount(std::uint32_t width, std::uint32_t height)
{
    return static_cast<std::uint32_t>((std::uint64_t{width} * height + 9) / 10);
}

// The estimators of the course, beside the production path (course.hpp). With these defaults the production kernels trace.
struct CourseSettings {
    Intersector intersector = Intersector::Watertight;
    Accelerator accelerator = Accelerator::Bvh;
    DirectLight direct = DirectLight::Mis;
    std::uint32_t lightSamples = 1;
    Roulette roulette = Roulette::Throughput;
    float survival = 0.7F;     // probability, of Roulette::Fixed
    float tolerance = 0.05F;   // of Adaptive::Course
    std::uint32_t batch = 32;  // of Adaptive::Course: samples between two tests of a pixel

    bool operator==(const CourseSettings&) const = default;
};

inline constexpr std::uint64_t kMostOfBuffer = 1U << 27U;  // bytes: Vulkan's least limit of a storage buffer

struct RenderSettings {
    std::uint32_t width = 512, height = 512;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> rows;  // the film has only these of the picture, [begin, end)
    std::uint32_t sampleBegin = 0, sampleEnd = 64;                // absolute indices, [begin, end)
    std::uint32_t bounces = 64;                                   // surfaces between camera and light
    std::uint32_t seed = 0;
    Sampler sampler = Sampler::Sobol;
    PathParts paths = PathParts::All;
    Aov aov = Aov::Radiance;
    // Unless Off, sample indices begin at 0. Course: samples are independent, and a pixel has at most sampleEnd. Neighbours: pixels have
    // sampleEnd on average; half of these are the same for all pixels.
    Adaptive adaptive = Adaptive::Off;
    float clampIndirect = std::numeric_limits<float>::infinity();
    bool caustics = true;  // by light paths, in scenes that need it (tracesLight)
    CourseSettings course;
    std::shared_ptr<const Guide> guide;  // of paths; null: they are not guided
    std::optional<double> seconds;       // stop sampling after this long

    // What is recorded besides the picture. This changes no bit of it.
    std::uint32_t suspects = 0;            // how many of the brightest samples to list; each pixel keeps its own (suspects.hpp)
    bool catcher = false;                  // the film keeps what shadow catchers show; only of scenes with kFeatureCatcher (catches())
    bool catcherReflections = true;        // they reflect objects and their light
    std::vector<std::string> lightGroups;  // the film keeps their light apart; those of the scene, or none (keepsGroups())
    bool halves = false;                   // the samples in two independent halves too (film_halves.hpp); not with Adaptive::Course
    bool halvesLate = false;               // the halves begin when Renderer::keepHalves() is called
    bool comparesPaths = false;            // splats count what camera paths would bring (light_path_gain.hpp), in place of clamped light
    bool notes = false;                    // kernels record what happens to the only path of a pass (replay.hpp)
    bool learns = false;                   // paths write down where light comes from (learn_guide.hpp), in place of a film

    // How the work is cut: these change no bit of the picture.
    Schedule schedule = Schedule::Auto;
    std::uint32_t workgroup = 64;               // invocations
    std::optional<std::uint32_t> pathCapacity;  // paths in flight, at least kBlockSamples; by default what suits the device
    std::uint32_t tilePixels = 1U << 20;        // most pixels of a tile: no buffer of the film exceeds kMostOfBuffer
    std::uint32_t portion = 64;                 // dispatches between two checks whether the pass goes on, unless passes take
    double uncheckedSeconds = 0.05;             // less than this; then two may be in flight
    double passSeconds = 1.0;                   // the most that a pass should take; callers wait for its end

    std::uint32_t rowBegin() const { return rows ? rows->first : 0; }
    std::uint32_t rowCount() const { return rows ? rows->second - rows->first : height; }
    std::uint32_t firstPixel() const { return rowBegin() * width; }  // of the film, in the picture
    std::uint32_t pixelCount() const { return rowCount() * width; }  // of the film
    std::uint32_t groupCount() const { return static_cast<std::uint32_t>(lightGroups.size()); }
    std::uint32_t tileSize() const;  // tilePixels, or fewer with light groups

    bool operator==(const RenderSettings&) const = default;
};

// Of a picture of the same shape with about so many pixels; the second one with no more than there are.
glm::uvec2 pilotSize(const RenderSettings& settings, double pixels);
glm::uvec2 pilotSizeAtMost(const RenderSettings& settings, double pixels);
// Of a picture of this size whose paths are as those by `settings`.
RenderSettings pilotSettings(const RenderSettings& settings, const glm::uvec2& size);

// The name that --schedule and the statistics use.
inline const char* getName(Schedule schedule)
{
    return schedule == Schedule::Persistent ? "persistent" : schedule == Schedule::Wavefront ? "wavefront" : "auto";
}

inline bool isCourse(Adaptive adaptive) { return adaptive == Adaptive::Course || adaptive == Adaptive::CourseLiteral; }
inline bool isNeighbours(Adaptive adaptive) { return adaptive == Adaptive::Neighbours || adaptive == Adaptive::NeighboursAbsolute; }

// Every setting that changes a sample, as "name=value ..."; part of a film's identity. Settings that later versions of glim added are
// listed only if they are not at their default.
std::string describeSettings(const RenderSettings& settings);

// The value of the setting `name` in `description`; empty if absent.
std::string findSetting(const std::string& description, const std::string& name);

}  // namespace glim
