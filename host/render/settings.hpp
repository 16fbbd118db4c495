// What a render is asked for.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace glim {

enum class Sampler { Sobol, Independent };
enum class Intersector { Watertight, MollerTrumbore };

struct RenderSettings {
    std::uint32_t width = 512, height = 512;
    std::uint32_t sampleBegin = 0, sampleEnd = 64;  // absolute indices, [begin, end)
    std::uint32_t bounces = 64;                     // surface events between camera and light
    std::uint32_t seed = 0;
    Sampler sampler = Sampler::Sobol;
    Intersector intersector = Intersector::Watertight;
    float clampIndirect = std::numeric_limits<float>::infinity();
    std::optional<double> seconds;  // stop sampling after this long

    // How the work is cut: these change no bit of the picture.
    std::uint32_t workgroup = 64;        // invocations
    std::uint32_t pathCapacity = 1U << 18;  // paths in flight, at least kBlockSamples
};

// Every setting that changes a sample, as "name=value ..."; part of a film's identity.
std::string describeSettings(const RenderSettings& settings);

}  // namespace glim
