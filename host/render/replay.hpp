// One path of a render once more, alone, with everything that happens to it: by the kernels of the render in their order.
#pragma once

#include "host/render/wavefront.hpp"

#include <vector>

namespace glim {

// A round of direct light at a vertex.
struct LightTry {
    PathNote note{};        // which light, with which pdfs and weight; over the hemisphere there is none
    bool hemisphere = false;
    bool asked = false;     // a shadow ray set out; else nothing could have come of it
    ShadowRay ray{};        // if asked
    PathRadiance added{};   // nothing in the shadow
};

enum class PathFate {
    GoesOn,
    Missed,      // the ray met nothing
    LastBounce,  // has met as many surfaces as --bounces or --paths allow
    Absorbed,    // scattered with weight 0: into a black or out of the wrong side of a surface
    Redundant,   // could only have found light that was sampled already
    Roulette
};

// A hit, or the miss that ends the path.
struct PathVertex {
    std::uint32_t bounce = 0;
    PathRay ray{};          // that led here
    PathState before{};     // throughput here, pdf of the ray
    PathHit hit{};
    PathNote met{};         // the surface, and the light that the ray has found
    PathRadiance found{};   // that this added
    std::vector<LightTry> tries;
    PathNote scattered{};   // weight, throughput and survival
    PathFate fate = PathFate::GoesOn;
    PathState after{};      // of the next ray, if it goes on
};

struct ReplayedPath {
    std::vector<PathVertex> vertices;
    PathRadiance radiance{};  // the bits of the render's sample: the sum in float32 of all that was added, in order
};

class Replay {
public:
    // `settings` are those of the render; how many samples it takes, and where, changes nothing.
    Replay(Device& device, const FlatScene& scene, const FlatCamera& camera, const RenderSettings& settings);

    // Throws DeviceError as Renderer::render does.
    ReplayedPath trace(std::uint32_t pixel, std::uint32_t sample);

private:
    const Device& device_;
    Wavefront wavefront_;
};

}  // namespace glim
