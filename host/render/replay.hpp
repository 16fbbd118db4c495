// Traces one path of a render again, by itself, with the same kernels in the same order, and inspects the path after each kernel.
#pragma once

#include "host/render/render_resources.hpp"

#include <functional>
#include <string>
#include <vector>

namespace glim {

// Called after each kernel with its name, its pass (and round, for a kernel of the course), and the buffers to look at.
using PathWatch = std::function<void(const std::string& kernel, const CoursePass& pass, PathBuffers& paths)>;

// Traces a pass that is added to no film, and calls `watch`, if any, after each kernel.
void watchPass(RenderResources& resources, const Tile& tile, Pass pass, const PathWatch& watch);
// Traces one sample of one pixel, and adds it to no film. If the watch takes radiance, returns what it has left.
PathRadiance traceSample(RenderResources& resources, std::uint32_t pixel, std::uint32_t sample, const PathWatch& watch = nullptr);

// A round of direct light at a vertex.
struct SampledLight {
    PathNote note{};  // which light, with which pdfs and weight; unset over the hemisphere
    bool hemisphere = false;
    bool hasShadowRay = false;  // a shadow ray was traced; without one, nothing could be added
    ShadowRay ray{};            // if hasShadowRay
    PathRadiance added{};       // black if the shadow ray was blocked
};

enum class PathEnd {
    Continues,
    Missed,      // the ray met nothing
    LastBounce,  // has met as many surfaces as --bounces or --paths allow
    Absorbed,    // scattered with weight 0: the surface is black, or the direction leaves on the wrong side
    Redundant,   // the next ray could only have hit light that was sampled already
    Roulette,
    WithinVolume  // scattered there, and ended by roulette or after too many scatterings
};

// A hit, or the miss that ends the path.
struct PathVertex {
    std::uint32_t bounce = 0;
    PathRay ray{};       // the ray that led here
    PathState before{};  // throughput here, pdf of the ray; where the ray comes from a walk through a volume, how often it scattered there
    PathHit hit{};
    PathNote surface{};      // the surface, and the light that the ray has hit
    PathRadiance emitted{};  // the radiance that this light added
    std::vector<SampledLight> sampledLights;
    PathNote bsdf{};  // weight, throughput and probability to continue; what the guide had to do with it
    PathEnd end = PathEnd::Continues;
    PathState after{};  // state of the next ray, if the path continues
};

struct ReplayedPath {
    std::vector<PathVertex> vertices;
    PathRadiance radiance{};  // the render's sample bit for bit: the float32 sum of all that was added, in order
};

class Replay {
public:
    // `settings` are those of the render; the number and allocation of its samples do not matter.
    Replay(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Throws DeviceError as Renderer::render does.
    ReplayedPath trace(std::uint32_t pixel, std::uint32_t sample);

private:
    std::uint32_t maxBounces_, refCount_;
    RenderResources resources_;
};

}  // namespace glim
