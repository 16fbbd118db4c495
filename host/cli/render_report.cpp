#include "host/cli/render_report.hpp"

#include "host/image/whole_file.hpp"
#include "host/measure/compare_images.hpp"
#include "host/render/film_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <sys/resource.h>

namespace glim {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t peakHostMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
}

double perSecond(std::uint64_t count, double seconds)
{
    return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0;
}

// Mean over the picture of what --clamp-indirect took, and of what is left.
std::pair<double, double> clampedEnergy(const Film& film)
{
    double removed = 0.0, kept = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        removed += static_cast<double>(pixel.clamped);
        kept += static_cast<double>(pixel.mean.r + pixel.mean.g + pixel.mean.b) / 3.0;
    }
    const double pixels = static_cast<double>(film.pixels.size());
    return {removed / pixels, kept / pixels};
}

Json clampingOf(const Film& film, const RenderOptions& options)
{
    if (!std::isfinite(options.settings.clampIndirect)) {
        return nullptr;
    }
    const auto [removed, kept] = clampedEnergy(film);
    return {{"limit", options.settings.clampIndirect},
            {"removedMeanRadiance", removed},
            {"removedShare", removed / (removed + kept)}};
}

Json estimateOf(const Film& film)
{
    const auto errors = estimateErrors(pictureOf(film));
    if (!errors) {
        return nullptr;
    }
    return {{"relmse", errors->relMse},
            {"relmseAbsolute", errors->relMseAbsolute},
            {"mse", errors->mse},
            {"standardError", std::sqrt(errors->mse)}};
}

Json kernelsOf(const RenderStatistics& statistics)
{
    Json kernels = Json::object();
    for (const auto& [name, kernel] : statistics.kernels) {
        kernels[name] = {{"seconds", kernel.seconds}, {"dispatches", kernel.dispatches}};
    }
    return kernels;
}

Json nonFiniteOf(const RenderStatistics& statistics, std::uint32_t width)
{
    Json located = Json::array();
    for (const Located& place : statistics.located) {
        located.push_back({{"x", place.pixel % width}, {"y", place.pixel / width}, {"sample", place.sampleIndex}});
    }
    return {{"count", statistics.nonFinite}, {"first", located}};
}

Json statisticsOf(const RenderReport& report)
{
    const RenderStatistics& s = report.statistics;
    const std::uint64_t rays = s.cameraAndBounceRays + s.shadowRays;
    return {{"scene", report.options.scene.string()},
            {"size", {report.film.width, report.film.height}},
            {"sampleRange", {report.film.sampleRanges[0].first, report.film.sampleRanges[0].second}},
            {"settings", report.film.identity.settings},
            {"stopReason", report.stopReason},
            {"device",
             {{"name", report.device.name}, {"driver", report.device.driver}, {"kind", report.device.kind}}},
            {"seconds",
             {{"load", report.prepared.loadSeconds},
              {"build", report.prepared.buildSeconds},
              {"upload", s.uploadSeconds},
              {"compile", s.compileSeconds},
              {"render", s.renderSeconds},
              {"write", report.writeSeconds}}},
            {"samples", s.samples},
            {"samplesPerSecond", perSecond(s.samples, s.renderSeconds)},
            {"rays", {{"closest", s.cameraAndBounceRays}, {"shadow", s.shadowRays}, {"total", rays}}},
            {"raysPerSecond", perSecond(rays, s.renderSeconds)},
            {"kernels", kernelsOf(s)},
            {"longestDispatchSeconds", s.longestDispatch},
            {"peakMemory", {{"host", peakHostMemory()}, {"device", s.peakDeviceMemory}}},
            {"nonFinite", nonFiniteOf(s, report.film.width)},
            {"loopCapHits", s.loopCaps},
            {"overflows", s.overflows},
            {"clampIndirect", clampingOf(report.film, report.options)},
            {"estimate", estimateOf(report.film)}};
}

void warnOfGaps(const Film& film)
{
    const auto gaps = std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return p.count == 0; });
    if (gaps > 0) {
        std::cerr << "glim: " << gaps << " of " << film.pixels.size() << " pixels have no sample and are black.\n";
    }
}

void warnOfBias(const RenderReport& report)
{
    if (report.statistics.nonFinite > 0) {
        const Located& first = report.statistics.located[0];
        std::cerr << "glim: " << report.statistics.nonFinite
                  << " samples were not finite and are in no average; the first: pixel ("
                  << first.pixel % report.film.width << ", " << first.pixel / report.film.width << "), sample "
                  << first.sampleIndex << ".\n";
    }
    if (std::isfinite(report.options.settings.clampIndirect)) {
        const auto [removed, kept] = clampedEnergy(report.film);
        std::cerr << "glim: --clamp-indirect removed " << 100.0 * removed / (removed + kept)
                  << " % of the picture's light (mean radiance " << removed << ").\n";
    }
}

}  // namespace

void printSummary(const RenderReport& report)
{
    warnOfGaps(report.film);
    warnOfBias(report);
    const RenderStatistics& s = report.statistics;
    const double pixels = static_cast<double>(report.film.pixels.size());
    char line[512];
    std::snprintf(line, sizeof line, "%s: %ux%u, %.4g samples per pixel in %.2f s (%.3f Msamples/s, %.2f Mrays/s)",
                  report.options.output.c_str(), report.film.width, report.film.height,
                  static_cast<double>(s.samples) / pixels, s.renderSeconds, 1e-6 * perSecond(s.samples, s.renderSeconds),
                  1e-6 * perSecond(s.cameraAndBounceRays + s.shadowRays, s.renderSeconds));
    std::cout << line;
    if (const auto errors = estimateErrors(pictureOf(report.film))) {
        std::snprintf(line, sizeof line, ", estimated relMSE %.3g", errors->relMse);
        std::cout << line;
    } else {
        std::cout << ", error unknown below 33 samples per pixel";
    }
    std::cout << ", on " << report.device.name << " (" << report.device.kind << ")\n";
}

void writeStatistics(const std::filesystem::path& path, const RenderReport& report)
{
    const std::string text = statisticsOf(report).dump(2) + "\n";
    WholeFile file(path);
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace glim
