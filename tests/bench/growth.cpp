#include "tests/bench/growth.hpp"

#include "host/bench/kernel_rates.hpp"
#include "host/bench/make_hills.hpp"
#include "host/bench/trace_timer.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"

#include <chrono>
#include <cstdio>

namespace glim {
namespace {

constexpr int kRounds = 5;

// Median nanoseconds of a ray.
template <class Ray>
double nanosecondsOf(TraceTimer& timer, const std::vector<Ray>& rays)
{
    std::vector<double> seconds;
    timer.trace(rays);
    for (int round = 0; round < kRounds; ++round) {
        seconds.push_back(timer.trace(rays).seconds);
    }
    return 1e9 * computeSpread(seconds).median / static_cast<double>(rays.size());
}

void measureHills(Device& device, int cells)
{
    const Scene scene = makeHills(cells);
    const Primitives primitives = makePrimitives(scene);
    const auto start = std::chrono::steady_clock::now();
    const WideBvh bvh = buildSceneBvh(primitives);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const FlatScene flat = flattenScene(scene, primitives, bvh);
    RenderSettings settings;
    settings.width = settings.height = 512;
    TraceTimer timer(device, flat, flattenCamera(scene.cameras.front(), 1.0F), settings);
    const double triangles = static_cast<double>(primitives.triangles.size());
    const RaySets& rays = timer.rays();
    const double primary = nanosecondsOf(timer, rays.primary), diffuse = nanosecondsOf(timer, rays.diffuse);
    std::printf("| %.0f | %.3f | %.2f | %u | %.0f | %.0f | %.0f | %.0f |\n", triangles, seconds, triangles / seconds / 1e6, bvh.depth,
                16.0 * static_cast<double>(flat.nodes.size() + flat.primitiveRefs.size()) / triangles, primary, diffuse,
                nanosecondsOf(timer, rays.shadow));
    std::fflush(stdout);
}

}  // namespace

void measureGrowth(Device& device)
{
    std::printf("\n| triangles | tree, s | M/s | depth | bytes a triangle | ns a ray: primary | diffuse | shadow |\n");
    std::printf("|---|---|---|---|---|---|---|---|\n");
    for (const int cells : {22, 71, 224, 707, 2236}) {
        measureHills(device, cells);
    }
}

}  // namespace glim
