#include "host/job/render_report.hpp"

#include "host/job/exposure_advice.hpp"
#include "host/job/output_file.hpp"
#include "host/message.hpp"
#include "host/render/composite.hpp"
#include "host/render/film_file.hpp"
#include "host/render/parameters.hpp"
#include "host/text.hpp"
#include "shaders/shared/limits.h"

#include <sys/resource.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <ostream>

namespace glim {
namespace {

Json alphaRmseJson(const Film& film)
{
    const std::optional<double> error = computeAlphaRmse(film);
    return error ? Json(*error) : Json(nullptr);
}

std::uint64_t peakHostMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts KiB
}

double perSecond(std::uint64_t count, double seconds) { return seconds > 0.0 ? static_cast<double>(count) / seconds : 0.0; }

// The double that reads like the float: .05, not .0500000007.
double shortest(float value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.7g", static_cast<double>(value));
    return std::strtod(text, nullptr);
}

Json boundOf(const RenderReport& report) { return report.error && report.error->bound ? Json(*report.error->bound) : Json(nullptr); }

Json clampingOf(const Film& film, const RenderJob& options)
{
    if (!std::isfinite(options.settings.clampIndirect)) {
        return nullptr;
    }
    const ClampedEnergy energy = computeClampedEnergy(film);
    return {{"limit", options.settings.clampIndirect}, {"removedMeanRadiance", energy.removed}, {"removedShare", energy.removedShare()}};
}

Json bvhOf(const RenderReport& report)
{
    if (report.options.settings.course.accelerator == Accelerator::None) {
        return nullptr;
    }
    constexpr const char* kRules[] = {"sah", "mean", "median"};
    const PreparedScene& prepared = report.prepared;
    return {{"split", kRules[static_cast<int>(prepared.split)]},
            {"nodes", prepared.flat.nodes.size() / kNodeTexels},
            {"records", prepared.flat.primitiveRefs.size() / kPrimitiveRefTexels},
            {"depth", prepared.bvh.depth},
            {"cost", prepared.bvh.cost}};
}

Json biasOf(const RenderReport& report)
{
    if (!report.bias) {
        return nullptr;
    }
    const Interval& bias = report.bias->bias;
    return {{"ofMean", bias.value}, {"ofMean95", Json::array({bias.low, bias.high})}, {"pixels", report.bias->pixels}};
}

Json adaptiveOf(const RenderReport& report)
{
    const RenderSettings& settings = report.options.settings;
    if (settings.adaptive == Adaptive::Off) {
        return nullptr;
    }
    const Rates rates = computeRates(report.film);
    const Json counts = {{"meanSpp", rates.mean}, {"leastSpp", rates.least}, {"mostSpp", rates.most}, {"bias", biasOf(report)}};
    if (isNeighbours(settings.adaptive)) {
        Json json = {{"rule", settings.adaptive == Adaptive::Neighbours ? "neighbours" : "neighbours:absolute"}};
        json.update(counts);
        return json;
    }
    const auto atMost = std::count_if(report.film.pixels.begin(), report.film.pixels.end(),
                                      [&](const PixelMoments& pixel) { return pixel.count >= settings.sampleEnd; });
    Json json = {{"rule", settings.adaptive == Adaptive::Course ? "course" : "course:literal"},
                 {"tolerance", shortest(settings.course.tolerance)},
                 {"batch", settings.course.batch},
                 {"maxSpp", settings.sampleEnd}};
    json.update(counts);
    json.set("pixelsAtMost", atMost);
    return json;
}

Json countSteps(const RenderReport& report)
{
    if (report.options.settings.aov != Aov::BvhSteps) {
        return nullptr;
    }
    const Steps steps = computeSteps(report.film);
    return {{"nodesPerRay", steps.nodes}, {"primitivesPerRay", steps.primitives}, {"mostNodes", steps.mostNodes}};
}

Json kernelsOf(const RenderStatistics& statistics)
{
    Json kernels = Json::object();
    for (const auto& [name, kernel] : statistics.kernels) {
        kernels.set(name, {{"seconds", kernel.seconds}, {"dispatches", kernel.dispatches}});
    }
    return kernels;
}

Json nonFiniteOf(const RenderStatistics& statistics, std::uint32_t width)
{
    Json located = Json::array();
    for (const Located& place : statistics.located) {
        located.append({{"x", place.pixel % width}, {"y", place.pixel / width}, {"sample", place.sampleIndex}});
    }
    return {{"count", statistics.nonFinite}, {"first", located}};
}

std::string replayOf(const Suspect& suspect, std::uint32_t width)
{
    return std::to_string(suspect.pixel % width) + "," + std::to_string(suspect.pixel / width) + "," + std::to_string(suspect.sampleIndex);
}

Json suspectsOf(const RenderReport& report)
{
    if (report.options.settings.suspects == 0) {
        return nullptr;
    }
    Json list = Json::array();
    for (const Suspect& suspect : report.suspects) {
        list.append({{"x", suspect.pixel % report.film.width},
                     {"y", suspect.pixel / report.film.width},
                     {"sample", suspect.sampleIndex},
                     {"radiance", Json::array({suspect.radiance.r, suspect.radiance.g, suspect.radiance.b})},
                     {"luminance", suspect.luminance},
                     {"shareOfPixel", suspect.shareOfPixel},
                     {"shareOfPicture", suspect.shareOfPicture},
                     {"replay", replayOf(suspect, report.film.width)}});
    }
    return list;
}

Json guideOf(const RenderReport& report)
{
    if (!report.guide || !report.guide->guide) {
        return nullptr;
    }
    const Guide& guide = *report.guide->guide;
    return {{"gain", report.guide->gain}, {"digest", guide.digest},
            {"cells", guide.cells},       {"scatterings", guideScatterings(guide.texels)},
            {"paths", guide.paths},       {"seconds", guide.seconds},
            {"kept", report.keepsGuide}};
}

std::uint32_t lightPathsOf(const Film& film) { return lightPathCount(film.width, film.rowsAbove + film.height + film.rowsBelow); }

Json cropOf(const Film& film)
{
    return film.crop ? Json::array({film.crop->corner.x, film.crop->corner.y, film.crop->size.x, film.crop->size.y}) : Json();
}

Json rowsOf(const Film& film)
{
    const bool all = film.rowsAbove == 0 && film.rowsBelow == 0;
    return all ? Json() : Json::array({film.rowsAbove, film.rowsAbove + film.height});
}

Json lookOf(const RenderReport& report)
{
    return report.look ? Json{{"exposure", report.look->exposure}, {"tone", getName(report.look->tone)}} : Json(nullptr);
}

Json statisticsOf(const RenderReport& report)
{
    const RenderStatistics& s = report.statistics;
    const std::uint64_t rays = s.cameraAndBounceRays + s.shadowRays;
    return {{"scene", report.options.scene.string()},
            {"size", Json::array({report.film.width, report.film.height})},
            {"rows", rowsOf(report.film)},
            {"crop", cropOf(report.film)},
            {"sampleRange", Json::array({report.film.sampleRanges[0].first, report.film.sampleRanges[0].second})},
            {"settings", report.film.identity.settings},
            {"schedule", getName(s.schedule)},
            {"stopReason", report.stopReason},
            {"device", {{"name", report.device.name}, {"driver", report.device.driver}, {"kind", report.device.kind}}},
            {"seconds",
             {{"load", report.prepared.loadSeconds},
              {"build", report.prepared.buildSeconds},
              {"upload", s.uploadSeconds},
              {"compile", s.compileSeconds},
              {"firstPass", s.firstPassSeconds},
              {"render", s.renderSeconds},
              {"write", report.writeSeconds},
              {"ids", report.idSeconds}}},
            {"samples", s.samples},
            {"resumedSamples", s.resumedSamples},
            {"digest", report.digests.film},
            {"pixelsDigest", report.digests.pixels},
            {"samplesPerSecond", perSecond(s.samples, s.renderSeconds)},
            {"rays", {{"closest", s.cameraAndBounceRays}, {"shadow", s.shadowRays}, {"total", rays}}},
            {"raysPerSecond", perSecond(rays, s.renderSeconds)},
            {"kernels", kernelsOf(s)},
            {"longestDispatchSeconds", s.longestDispatch},
            {"textureBytes", textureBytes(report.prepared.flat)},
            {"peakMemory", {{"host", peakHostMemory()}, {"device", s.peakDeviceMemory}}},
            {"nonFinite", nonFiniteOf(s, report.film.width)},
            {"loopCapHits", s.loopCaps},
            {"overflows", s.overflows},
            {"transparencyCaps", s.transparencyCaps},
            {"mediaCaps", s.mediaCaps},
            {"scatteringCaps", s.scatteringCaps},
            {"cutThroughput", s.cutThroughput},
            {"lightPathsPerSample", report.film.splats.empty() ? Json(nullptr) : Json(lightPathsOf(report.film))},
            {"guide", guideOf(report)},
            {"look", lookOf(report)},
            {"clampIndirect", clampingOf(report.film, report.options)},
            {"estimate", report.error ? describeEstimate(*report.error) : Json(nullptr)},
            {"rmseOfMeanBound", boundOf(report)},
            {"alphaRmse", alphaRmseJson(report.film)},
            {"denoised", report.denoising ? denoisingJson(*report.denoising) : Json(nullptr)},
            {"pixelsWithoutEstimate", pixelsWithoutError(report.film)},
            {"bvh", bvhOf(report)},
            {"adaptive", adaptiveOf(report)},
            {"steps", countSteps(report)},
            {"suspects", suspectsOf(report)}};
}

void warnOfExposure(const RenderReport& report)
{
    const RenderJob& options = report.options;
    if (report.look && options.settings.aov == Aov::Radiance) {
        if (const auto advice = adviseExposure(report.film, *report.look)) {
            say(Severity::Warning, Message(*advice, {part::file(options.pictures.front()), " ", advice->sentence, "."}));
        }
    }
}

std::string causticsText(const RenderReport& report)
{
    return report.film.splats.empty() ? "" : format(", caustics by %u light paths a sample", lightPathsOf(report.film));
}

std::string guideText(const RenderReport& report)
{
    if (!report.guide) {
        return "";
    }
    const auto& [guide, gain] = *report.guide;
    const char* const from = report.keepsGuide ? " (from the checkpoint)" : "";
    if (!guide) {
        return std::string(", without a guide, which would not pay") + from;
    }
    return format(", guided by %u cells that %.3g paths made in %.3g s%s", guide->cells, static_cast<double>(guide->paths), guide->seconds,
                  from) +
           (gain ? format(" for %.2g times less noise in the same time", *gain) : "");
}

std::string rangeText(const RenderReport& report)
{
    if (report.options.settings.adaptive == Adaptive::Off && !report.options.rates) {
        return "";
    }
    const Rates rates = computeRates(report.film);
    return format(" (%u to %u)", rates.least, rates.most);
}

std::string savingText(const RenderReport& report)
{
    const RenderSettings& settings = report.options.settings;
    if (!isCourse(settings.adaptive) || !report.film.complete) {
        return "";
    }
    const double share = computeRates(report.film).mean / settings.sampleEnd;
    return format(", %.1f %% fewer samples than %u everywhere", 100.0 * (1.0 - share), settings.sampleEnd);
}

std::string qualityText(const RenderReport& report)
{
    const Aov aov = report.options.settings.aov;
    if (aov == Aov::BvhSteps) {
        const Steps steps = computeSteps(report.film);
        return format(", %.1f node visits per ray, at most %.1f in a pixel", steps.nodes, steps.mostNodes);
    }
    if (aov != Aov::Radiance) {
        return "";
    }
    std::string text = report.error ? errorText(*report.error, report.film, report.options.settings) : "";
    if (report.bias) {
        const Interval& bias = report.bias->bias;
        text += format(", bias %+.2f %% [%+.2f, %+.2f] by %zu control pixels", 100.0 * bias.value, 100.0 * bias.low, 100.0 * bias.high,
                       report.bias->pixels);
    }
    if (const std::optional<double> alpha = computeAlphaRmse(report.film)) {
        text += format(", RMSE of the shadows' alpha %.2g", *alpha);
    }
    if (report.denoising) {
        text += denoisingText(*report.denoising);
    }
    return text;
}

void printSuspects(const RenderReport& report, std::ostream& out)
{
    if (report.options.settings.suspects == 0) {
        return;
    }
    out << "Brightest samples, at most one per pixel: " << report.suspects.size() << "\n";
    for (const Suspect& suspect : report.suspects) {
        const glm::dvec3 radiance(suspect.radiance);
        const auto percent = [](double share) { return std::isfinite(share) ? format("%.3g %%", 100.0 * share) : "an unknown share"; };
        out << format("  luminance %-9.4g (%.4g, %.4g, %.4g), ", suspect.luminance, radiance.r, radiance.g, radiance.b)
            << percent(suspect.shareOfPixel) << " of its pixel, " << percent(suspect.shareOfPicture) << " of the picture: --replay "
            << replayOf(suspect, report.film.width) << "\n";
    }
}

double countSamples(const Film& film)
{
    return std::accumulate(film.pixels.begin(), film.pixels.end(), 0.0, [](double sum, const PixelMoments& p) { return sum + p.count; });
}

}  // namespace

void warnOfPicture(const Film& film, const RenderStatistics& statistics, const RenderSettings& settings)
{
    const auto gaps = std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return p.count == 0; });
    if (gaps > 0) {
        warn(MessageId::PixelsWithoutSamples,
             {part::value(std::to_string(gaps)), " of ", std::to_string(film.pixels.size()), " pixels have no sample and are black."});
    }
    if (statistics.nonFinite > 0) {
        const Located& first = statistics.located[0];
        warn(
            MessageId::NonFiniteSamples,
            {part::value(std::to_string(statistics.nonFinite)), " samples were not finite and were discarded; the first: ",
             part::place(format("pixel (%u, %u), sample %u", first.pixel % film.width, first.pixel / film.width, first.sampleIndex)), "."});
    }
    const auto unheld = std::count_if(film.pixels.begin(), film.pixels.end(), [](const PixelMoments& p) { return !isFinite(p.mean); });
    if (unheld > 0 && settings.aov == Aov::Radiance) {
        warn(MessageId::NonFinitePixels,
             {part::value(std::to_string(unheld)), " pixels are not finite: float32 does not hold the sums of their samples."});
    }
    if (statistics.transparencyCaps > 0) {
        warn(MessageId::TransparencyCap,
             {part::value(std::to_string(statistics.transparencyCaps)),
              " rays met more transparent surfaces in a row than they may pass; the next one was opaque to them."});
    }
    if (statistics.mediaCaps > 0) {
        warn(MessageId::MediaCap,
             {part::value(std::to_string(statistics.mediaCaps)),
              " rays entered a solid within four others and forgot the outermost, so what these rays meet there is wrong."});
    }
    if (statistics.scatteringCaps > 0) {
        warn(MessageId::ScatteringCap,
             {part::value(std::to_string(statistics.scatteringCaps)), " paths scattered ", part::expected(std::to_string(kMaxScatterings)),
              " times between two surfaces and ended there; of light that is the same all around, the picture lacks ",
              format("%.2g %%", 100.0 * statistics.cutThroughput / countSamples(film)), "."});
    }
    if (std::isfinite(settings.clampIndirect)) {
        const ClampedEnergy energy = computeClampedEnergy(film);
        warn(MessageId::LightClamped,
             {part::place("--clamp-indirect"), " removed ", part::value(format("%g %%", 100.0 * energy.removedShare())),
              " of the picture's light ", format("(mean radiance %g).", energy.removed)});
    }
}

void printSummary(const RenderReport& report, std::ostream& out)
{
    warnOfPicture(report.film, report.statistics, report.options.settings);
    warnOfExposure(report);
    const RenderStatistics& s = report.statistics;
    const double pixels = static_cast<double>(report.film.pixels.size());
    out << escaped(report.options.mainFile().string())
        << format(": %ux%u, %.4g samples per pixel", report.film.width, report.film.height,
                  static_cast<double>(s.samples + s.resumedSamples) / pixels)
        << (s.resumedSamples > 0 ? format(", of which %.4g resumed,", static_cast<double>(s.resumedSamples) / pixels) : "")
        << rangeText(report)
        << format(" in %.2f s (%.3g Msamples/s, %.3g Mrays/s; first pass after %.2f s)", s.renderSeconds,
                  1e-6 * perSecond(s.samples, s.renderSeconds), 1e-6 * perSecond(s.cameraAndBounceRays + s.shadowRays, s.renderSeconds),
                  s.firstPassSeconds)
        << causticsText(report) << guideText(report) << savingText(report) << qualityText(report) << ", on " << report.device.name << " ("
        << report.device.kind << ")\n";
    printSuspects(report, out);
}

void writeStatistics(const std::filesystem::path& path, const RenderReport& report) { writeJson(path, statisticsOf(report)); }

}  // namespace glim
