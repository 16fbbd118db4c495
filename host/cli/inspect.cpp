#include "host/cli/inspect.hpp"

#include "host/cli/parse.hpp"
#include "host/render/prepare_scene.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <iostream>
#include <memory>
#include <optional>

namespace glim {
namespace {

using Json = nlohmann::ordered_json;

struct InspectOptions {
    std::filesystem::path scene;
    std::optional<std::size_t> sceneIndex;
    bool json = false;
};

Json pointOf(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

Json countsOf(const PreparedScene& prepared)
{
    return {{"triangles", prepared.scene.triangles.size()},
            {"spheres", prepared.scene.spheres.size()},
            {"primitives", prepared.scene.primitives.size()},
            {"materials", prepared.scene.materials.size()},
            {"lights", prepared.flat.lights.size()},
            {"emitters", prepared.flat.emitters.size()},
            {"cameras", prepared.scene.cameras.size()}};
}

Json needsOf(const SceneFeatures& features)
{
    return {{"spheres", features.spheres},
            {"slivers", features.slivers},
            {"smooth normals", features.smooth},
            {"mirrors", features.mirrors},
            {"glass", features.glasses},
            {"triangle lights", features.triangleLights},
            {"sphere lights", features.sphereLights},
            {"punctual lights", features.punctualLights},
            {"environment", features.environment}};
}

Json describe(const InspectOptions& options, const PreparedScene& prepared)
{
    const Box& box = prepared.bvh.box;
    Json cameras = Json::array();
    for (const Camera& camera : prepared.scene.cameras) {
        cameras.push_back({{"name", camera.name},
                           {"kind", camera.kind == Camera::Kind::Perspective ? "perspective" : "orthographic"}});
    }
    return {{"scene", options.scene.string()},
            {"counts", countsOf(prepared)},
            {"bounds",
             {{"low", pointOf(prepared.scene.origin + glm::dvec3(box.lo))},
              {"high", pointOf(prepared.scene.origin + glm::dvec3(box.hi))}}},
            {"bvh",
             {{"nodes", prepared.bvh.nodes.size()},
              {"records", prepared.bvh.order.size()},
              {"depth", prepared.bvh.depth},
              {"surfaceAreaCost", prepared.bvh.cost},
              {"buildSeconds", prepared.buildSeconds}}},
            {"loadSeconds", prepared.loadSeconds},
            {"deviceBytes", sizeInBytes(prepared.flat)},
            {"needs", needsOf(prepared.flat.features)},
            {"cameras", cameras},
            {"notices", prepared.scene.notices}};
}

void printText(const Json& d)
{
    std::cout << d["scene"].get<std::string>() << '\n';
    for (const auto& [name, count] : d["counts"].items()) {
        std::cout << "  " << name << ' ' << count << '\n';
    }
    std::cout << "  bounds " << d["bounds"]["low"] << " to " << d["bounds"]["high"] << " m\n"
              << "  BVH: " << d["bvh"]["nodes"] << " nodes, depth " << d["bvh"]["depth"] << ", surface-area cost "
              << d["bvh"]["surfaceAreaCost"] << ", built in " << d["bvh"]["buildSeconds"] << " s\n"
              << "  on the device: " << d["deviceBytes"] << " bytes\n  needs:";
    for (const auto& [name, needed] : d["needs"].items()) {
        std::cout << (needed.get<bool>() ? " " + name + "," : "");
    }
    std::cout << " triangles\n";
    for (std::size_t i = 0; i < d["cameras"].size(); ++i) {
        std::cout << "  camera " << i << ' ' << d["cameras"][i]["name"] << ", " << d["cameras"][i]["kind"].get<std::string>()
                  << '\n';
    }
}

void runInspect(const InspectOptions& options)
{
    const PreparedScene prepared = prepareScene(options.scene, {options.sceneIndex, {}});
    warnOfDarkness(prepared);
    const Json description = describe(options, prepared);
    if (options.json) {
        std::cout << description.dump(2) << '\n';
    } else {
        printText(description);
    }
}

}  // namespace

void addInspect(CLI::App& app)
{
    auto options = std::make_shared<InspectOptions>();
    CLI::App* command = app.add_subcommand("inspect", "Tell what is in a scene, what it costs and what it needs");
    command->add_option("SCENE", options->scene, "The scene, .gltf or .glb")->required()->type_name("FILE");
    addSceneIndex(*command, options->sceneIndex);
    command->add_flag("--json", options->json, "Print JSON");
    command->callback([options] { runInspect(*options); });
}

}  // namespace glim
