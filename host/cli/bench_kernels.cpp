#include "host/cli/bench_kernels.hpp"

#include "host/bench/kernel_rates.hpp"
#include "host/bench/make_hills.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/job/interrupt.hpp"
#include "host/job/output_file.hpp"
#include "host/job/version.hpp"
#include "host/message.hpp"
#include "host/render/check_memory.hpp"

#include <unistd.h>
#include <algorithm>
#include <cstdio>
#include <iostream>

namespace glim {
namespace {

constexpr const char* kHills = "hills made in memory";
constexpr int kHillCells = 320;  // 204,800 triangles: beyond every cache of a core

PreparedScene prepareHills(SplitRule split)
{
    PreparedScene prepared;
    prepared.scene = makeHills(kHillCells);
    prepared.scene.file = kHills;
    prepared.primitives = makePrimitives(prepared.scene);
    prepared.bvh = buildSceneBvh(prepared.primitives, split);
    prepared.flat = flattenScene(prepared.scene, prepared.primitives, prepared.bvh);
    return prepared;
}

Json kernelTable(const std::string& scene, const PreparedScene& prepared, const RenderSettings& settings, const DeviceDescription& device,
                 const std::vector<KernelRate>& rates, const PictureRate& picture)
{
    Json table = Json::array();
    for (const KernelRate& rate : rates) {
        table.append({{"rays", rate.rays},
                      {"variant", rate.variant},
                      {"count", rate.count},
                      {"raysPerSecond", {{"median", rate.rate.median}, {"low", rate.rate.low}, {"high", rate.rate.high}}},
                      {"ofBest", rate.ofBest}});
    }
    return {{"scene", scene},
            {"triangles", prepared.primitives.triangles.size()},
            {"spheres", prepared.scene.spheres.size()},
            {"width", settings.width},
            {"height", settings.height},
            {"rounds", kRateRounds},
            {"device", device.name + ", " + device.driver},
            {"version", versionText()},
            {"rates", table},
            {"picture",
             {{"schedule", getName(picture.schedule)},
              {"samples", picture.samples},
              {"rays", {{"closest", picture.closest}, {"shadow", picture.shadow}}},
              {"seconds", {{"median", picture.seconds.median}, {"low", picture.seconds.low}, {"high", picture.seconds.high}}},
              {"traceSeconds", picture.traceSeconds},
              {"traceShare", picture.traceShare()}}}};
}

void print(const PictureRate& picture)
{
    const double samples = static_cast<double>(picture.samples);
    char line[256];
    std::snprintf(line, sizeof line,
                  "picture, %u samples per pixel, %s: %.3g s [%.3g, %.3g], %.3g Msamples/s; %.2f closest-hit and %.2f shadow rays "
                  "per sample; tracing alone takes %.2f of the time\n",
                  kPictureSamples, getName(picture.schedule), picture.seconds.median, picture.seconds.low, picture.seconds.high,
                  1e-6 * samples / picture.seconds.median, static_cast<double>(picture.closest) / samples,
                  static_cast<double>(picture.shadow) / samples, picture.traceShare());
    std::cout << line << std::flush;
}

void print(const std::string& scene, const PreparedScene& prepared, const DeviceDescription& device, const std::vector<KernelRate>& rates)
{
    std::cout << scene << ": " << prepared.primitives.triangles.size() << " triangles and " << prepared.scene.spheres.size()
              << " spheres, on " << device.name << ", " << device.driver << '\n';
    std::cout << "rays         count  variant            Mrays/s: median [lowest, highest]  of the best\n";
    for (const KernelRate& rate : rates) {
        char line[160];
        std::snprintf(line, sizeof line, "%-8s %9zu  %-17s  %8.3g [%.3g, %.3g]", rate.rays.c_str(), rate.count, rate.variant.c_str(),
                      1e-6 * rate.rate.median, 1e-6 * rate.rate.low, 1e-6 * rate.rate.high);
        char share[16];
        std::snprintf(share, sizeof share, "%.2f", rate.ofBest);
        std::cout << line << std::string(std::max<std::size_t>(1, 75 - std::string(line).size()), ' ') << share << '\n';
    }
}

// Shows the round on a terminal, since one of a large scene takes seconds.
class RoundPrinter {
public:
    explicit RoundPrinter(ProgressStyle style)
        : shows_(style == ProgressStyle::Bar || (style == ProgressStyle::Auto && isatty(STDERR_FILENO) != 0))
    {}
    ~RoundPrinter()
    {
        if (shows_ && takesMore(STDERR_FILENO)) {
            std::fputs("\r\033[K", stderr);
        }
    }
    void print(int round) const
    {
        if (shows_ && takesMore(STDERR_FILENO)) {
            std::fprintf(stderr, "\r\033[Kround %d", round + 1);
        }
    }

private:
    bool shows_;
};

// False if the user stopped it.
bool measureKernels(Device& device, const BenchOptions& options, const std::string& name, const PreparedScene& prepared,
                    const InterruptWatch& watch, Json& tables)
{
    const Camera camera = makeCamera(prepared.scene, options);
    const glm::uvec2 size = options.size.value_or(defaultSize(camera));
    RenderSettings settings = options.settings;
    settings.width = size.x;
    settings.height = size.y;
    const std::uint32_t most = maxPathCapacity(settings, device.description());
    if (std::uint64_t{size.x} * size.y > most) {
        throw InputError(MessageId::DeviceLimit,
                         {part::place("--size"), " ", part::value(std::to_string(size.x) + "x" + std::to_string(size.y)),
                          ": all rays of a picture are traced at once, and device \"", device.description().name, "\" traces at most ",
                          part::expected(std::to_string(most)), "."});
    }
    settings.pathCapacity = std::max(choosePathCapacity(settings, device.description()), size.x * size.y);
    checkMemory(prepared, settings, device.description());
    const FlatCamera flat = flattenCamera(prepared, camera, static_cast<float>(size.x) / static_cast<float>(size.y), options.lens);
    const auto show = [&, printer = RoundPrinter(options.progress)](int round) {
        printer.print(round);
        return watch.signal() == 0;
    };
    const std::vector<KernelRate> rates = measureKernelRates(device, prepared.flat, flat, settings, show);
    const auto picture = rates.empty() ? std::nullopt : measurePictureRate(device, prepared.flat, flat, settings, show);
    if (!picture) {
        return false;
    }
    print(name, prepared, device.description(), rates);
    print(*picture);
    tables.append(kernelTable(name, prepared, settings, device.description(), rates, *picture));
    return true;
}

}  // namespace

ExitCode runBenchKernels(const BenchOptions& options)
{
    if (options.outputGiven) {
        checkTarget(options.output, ".json", options.scenes);
    }
    const InterruptWatch watch;
    const VulkanInstance instance;
    Device device(instance, options.device);
    Json tables = Json::array();
    const auto finished = [&](const std::string& name, const PreparedScene& prepared) {
        return watch.signal() == 0 && measureKernels(device, options, name, prepared, watch, tables);
    };
    for (const std::filesystem::path& scene : options.scenes) {
        if (!finished(scene.string(), prepareScene(scene, makeLoadOptions(options), options.split))) {
            return finish(watch.signal(), "no figures are written");
        }
    }
    if (options.scenes.empty() && !finished(kHills, prepareHills(options.split))) {
        return finish(watch.signal(), "no figures are written");
    }
    if (options.outputGiven) {
        writeJson(options.output, tables);
    }
    return ExitCode::Done;
}

}  // namespace glim
