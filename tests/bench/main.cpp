// glim_rates [SCENE...]: how fast glim's kernels trace rays, relative to Embree in the same run with the same rays. Compares the
// hits, and the rates with the table in tests/bench/README.md. Without scenes it takes those of bench_scenes.hpp.
// glim_rates --growth: how the time of a ray grows with the number of triangles.
#include "host/bench/kernel_rates.hpp"
#include "host/bench/make_hills.hpp"
#include "host/bench/trace_timer.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/scene/load_gltf.hpp"
#include "tests/bench/embree.hpp"
#include "tests/bench/growth.hpp"
#include "tests/bench/recorded.hpp"
#include "tests/support/bench_scenes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

namespace glim {
namespace {

// The device and scene of this run, and what was recorded for them.
struct Place {
    std::string device;
    std::string recorded;  // tests/bench/README.md
    std::string scene;
};

std::string changeText(const Place& place, const char* rays, const Spread& ratio)
{
    const std::optional<Spread> before = findRecorded(place.recorded, place.device, place.scene, rays);
    if (!before) {
        return "-";
    }
    char text[64];
    std::snprintf(text, sizeof text, "%.2f: %s", before->median, describeChange(ratio, *before).c_str());
    return text;
}

// Embree before and after glim: what slows the machine for longer than that slows both.
void compareRates(const Place& place, const char* name, std::size_t rays, const std::function<double()>& ours,
                  const std::function<double()>& embree, const std::string& differing)
{
    std::vector<double> ratios, rates;
    ours();
    for (int round = 0; round < kRateRounds; ++round) {
        const double before = embree(), seconds = ours(), after = embree();
        ratios.push_back(0.5 * (before + after) / seconds);
        rates.push_back(static_cast<double>(rays) / seconds / 1e6);
    }
    const Spread ratio = computeSpread(ratios);
    std::printf("| %s | %.2f | %.2f [%.2f, %.2f] | %s | %s |\n", name, computeSpread(rates).median, ratio.median, ratio.low, ratio.high,
                differing.c_str(), changeText(place, name, ratio).c_str());
    std::fflush(stdout);
}

std::string readText(const char* path)
{
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string countDifferent(const FlatScene& flat, const std::vector<PathHit>& ours, const std::vector<Embree::Hit>& theirs)
{
    std::size_t different = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const std::uint32_t id =
            ours[i].primitiveRef == kNoPrimitiveRef ? kNoPrimitive : flat.primitiveRefs[ours[i].primitiveRef * kPrimitiveRefTexels].w;
        different += id == theirs[i].triangle || std::abs(ours[i].t - theirs[i].t) <= 1e-4F * theirs[i].t ? 0 : 1;
    }
    return std::to_string(different) + " of " + std::to_string(ours.size());
}

void measure(Device& device, Place place, BenchScene bench)
{
    bench.scene.showsBackFaces = true;  // as Embree does
    place.scene = bench.name;
    const auto start = std::chrono::steady_clock::now();
    const Primitives primitives = makePrimitives(bench.scene);
    const WideBvh bvh = buildSceneBvh(primitives);
    const double buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const FlatScene flat = flattenScene(bench.scene, primitives, bvh);
    RenderSettings settings;
    settings.width = settings.height = 512;
    TraceTimer timer(device, flat, flattenCamera(bench.scene.cameras.front(), 1.0F), settings);
    const Embree embree(primitives);
    const double triangles = static_cast<double>(primitives.triangles.size());
    std::printf("\n### %s\n\n%.0f triangles, tree in %.2f s (%.2f M/s), depth %u, cost %.2f, %.0f bytes a triangle\n\n", bench.name.c_str(),
                triangles, buildSeconds, triangles / buildSeconds / 1e6, bvh.depth, bvh.cost,
                16.0 * static_cast<double>(flat.nodes.size() + flat.primitiveRefs.size()) / triangles);
    std::printf("| rays | Mrays/s | over Embree's | other hits | recorded |\n|---|---|---|---|---|\n");
    const RaySets& rays = timer.rays();
    for (const auto& [name, set] : {std::pair{"primary", &rays.primary}, {"diffuse", &rays.diffuse}}) {
        compareRates(
            place, name, set->size(), [&] { return timer.trace(*set).seconds; }, [&] { return embree.trace(*set).seconds; },
            countDifferent(flat, timer.trace(*set).hits, embree.trace(*set).hits));
    }
    const auto ours = timer.trace(rays.shadow).free;
    const auto theirs = embree.trace(rays.shadow).free;
    std::size_t different = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        different += ours[i] == (theirs[i] != 0) ? 0 : 1;
    }
    compareRates(
        place, "shadow", rays.shadow.size(), [&] { return timer.trace(rays.shadow).seconds; },
        [&] { return embree.trace(rays.shadow).seconds; }, std::to_string(different) + " of " + std::to_string(ours.size()));
}

void run(const std::vector<std::string>& files)
{
    const VulkanInstance instance;
    Device device(instance, std::nullopt);
    const Place place{device.description().name + ", " + device.description().driver, readText(GLIM_BENCH_TABLE), ""};
    std::printf("## %s\n", place.device.c_str());
    if (files == std::vector<std::string>{"--growth"}) {
        measureGrowth(device);
        return;
    }
    for (const std::string& file : files) {
        measure(device, place, {std::filesystem::path(file).filename().string(), loadGltf(file)});
    }
    if (files.empty()) {
        measure(device, place, {"bumpy ball", bumpyBall(6)});
        measure(device, place, {"hills", makeHills(707)});
        measure(device, place, {"forest", forest(400)});
    }
}

}  // namespace
}  // namespace glim

int main(int argc, char** argv)
{
    try {
        glim::run({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glim_rates: %s\n", error.what());
        return 1;
    }
}
