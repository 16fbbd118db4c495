#include "host/cli/commands.hpp"
#include "host/cli/parse.hpp"
#include "host/json.hpp"
#include "host/render/prepare_scene.hpp"

#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

namespace glim {
namespace {

struct InspectOptions {
    std::filesystem::path scene;
    std::optional<std::size_t> sceneIndex;
    bool json = false;
};

using Counts = std::vector<std::pair<const char*, std::size_t>>;
using Needs = std::vector<std::pair<const char*, bool>>;

Counts countsOf(const PreparedScene& prepared)
{
    return {{"triangles", prepared.primitives.triangles.size()},
            {"spheres", prepared.scene.spheres.size()},
            {"meshes", prepared.scene.meshes.size()},
            {"instances", prepared.scene.instances.size()},
            {"materials", prepared.scene.materials.size()},
            {"images", prepared.scene.images.size()},
            {"lights", prepared.flat.lights.size()},
            {"emitters", prepared.flat.emitters.size()},
            {"cameras", prepared.scene.cameras.size()}};
}

Needs needsOf(std::uint32_t features)
{
    Needs needs;
    for (const Feature& feature : kFeatures) {
        needs.emplace_back(feature.name, (features & feature.bit) != 0);
    }
    return needs;
}

struct Bounds {
    glm::dvec3 low, high;  // world coordinates, metres
};

Bounds boundsOf(const PreparedScene& prepared)
{
    const Box& box = prepared.bvh.box;
    return {prepared.scene.origin + glm::dvec3(box.lo), prepared.scene.origin + glm::dvec3(box.hi)};
}

const char* kindOf(const Camera& camera) { return camera.kind == Camera::Kind::Perspective ? "perspective" : "orthographic"; }

Json pointOf(const glm::dvec3& p) { return Json::array({p.x, p.y, p.z}); }

template <class Entries>
Json objectOf(const Entries& entries)
{
    Json json = Json::object();
    for (const auto& [name, value] : entries) {
        json.set(name, value);
    }
    return json;
}

void printJson(const InspectOptions& options, const PreparedScene& prepared)
{
    Json cameras = Json::array();
    for (const Camera& camera : prepared.scene.cameras) {
        cameras.append({{"name", camera.name}, {"kind", kindOf(camera)}});
    }
    const Bounds bounds = boundsOf(prepared);
    const Json json = {{"scene", options.scene.string()},
                       {"counts", objectOf(countsOf(prepared))},
                       {"bounds", {{"low", pointOf(bounds.low)}, {"high", pointOf(bounds.high)}}},
                       {"bvh",
                        {{"nodes", prepared.bvh.nodes.size()},
                         {"records", prepared.bvh.order.size()},
                         {"depth", prepared.bvh.depth},
                         {"surfaceAreaCost", prepared.bvh.cost},
                         {"buildSeconds", prepared.buildSeconds}}},
                       {"loadSeconds", prepared.loadSeconds},
                       {"deviceBytes", sizeInBytes(prepared.flat)},
                       {"textureBytes", textureBytes(prepared.flat)},
                       {"variants", prepared.scene.variants},
                       {"needs", objectOf(needsOf(prepared.flat.features))},
                       {"cameras", cameras},
                       {"warnings", prepared.scene.warnings}};
    std::cout << json.dump(2) << '\n';
}

// Three digits, as in 12.3 or 0.000456; above 999 a whole number.
std::string threeDigits(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, value < 999.5 ? "%.3g" : "%.0f", value);
    return text;
}

std::string pointText(const glm::dvec3& p)
{
    char text[64];
    std::snprintf(text, sizeof text, "(%.3g, %.3g, %.3g)", p.x, p.y, p.z);
    return text;
}

void printText(const InspectOptions& options, const PreparedScene& prepared)
{
    std::cout << options.scene.string() << '\n';
    for (const auto& [name, count] : countsOf(prepared)) {
        std::cout << "  " << name << ' ' << count << '\n';
    }
    const Bounds bounds = boundsOf(prepared);
    std::cout << "  bounds " << pointText(bounds.low) << " to " << pointText(bounds.high) << " m\n"
              << "  BVH: " << prepared.bvh.nodes.size() << " nodes, depth " << prepared.bvh.depth << ", surface-area cost "
              << threeDigits(static_cast<double>(prepared.bvh.cost)) << ", built in " << threeDigits(prepared.buildSeconds) << " s\n"
              << "  on the device: " << threeDigits(static_cast<double>(sizeInBytes(prepared.flat)) / (1 << 20)) << " MiB, "
              << threeDigits(static_cast<double>(textureBytes(prepared.flat)) / (1 << 20)) << " MiB of it textures\n  needs:";
    const char* separator = " ";
    for (const auto& [name, needed] : needsOf(prepared.flat.features)) {
        if (needed) {
            std::cout << separator << name;
            separator = ", ";
        }
    }
    std::cout << (*separator == ' ' ? " nothing but flat diffuse triangles\n" : "\n");
    for (const std::string& variant : prepared.scene.variants) {
        std::cout << "  variant \"" << variant << "\"\n";
    }
    for (std::size_t i = 0; i < prepared.scene.cameras.size(); ++i) {
        const Camera& camera = prepared.scene.cameras[i];
        std::cout << "  camera " << i << " \"" << camera.name << "\", " << kindOf(camera) << '\n';
    }
}

void runInspect(const InspectOptions& options)
{
    const PreparedScene prepared = prepareScene(options.scene, {options.sceneIndex, {}});
    warnIfNoLights(prepared);
    if (options.json) {
        printJson(options, prepared);
    } else {
        printText(options, prepared);
    }
}

}  // namespace

void addInspect(CommandLine& line)
{
    auto options = std::make_shared<InspectOptions>();
    const Command command = line.addCommand("inspect", "Print what a scene contains, costs and needs");
    command.beginGroup("Picture");
    command.addPath("SCENE", "FILE", "Scene, .gltf or .glb", options->scene).require();
    addSceneIndex(command, options->sceneIndex);
    command.beginGroup("Output");
    command.addFlag("--json", "Print JSON with every digit; sizes in bytes", options->json);
    command.onRun([options] {
        runInspect(*options);
        return ExitCode::Done;
    });
}

}  // namespace glim
