#include "host/cli/replay_report.hpp"

#include "host/exact_text.hpp"
#include "host/flatten/view_options.hpp"
#include "host/image/whole_file.hpp"
#include "host/render/describe_primitive.hpp"

#include <nlohmann/json.hpp>

#include <iostream>

namespace glim {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFates[] = {"goes on",
                                  "meets nothing",
                                  "ends: no further bounce is asked for",
                                  "ends: absorbed",
                                  "ends: what the next ray could find was sampled here",
                                  "ends: roulette"};

// Exact: reads back as the same bits.
std::string textOf(const glm::vec3& v)
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

float cosineOf(const PathVertex& vertex) { return -glm::dot(vertex.met.shading, vertex.ray.direction); }

std::string addedText(const PathRadiance& added)
{
    return "adds " + textOf(added.radiance) + (added.clamped > 0.0F ? ", clamped by " + exactText(added.clamped) : "");
}

void printSurface(const ReplayReport& report, const PathVertex& vertex)
{
    const PrimitiveDescription met = describeRecord(report.prepared.scene, report.prepared.flat, vertex.hit.record);
    const PathNote& note = vertex.met;
    std::cout << textOf(met) << ", material " << met.material << ", at " << pointText(worldOf(report.prepared, note.point)) << ", "
              << exactText(vertex.hit.t) << " m on\n  " << (note.front != 0 ? "front" : "back") << ", normal " << textOf(note.geometric)
              << (note.shading == note.geometric ? "" : ", shading normal " + textOf(note.shading)) << ", cosine "
              << exactText(cosineOf(vertex)) << "\n";
}

void printArrival(const PathVertex& vertex)
{
    std::cout << "  ray from pdf "
              << (vertex.before.pdf > 0.0F ? exactText(vertex.before.pdf) + " per sr" : "0, which no sampling of lights finds")
              << ", throughput " << textOf(vertex.before.throughput) << "\n";
    // Light that was found may count nothing, since sampling finds it as well.
    if (vertex.found.radiance != glm::vec3(0.0F) || vertex.met.foundWeight != 1.0F) {
        std::cout << "  light found: weight " << exactText(vertex.met.foundWeight)
                  << (vertex.met.foundPdf > 0.0F ? " against light sampling's pdf " + exactText(vertex.met.foundPdf) + " per sr" : "")
                  << ", " << addedText(vertex.found) << "\n";
    }
}

void printTry(const ReplayReport& report, const LightTry& each)
{
    const PathNote& note = each.note;
    std::cout << "  light sampled: "
              << (each.hemisphere ? "a direction of the hemisphere"
                                  : describeLight(report.prepared.scene, report.prepared.flat, note.light));
    if (!each.asked) {
        std::cout << ", sends nothing here\n";
        return;
    }
    std::cout << " towards " << textOf(each.ray.direction);
    if (!each.hemisphere) {
        std::cout << ", pdf " << (note.lightPdf > 0.0F ? exactText(note.lightPdf) + " per sr" : "0, which scattering cannot find")
                  << " against scattering's " << exactText(note.scatterPdf) << ", weight " << exactText(note.lightWeight);
    }
    const bool lost = each.added.radiance == glm::vec3(0.0F);
    std::cout << ", "
              << (!lost             ? addedText(each.added)
                  : each.hemisphere ? "finds none"
                                    : "in the shadow, which loses " + textOf(each.ray.contribution))
              << "\n";
}

void printScattering(const PathVertex& vertex)
{
    std::cout << "  " << kFates[static_cast<int>(vertex.fate)];
    if (vertex.fate == PathFate::GoesOn) {
        std::cout << " with pdf " << exactText(vertex.after.pdf) << ", weight " << textOf(vertex.scattered.weight)
                  << ", throughput " << textOf(vertex.after.throughput);
    }
    if (vertex.scattered.survival > 0.0F) {
        std::cout << ", survival " << exactText(vertex.scattered.survival);
    }
    std::cout << "\n";
}

void printVertex(const ReplayReport& report, const PathVertex& vertex)
{
    std::cout << "bounce " << vertex.bounce << ": ";
    if (vertex.hit.record == kNoRecord) {
        std::cout << "nothing along " << textOf(vertex.ray.direction) << "\n";
        printArrival(vertex);
        return;
    }
    printSurface(report, vertex);
    printArrival(vertex);
    for (const LightTry& each : vertex.tries) {
        printTry(report, each);
    }
    printScattering(vertex);
}

Json jsonOf(const glm::vec3& v) { return {v.x, v.y, v.z}; }
Json jsonOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
Json jsonOf(const PathRadiance& added) { return {{"added", jsonOf(added.radiance)}, {"clamped", added.clamped}}; }

Json surfaceJson(const ReplayReport& report, const PathVertex& vertex)
{
    if (vertex.hit.record == kNoRecord) {
        return nullptr;
    }
    const PrimitiveDescription met = describeRecord(report.prepared.scene, report.prepared.flat, vertex.hit.record);
    return {{"object", met.object},
            {"triangle", met.triangle ? Json(*met.triangle) : Json(nullptr)},
            {"material", met.material},
            {"position", jsonOf(worldOf(report.prepared, vertex.met.point))},
            {"distance", vertex.hit.t},
            {"front", vertex.met.front != 0},
            {"normal", jsonOf(vertex.met.geometric)},
            {"shadingNormal", jsonOf(vertex.met.shading)},
            {"cosine", cosineOf(vertex)}};
}

Json tryJson(const ReplayReport& report, const LightTry& each)
{
    Json json = {{"light", each.hemisphere ? Json(nullptr)
                                           : Json(describeLight(report.prepared.scene, report.prepared.flat, each.note.light))},
                 {"pdf", each.note.lightPdf},
                 {"scatterPdf", each.note.scatterPdf},
                 {"weight", each.note.lightWeight},
                 {"shadowRay", nullptr}};
    if (each.asked) {
        json["shadowRay"] = {{"origin", jsonOf(worldOf(report.prepared, each.ray.origin))},
                             {"direction", jsonOf(each.ray.direction)},
                             {"contribution", jsonOf(each.ray.contribution)}};
    }
    json.update(jsonOf(each.added));
    return json;
}

Json vertexJson(const ReplayReport& report, const PathVertex& vertex)
{
    Json tries = Json::array();
    for (const LightTry& each : vertex.tries) {
        tries.push_back(tryJson(report, each));
    }
    Json found = {{"pdf", vertex.met.foundPdf}, {"weight", vertex.met.foundWeight}};
    found.update(jsonOf(vertex.found));
    Json json = {{"bounce", vertex.bounce},
                 {"origin", jsonOf(worldOf(report.prepared, vertex.ray.origin))},
                 {"direction", jsonOf(vertex.ray.direction)},
                 {"pdf", vertex.before.pdf},
                 {"throughput", jsonOf(vertex.before.throughput)},
                 {"surface", surfaceJson(report, vertex)},
                 {"found", found},
                 {"sampled", tries},
                 {"fate", kFates[static_cast<int>(vertex.fate)]},
                 {"survival", vertex.scattered.survival},
                 {"next", nullptr}};
    if (vertex.fate == PathFate::GoesOn) {
        json["next"] = {{"weight", jsonOf(vertex.scattered.weight)},
                        {"pdf", vertex.after.pdf},
                        {"throughput", jsonOf(vertex.after.throughput)}};
    }
    return json;
}

}  // namespace

void printReplay(const ReplayReport& report)
{
    const SamplePlace& place = *report.options.replay;
    std::cout << report.options.scene.string() << ", " << report.settings.width << "x" << report.settings.height << ": pixel ("
              << place.x << ", " << place.y << "), sample " << place.sample << ", on " << report.device.name << "\n";
    if (!report.path.vertices.empty()) {
        const PathRay& ray = report.path.vertices.front().ray;
        std::cout << "camera at " << pointText(worldOf(report.prepared, ray.origin)) << " towards " << textOf(ray.direction) << "\n";
    }
    for (const PathVertex& vertex : report.path.vertices) {
        printVertex(report, vertex);
    }
    std::cout << "radiance " << textOf(report.path.radiance.radiance) << " W/(sr m^2)\n";
}

void writeReplay(const std::filesystem::path& file, const ReplayReport& report)
{
    Json vertices = Json::array();
    for (const PathVertex& vertex : report.path.vertices) {
        vertices.push_back(vertexJson(report, vertex));
    }
    const SamplePlace& place = *report.options.replay;
    const Json json = {{"scene", report.options.scene.string()},
                       {"size", {report.settings.width, report.settings.height}},
                       {"x", place.x},
                       {"y", place.y},
                       {"sample", place.sample},
                       {"settings", describeSettings(report.settings) + describeView(report.options.pose, report.options.lens)},
                       {"device", {{"name", report.device.name}, {"driver", report.device.driver}, {"kind", report.device.kind}}},
                       {"radiance", jsonOf(report.path.radiance.radiance)},
                       {"clamped", report.path.radiance.clamped},
                       {"vertices", vertices}};
    const std::string text = json.dump(2) + "\n";
    WholeFile whole(file);
    whole.write(text.data(), text.size());
    whole.commit();
}

}  // namespace glim
