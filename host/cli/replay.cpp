#include "host/cli/replay.hpp"

#include "host/error.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/job/output_file.hpp"
#include "host/render/describe_primitive.hpp"
#include "host/render/learn_guide.hpp"
#include "host/render/light_path_gain.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/render/replay.hpp"
#include "host/text.hpp"

#include <iostream>
#include <iterator>

namespace glim {
namespace {

struct ReplayReport {
    const RenderJob& options;
    const PreparedScene& prepared;
    const RenderSettings& settings;
    const DeviceDescription& device;
    ReplayedPath path;
};

constexpr const char* kEnds[] = {
    "continues",
    "escapes",
    "ends: path length limit (--bounces or --paths)",
    "ends: absorbed",
    "ends: the next ray could only add light already sampled here",
    "ends: roulette",
    "ends: within the volume, by roulette or after too many scatterings",
};

// By PathNote::lobe.
constexpr const char* kLobes[] = {"diffuse", "mirror", "glass", "interface", "diffuse base", "clearcoat", "sheen", "diffuse transmission"};
static_assert(std::size(kLobes) == kPrincipled + kLobeThrough + 1);
constexpr std::uint32_t kDelta = 1, kTransmitted = 2;  // lib/bsdf/bsdf_sample.glsl

// Exact: reads back as the same bits.
std::string toText(const glm::vec3& v)
{
    std::string text("(");
    text.append(exactText(v.x)).append(", ").append(exactText(v.y)).append(", ").append(exactText(v.z)).append(")");
    return text;
}

glm::dvec3 worldOf(const PreparedScene& prepared, const glm::vec3& point) { return prepared.scene.origin + glm::dvec3(point); }

std::string pointText(const glm::dvec3& p)
{
    char text[120];
    std::snprintf(text, sizeof text, "(%.7g, %.7g, %.7g)", p.x, p.y, p.z);
    return text;
}

float cosineOf(const PathVertex& vertex) { return -glm::dot(vertex.surface.ns, vertex.ray.direction); }

std::string addedText(const PathRadiance& added)
{
    return "adds " + toText(added.radiance) + (added.clamped > 0.0F ? ", clamped by " + exactText(added.clamped) : "");
}

void printSurface(const ReplayReport& report, const PathVertex& vertex)
{
    const PrimitiveDescription met = describePrimitive(report.prepared, vertex.hit.primitiveRef);
    const PathNote& note = vertex.surface;
    std::cout << toText(met) << ", material " << met.material << ", at " << pointText(worldOf(report.prepared, note.point)) << ", "
              << exactText(vertex.hit.t) << " m on\n  " << (note.front != 0 ? "front" : "back") << ", normal " << toText(note.ng)
              << (note.ns == note.ng ? "" : ", shading normal " + toText(note.ns)) << ", cosine " << exactText(cosineOf(vertex)) << "\n";
}

// What the material has there besides its base colour: name in the text, name in the JSON.
struct MaterialNumber {
    const char* text;
    const char* json;
    float PathNote::*value;
};
constexpr MaterialNumber kMaterialNumbers[] = {{"metallic", "metallic", &PathNote::metallic},
                                               {"roughness", "roughness", &PathNote::roughness},
                                               {"transmission", "transmission", &PathNote::transmission},
                                               {"diffuse transmission", "diffuseTransmission", &PathNote::diffuseTransmission},
                                               {"clearcoat", "clearcoat", &PathNote::clearcoat},
                                               {"clearcoat roughness", "clearcoatRoughness", &PathNote::clearcoatRoughness},
                                               {"sheen roughness", "sheenRoughness", &PathNote::sheenRoughness},
                                               {"anisotropy", "anisotropy", &PathNote::anisotropy},
                                               {"iridescence", "iridescence", &PathNote::iridescence},
                                               {"film thickness in nm", "filmThickness", &PathNote::filmThickness}};

void printMaterial(const ReplayReport& report, const PathNote& note)
{
    std::cout << "  base colour " << toText(note.baseColor);
    for (const MaterialNumber& number : kMaterialNumbers) {
        if (note.*number.value != 0.0F) {
            std::cout << ", " << number.text << " " << exactText(note.*number.value);
        }
    }
    if (note.sheenColor != glm::vec3(0.0F)) {
        std::cout << ", sheen colour " << toText(note.sheenColor);
    }
    if (note.alpha != 1.0F) {
        std::cout << ", alpha " << exactText(note.alpha);
    }
    if (note.medium != 0) {
        const MediumData& medium = report.prepared.flat.media[note.medium - 1];
        std::cout << "\n  reached through medium " << note.medium << ": index " << exactText(medium.ior) << ", absorption "
                  << toText(absorptionOf(report.prepared.flat, note.medium)) << " per metre";
    }
    std::cout << "\n";
}

Json materialJson(const ReplayReport& report, const PathNote& note)
{
    Json json = {{"baseColor", Json::array({note.baseColor.r, note.baseColor.g, note.baseColor.b})}};
    for (const MaterialNumber& number : kMaterialNumbers) {
        json.set(number.json, note.*number.value);
    }
    json.set("sheenColor", Json::array({note.sheenColor.r, note.sheenColor.g, note.sheenColor.b}));
    json.set("alpha", note.alpha);
    json.set("medium", nullptr);
    if (note.medium != 0) {
        const vec3 absorption = absorptionOf(report.prepared.flat, note.medium);
        json.set("medium", {{"number", note.medium},
                            {"ior", report.prepared.flat.media[note.medium - 1].ior},
                            {"absorption", Json::array({absorption.r, absorption.g, absorption.b})}});
    }
    return json;
}

std::uint32_t countScatterings(const PathVertex& vertex) { return static_cast<std::uint32_t>(std::max(0.0F, -vertex.before.cosine)); }

void printArrival(const PathVertex& vertex)
{
    if (const std::uint32_t count = countScatterings(vertex)) {
        std::cout << "  after " << counted(count, "scattering") << " in the volume\n";
    }
    std::cout << "  ray from pdf " << (vertex.before.pdf > 0.0F ? exactText(vertex.before.pdf) + " per sr" : "0 (camera or delta lobe)")
              << ", throughput " << toText(vertex.before.throughput) << "\n";
    // The light that the ray has hit may have weight 0, since light sampling finds it as well.
    if (vertex.emitted.radiance != glm::vec3(0.0F) || vertex.surface.misWeightOfHit != 1.0F) {
        std::cout << "  light hit: MIS weight " << exactText(vertex.surface.misWeightOfHit)
                  << (vertex.surface.lightPdfOfHit > 0.0F
                          ? " against a light sampling pdf of " + exactText(vertex.surface.lightPdfOfHit) + " per sr"
                          : "")
                  << ", " << addedText(vertex.emitted) << "\n";
    }
}

// Whether the next direction was sampled with a guide, and the path had a use for it.
bool isGuided(const PathVertex& vertex)
{
    return vertex.bsdf.guideShare > 0.0F && vertex.end != PathEnd::LastBounce && vertex.end != PathEnd::Roulette;
}

bool isDelta(const PathVertex& vertex) { return (vertex.bsdf.lobeFlags & kDelta) != 0; }

// The guide knows no lobes.
const char* lobeOf(const PathVertex& vertex) { return vertex.bsdf.isByGuide != 0 ? nullptr : kLobes[vertex.bsdf.lobe]; }

void printSampledLight(const ReplayReport& report, const SampledLight& each)
{
    const PathNote& note = each.note;
    std::cout << "  light sampled: " << (each.hemisphere ? "a direction of the hemisphere" : describeLight(report.prepared, note.light));
    if (!each.hasShadowRay) {
        std::cout << ", no contribution\n";
        return;
    }
    std::cout << " towards " << toText(each.ray.direction);
    if (!each.hemisphere) {
        std::cout << ", pdf " << (note.lightPdf > 0.0F ? exactText(note.lightPdf) + " per sr" : "0 (delta light)") << " against "
                  << (note.guideShare > 0.0F ? "that of BSDF and guide, " : "the BSDF's ") << exactText(note.bsdfPdf) << ", MIS weight "
                  << exactText(note.misWeightOfLight);
    }
    const bool lost = each.added.radiance == glm::vec3(0.0F);
    std::cout << ", "
              << (!lost             ? addedText(each.added)
                  : each.hemisphere ? "hits no light"
                                    : "occluded (would add " + toText(each.ray.contribution) + ")")
              << "\n";
}

void printGuide(const PathVertex& vertex)
{
    const PathNote& note = vertex.bsdf;
    std::cout << "  direction chosen by the " << (note.isByGuide != 0 ? "guide" : "BSDF") << ", guide's share "
              << exactText(note.guideShare);
    if (isDelta(vertex)) {
        std::cout << ": a delta lobe, which has no pdf\n";
        return;
    }
    std::cout << ": pdf of the guide " << exactText(note.guidePdf) << " per sr, of the BSDF " << exactText(note.nextBsdfPdf) << ", mixed "
              << exactText(note.nextPdf) << "\n";
}

void printScattering(const PathVertex& vertex)
{
    if (isGuided(vertex)) {
        printGuide(vertex);
    }
    std::cout << "  " << kEnds[static_cast<int>(vertex.end)];
    if (vertex.end == PathEnd::Continues) {
        const char* lobe = lobeOf(vertex);
        std::cout << (lobe != nullptr ? std::string(" by its ") + lobe + " lobe" : " by the guide") << (isDelta(vertex) ? ", delta" : "")
                  << ((vertex.bsdf.lobeFlags & kTransmitted) != 0 ? ", to the other side" : "") << ", with pdf "
                  << exactText(vertex.after.pdf) << ", weight " << toText(vertex.bsdf.weight) << ", throughput "
                  << toText(vertex.after.throughput);
    }
    if (vertex.bsdf.continuation > 0.0F) {
        std::cout << ", continuation probability " << exactText(vertex.bsdf.continuation);
    }
    std::cout << "\n";
}

void printVertex(const ReplayReport& report, const PathVertex& vertex)
{
    std::cout << "bounce " << vertex.bounce << ": ";
    if (vertex.hit.primitiveRef == kNoPrimitiveRef) {
        std::cout << "nothing along " << toText(vertex.ray.direction) << "\n";
        printArrival(vertex);
        return;
    }
    printSurface(report, vertex);
    printMaterial(report, vertex.surface);
    printArrival(vertex);
    if (vertex.bsdf.arrival > 0.0F) {
        std::cout << "  roulette on arrival: continuation probability " << exactText(vertex.bsdf.arrival) << "\n";
    }
    for (const SampledLight& each : vertex.sampledLights) {
        printSampledLight(report, each);
    }
    printScattering(vertex);
}

Json jsonOf(const glm::vec3& v) { return Json::array({v.x, v.y, v.z}); }
Json jsonOf(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }
Json jsonOf(const PathRadiance& added) { return {{"added", jsonOf(added.radiance)}, {"clamped", added.clamped}}; }

Json surfaceJson(const ReplayReport& report, const PathVertex& vertex)
{
    if (vertex.hit.primitiveRef == kNoPrimitiveRef) {
        return nullptr;
    }
    const PrimitiveDescription met = describePrimitive(report.prepared, vertex.hit.primitiveRef);
    return {{"object", met.object},
            {"triangle", met.triangle ? Json(*met.triangle) : Json()},
            {met.isLine ? "line" : "point", met.point ? Json(*met.point) : Json()},
            {"material", met.material},
            {"values", materialJson(report, vertex.surface)},
            {"position", jsonOf(worldOf(report.prepared, vertex.surface.point))},
            {"distance", vertex.hit.t},
            {"front", vertex.surface.front != 0},
            {"normal", jsonOf(vertex.surface.ng)},
            {"shadingNormal", jsonOf(vertex.surface.ns)},
            {"cosine", cosineOf(vertex)}};
}

Json lightJson(const ReplayReport& report, const SampledLight& each)
{
    Json json = {{"light", each.hemisphere ? Json() : Json(describeLight(report.prepared, each.note.light))},
                 {"pdf", each.note.lightPdf},
                 {"bsdfPdf", each.note.bsdfPdf},
                 {"weight", each.note.misWeightOfLight},
                 {"shadowRay", nullptr}};
    if (each.hasShadowRay) {
        json.set("shadowRay", {{"origin", jsonOf(worldOf(report.prepared, each.ray.origin))},
                               {"direction", jsonOf(each.ray.direction)},
                               {"contribution", jsonOf(each.ray.contribution)}});
    }
    json.update(jsonOf(each.added));
    return json;
}

Json vertexJson(const ReplayReport& report, const PathVertex& vertex)
{
    Json sampled = Json::array();
    for (const SampledLight& each : vertex.sampledLights) {
        sampled.append(lightJson(report, each));
    }
    Json emission = {{"pdf", vertex.surface.lightPdfOfHit}, {"weight", vertex.surface.misWeightOfHit}};
    emission.update(jsonOf(vertex.emitted));
    Json json = {{"bounce", vertex.bounce},
                 {"origin", jsonOf(worldOf(report.prepared, vertex.ray.origin))},
                 {"direction", jsonOf(vertex.ray.direction)},
                 {"pdf", vertex.before.pdf},
                 {"throughput", jsonOf(vertex.before.throughput)},
                 {"scatterings", countScatterings(vertex)},
                 {"surface", surfaceJson(report, vertex)},
                 {"emission", emission},
                 {"sampledLights", sampled},
                 {"end", kEnds[static_cast<int>(vertex.end)]},
                 {"continuation", vertex.bsdf.continuation},
                 {"continuationOnArrival", vertex.bsdf.arrival},
                 {"guide", nullptr},
                 {"next", nullptr}};
    if (isGuided(vertex)) {
        const PathNote& note = vertex.bsdf;
        json.set("guide", {{"chose", note.isByGuide != 0},
                           {"share", note.guideShare},
                           {"guidePdf", note.guidePdf},
                           {"bsdfPdf", note.nextBsdfPdf},
                           {"pdf", note.nextPdf}});
    }
    if (vertex.end == PathEnd::Continues) {
        const char* lobe = lobeOf(vertex);
        json.set("next", {{"lobe", lobe != nullptr ? Json(lobe) : Json()},
                          {"delta", isDelta(vertex)},
                          {"transmitted", (vertex.bsdf.lobeFlags & kTransmitted) != 0},
                          {"weight", jsonOf(vertex.bsdf.weight)},
                          {"pdf", vertex.after.pdf},
                          {"throughput", jsonOf(vertex.after.throughput)}});
    }
    return json;
}

void printReplay(const ReplayReport& report)
{
    const SamplePlace& place = *report.options.replay;
    std::cout << report.options.scene.string() << ", " << report.settings.width << "x" << report.settings.height << ": pixel (" << place.x
              << ", " << place.y << "), sample " << place.sample << ", on " << report.device.name << "\n";
    if (!report.path.vertices.empty()) {
        const PathRay& ray = report.path.vertices.front().ray;
        std::cout << "camera at " << pointText(worldOf(report.prepared, ray.origin)) << " towards " << toText(ray.direction) << "\n";
    }
    for (const PathVertex& vertex : report.path.vertices) {
        printVertex(report, vertex);
    }
    std::cout << "radiance " << toText(report.path.radiance.radiance) << " W/(sr m^2)\n";
}

void writeReplay(const std::filesystem::path& file, const ReplayReport& report)
{
    Json vertices = Json::array();
    for (const PathVertex& vertex : report.path.vertices) {
        vertices.append(vertexJson(report, vertex));
    }
    const SamplePlace& place = *report.options.replay;
    const Json json = {{"scene", report.options.scene.string()},
                       {"size", Json::array({report.settings.width, report.settings.height})},
                       {"x", place.x},
                       {"y", place.y},
                       {"sample", place.sample},
                       {"settings", describeSettings(report.settings) + describeCamera(report.options.pose, report.options.field,
                                                                                       report.options.lens, report.options.projection)},
                       {"device", {{"name", report.device.name}, {"driver", report.device.driver}, {"kind", report.device.kind}}},
                       {"radiance", jsonOf(report.path.radiance.radiance)},
                       {"clamped", report.path.radiance.clamped},
                       {"vertices", vertices}};
    writeJson(file, json);
}

}  // namespace

void runReplay(const RenderJob& options)
{
    if (options.stats) {
        checkTarget(*options.stats, ".json", {options.scene});
    }
    const VulkanInstance instance;
    Device device(instance, options.device);
    const PreparedScene prepared = prepareScene(options.scene, makeLoadOptions(options), options.split);
    const Camera camera = makeCamera(prepared.scene, options);
    sayIfCameraIsNumber(prepared.scene, options.camera);
    RenderSettings settings = settingsFor(options, camera);
    refuseOutside("--replay", {options.replay->x, options.replay->y}, settings);
    const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
    const FlatCamera flatCamera = flattenCamera(prepared, camera, aspect, options.lens);
    if (options.caustics == CausticsChoice::Auto) {
        settings.caustics = choosesLightPaths(device, prepared.flat, flatCamera, settings);
    }
    if (options.guiding != GuidingChoice::Off) {
        const GuideUse use = options.guiding == GuidingChoice::On ? GuideUse::Always : GuideUse::IfItPays;
        settings.guide = learnGuide(device, prepared.flat, flatCamera, settings, use).guide;
    }
    Replay replay(device, prepared.flat, flatCamera, settings);
    const SamplePlace& place = *options.replay;
    const ReplayReport report{options, prepared, settings, device.description(),
                              replay.trace(place.y * settings.width + place.x, place.sample)};
    if (options.stats) {
        writeReplay(*options.stats, report);
    }
    printReplay(report);
}

}  // namespace glim
