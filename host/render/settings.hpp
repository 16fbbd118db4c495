// What a render is asked for.
#pragma once

#include "shaders/shared/limits.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace glim {

enum class Sampler { Sobol, Independent };
enum class Intersector { Watertight, MollerTrumbore };
enum class Accelerator { Bvh, None };

// How the light that reaches a hit straight from a source is estimated. All have the same expectation: a light that no
// direction can find (point, spot, directional) is sampled in each of them.
enum class DirectLight {
    Mis,         // one light by power and the scattered ray, weighted by the power heuristic
    Lights,      // every light, lightSamples times each
    Hemisphere,  // lightSamples directions, uniform over the hemisphere
    Bsdf,        // the scattered ray alone
};

// Which kernels trace a pass, to the same bits: one per step of all its paths (wavefront.cpp), or one that traces path after path to
// its end (wavefront_persistent.cpp).
// Auto: where both can, the one that is known to be faster on the device; else persistent on software devices, where it was faster in
// every scene measured, and wavefront on GPUs, none of which was.
enum class Schedule { Auto, Wavefront, Persistent };

// Light by the surfaces it has met between source and camera: none, one, two or more.
enum class PathParts { All, Emission, Direct, Indirect };

enum class Roulette { Throughput, Fixed, None };

// What the picture shows of what the camera rays meet; all but Shaded end there.
enum class View { Shaded, Normal, Depth, Albedo, BvhSteps };

// Course: Berkeley's CS 184 path tracer, which stops a pixel once 1.96 s / sqrt(n) <= tolerance * mean of luminance. Neighbours: the
// more samples, the noisier a pixel's neighbours are, relative to their radiance or in absolute terms (allocate_samples.hpp).
enum class Adaptive { Off, Course, CourseLiteral, Neighbours, NeighboursAbsolute };

// Whose error is known, that of the samples from `begin` on: two blocks.
inline std::uint32_t leastSamplesForError(std::uint32_t begin) { return begin == 0 ? kBlockSamples : 2 * kBlockSamples; }

// That Neighbours begins with everywhere. Two blocks are the fewest that tell a variance; of 48 neighbours they tell it well enough.
inline constexpr std::uint32_t kPilotSamples = kBlockSamples;

struct RenderSettings {
    std::uint32_t width = 512, height = 512;
    std::uint32_t sampleBegin = 0, sampleEnd = 64;  // absolute indices, [begin, end)
    std::uint32_t bounces = 64;                     // surface events between camera and light
    std::uint32_t seed = 0;
    Sampler sampler = Sampler::Sobol;
    Intersector intersector = Intersector::Watertight;
    Accelerator accelerator = Accelerator::Bvh;
    DirectLight direct = DirectLight::Mis;
    std::uint32_t lightSamples = 1;
    PathParts paths = PathParts::All;
    Roulette roulette = Roulette::Throughput;
    float survival = 0.7F;  // of Roulette::Fixed
    View view = View::Shaded;
    // Sample indices then begin at 0. Of Course they are independent, and a pixel has at most sampleEnd; of Neighbours, pixels have
    // sampleEnd on average, half of which are all pixels' first.
    Adaptive adaptive = Adaptive::Off;
    float tolerance = 0.05F;   // of Course
    std::uint32_t batch = 32;  // of Course: samples between two looks at a pixel
    float clampIndirect = std::numeric_limits<float>::infinity();
    std::optional<double> seconds;  // stop sampling after this long

    // What is kept besides the picture, of which this changes no bit.
    std::uint32_t suspects = 0;  // brightest samples to list; each pixel keeps its own (suspects.hpp)
    bool notes = false;          // kernels note what they find out about the only path of a pass (replay.hpp)

    // How the work is cut: these change no bit of the picture.
    Schedule schedule = Schedule::Auto;
    Schedule fastest = Schedule::Auto;   // that is known of the device; Auto: none is
    std::uint32_t workgroup = 64;        // invocations
    std::uint32_t pathCapacity = 1U << 18;  // paths in flight, at least kBlockSamples
    std::uint32_t slabPixels = 1U << 20;    // most pixels of a slab: no buffer of the film exceeds 128 MiB, llvmpipe's limit
    std::uint32_t portion = 64;          // dispatches that run before it is asked whether the pass goes on
    double passSeconds = 1.0;            // that a pass should take at most: nobody is answered before its end
};

// As --schedule and the statistics have it.
inline const char* nameOf(Schedule schedule)
{
    return schedule == Schedule::Persistent ? "persistent" : schedule == Schedule::Wavefront ? "wavefront" : "auto";
}

inline bool isCourse(Adaptive adaptive) { return adaptive == Adaptive::Course || adaptive == Adaptive::CourseLiteral; }
inline bool isNeighbours(Adaptive adaptive)
{
    return adaptive == Adaptive::Neighbours || adaptive == Adaptive::NeighboursAbsolute;
}

// Every setting that changes a sample, as "name=value ..."; part of a film's identity. Those that later versions of glim added
// are named where they are not at their default.
std::string describeSettings(const RenderSettings& settings);

// What `description` says of the setting `name`; empty if nothing.
std::string findSetting(const std::string& description, const std::string& name);

}  // namespace glim
