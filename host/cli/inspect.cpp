#include "host/cli/commands.hpp"
#include "host/flatten/large_triangles.hpp"
#include "host/job/parse.hpp"
#include "host/job/picture_options.hpp"
#include "host/job/resolve_options.hpp"
#include "host/json.hpp"
#include "host/message.hpp"
#include "host/render/prepare_scene.hpp"
#include "host/scene/gltf/extensions.hpp"
#include "host/scene/share_meshes.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>

namespace glim {
namespace {

struct InspectOptions {
    std::filesystem::path scene;
    LoadOptions load;
    bool json = false;
};

using Counts = std::vector<std::pair<const char*, std::size_t>>;
using Needs = std::vector<std::pair<const char*, bool>>;

struct CloudCounts {
    std::size_t points = 0, lines = 0;
};

CloudCounts countClouds(const Scene& scene)
{
    CloudCounts counts;
    for (const MeshInstance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        counts.points += mesh.isCloud && mesh.lines.empty() ? mesh.positions.size() : 0;
        counts.lines += mesh.lines.size();
    }
    return counts;
}

Counts countsOf(const PreparedScene& prepared)
{
    const CloudCounts clouds = countClouds(prepared.scene);
    return {{"triangles", prepared.primitives.computeTriangleCount()},
            {"points", clouds.points},
            {"lines", clouds.lines},
            {"spheres", prepared.scene.spheres.size()},
            {"meshes", prepared.scene.meshes.size()},
            {"instances", prepared.scene.instances.size()},
            {"materials", prepared.scene.materials.size()},
            {"images", prepared.scene.images.size()},
            {"lights", prepared.flat.lights.size()},
            {"cameras", prepared.scene.cameras.size()},
            {"skins", prepared.scene.skins},
            {"morph targets", prepared.scene.morphTargets}};
}

Needs needsOf(FeatureMask features)
{
    Needs needs;
    for (const Feature& feature : kFeatures) {
        needs.emplace_back(feature.name, (features & feature.bit) != 0);
    }
    return needs;
}

// Instances of meshes that have several, whether these share their meshes, and why.
struct Instancing {
    std::size_t meshes = 0, instances = 0;
    std::uint64_t triangles = 0;  // that the meshes have
    bool shared = false;
    std::string reason;
};

Instancing instancingOf(const PreparedScene& prepared)
{
    Instancing instancing;
    instancing.shared = !prepared.primitives.placements.empty();
    if (instancing.shared) {
        instancing.meshes = prepared.primitives.sharedMeshes.size();
        instancing.instances = prepared.primitives.placements.size();
        for (const SharedMesh& mesh : prepared.primitives.sharedMeshes) {
            instancing.triangles += mesh.triangles.size();
        }
        instancing.reason = "the scene has more than " + std::to_string(kMaxFlatTriangles) + " triangles, counted once for each instance";
        return instancing;
    }
    for (const MeshUse& use : countMeshUses(prepared.scene)) {
        instancing.meshes += use.instances > 1 ? 1 : 0;
        instancing.instances += use.instances > 1 ? use.instances : 0;
        instancing.triangles += use.instances > 1 ? use.triangles : 0;
    }
    instancing.reason = "rays are faster so, and the scene has at most " + std::to_string(kMaxFlatTriangles) +
                        " triangles, or all meshes that could be shared emit";
    return instancing;
}

struct Bounds {
    glm::dvec3 low, high;  // world coordinates, metres
};

Bounds computeBounds(const PreparedScene& prepared)
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

// How many materials have each type, of those that some material has.
Counts countMaterialTypes(const FlatScene& flat)
{
    constexpr const char* kMaterialTypes[] = {"diffuse", "mirror", "glass", "glTF", "unlit"};
    constexpr FeatureMask kLayers = kLayerFeatures | kFeatureThinWalls;
    Counts counts;
    const auto add = [&counts](const char* name, std::ptrdiff_t count) {
        if (count > 0) {
            counts.emplace_back(name, static_cast<std::size_t>(count));
        }
    };
    for (std::uint32_t type = 0; type < std::size(kMaterialTypes); ++type) {
        add(kMaterialTypes[type], std::ranges::count(flat.materials, type, &MaterialData::type));
    }
    for (const Feature& feature : kFeatures) {
        const auto has = [&feature](FeatureMask features) { return (features & feature.bit & kLayers) != 0; };
        add(feature.name, std::ranges::count_if(flat.materialFeatures, has));
    }
    return counts;
}

// Of the scene as its first camera sees it.
FeatureMask getFeatures(const PreparedScene& prepared)
{
    return featuresSeenBy(prepared.flat, flattenCamera(prepared, prepared.scene.cameras.front(), 1.0F, {}));
}

std::size_t singleSided(const Scene& scene)
{
    return static_cast<std::size_t>(std::ranges::count_if(scene.materials, std::not_fn(meetsBackFaces)));
}

Json describeTextures(const PreparedScene& prepared)
{
    Json textures = Json::array();
    for (std::size_t i = 0; i < prepared.scene.images.size(); ++i) {
        const TextureImage& image = prepared.scene.images[i];
        textures.append({{"name", image.name}, {"width", image.width}, {"height", image.height}, {"bytes", prepared.flat.imageBytes[i]}});
    }
    return textures;
}

std::uint64_t environmentBytes(const PreparedScene& prepared) { return textureBytes(prepared.flat) - imageBytes(prepared.flat); }

Json environmentOf(const PreparedScene& prepared)
{
    if (!prepared.scene.environment) {
        return nullptr;
    }
    const Environment& environment = *prepared.scene.environment;
    Json json = {{"source", environment.source},
                 {"radiance", Json::array({environment.radiance.r, environment.radiance.g, environment.radiance.b})},
                 {"map", nullptr}};
    if (environment.map) {
        json.set("map", {{"width", environment.map->width}, {"height", environment.map->height}, {"bytes", environmentBytes(prepared)}});
    }
    return json;
}

float anisotropyOf(const FlatScene& flat, std::uint32_t medium)
{
    return flat.scattering.empty() ? 0.0F : flat.scattering[medium - 1].anisotropy;
}

Json mediaOf(const PreparedScene& prepared)
{
    Json media = Json::array();
    for (std::uint32_t i = 1; i <= prepared.flat.media.size(); ++i) {
        const MediumData& medium = prepared.flat.media[i - 1];
        const vec3 absorption = absorptionOf(prepared.flat, i), scattering = scatteringOf(prepared.flat, i);
        media.append({{"ior", medium.ior},
                      {"absorption", Json::array({absorption.r, absorption.g, absorption.b})},
                      {"scattering", Json::array({scattering.r, scattering.g, scattering.b})},
                      {"anisotropy", anisotropyOf(prepared.flat, i)},
                      {"spread", medium.spread}});
    }
    return media;
}

// What becomes of each extension that the file uses.
std::vector<std::pair<std::string, const char*>> describeExtensions(const Scene& scene, const char* drawn, const char* ignored,
                                                                    const char* missing)
{
    std::vector<std::pair<std::string, const char*>> described;
    for (const std::string& name : scene.extensions) {
        described.emplace_back(name, isMissing(name) ? missing : getEffect(name) == ExtensionEffect::Drawn ? drawn : ignored);
    }
    return described;
}

void printJson(const InspectOptions& options, const PreparedScene& prepared)
{
    Json cameras = Json::array();
    for (const Camera& camera : prepared.scene.cameras) {
        cameras.append({{"name", camera.name}, {"kind", kindOf(camera)}});
    }
    Json animations = Json::array();
    for (const Animation& animation : prepared.scene.animations) {
        animations.append({{"name", animation.name}, {"seconds", animation.duration}});
    }
    Json warnings = Json::array(), warningIds = Json::array();
    for (const Message& warning : prepared.scene.warnings) {
        warnings.append(warning.sentence);
        warningIds.append(toText(warning.id));
    }
    const Bounds bounds = computeBounds(prepared);
    const Instancing instancing = instancingOf(prepared);
    const Json json = {{"scene", options.scene.string()},
                       {"counts", objectOf(countsOf(prepared))},
                       {"bounds", {{"low", pointOf(bounds.low)}, {"high", pointOf(bounds.high)}}},
                       {"bvh",
                        {{"nodes", prepared.bvh.nodes.size()},
                         {"records", prepared.bvh.order.size()},
                         {"depth", prepared.bvh.depth},
                         {"surfaceAreaCost", prepared.bvh.cost},
                         {"buildSeconds", prepared.buildSeconds}}},
                       {"instancing",
                        {{"shared", instancing.shared},
                         {"meshes", instancing.meshes},
                         {"instances", instancing.instances},
                         {"meshTriangles", instancing.triangles},
                         {"reason", instancing.reason}}},
                       {"loadSeconds", prepared.loadSeconds},
                       {"deviceBytes", sizeInBytes(prepared.flat)},
                       {"textureBytes", textureBytes(prepared.flat)},
                       {"lobes", objectOf(countMaterialTypes(prepared.flat))},
                       {"singleSided", singleSided(prepared.scene)},
                       {"textures", describeTextures(prepared)},
                       {"environment", environmentOf(prepared)},
                       {"media", mediaOf(prepared)},
                       {"extensions", objectOf(describeExtensions(prepared.scene, "drawn", "ignored", "missing"))},
                       {"variants", prepared.scene.variants},
                       {"animations", animations},
                       {"needs", objectOf(needsOf(getFeatures(prepared)))},
                       {"cameras", cameras},
                       {"warnings", warnings},
                       {"warningIds", warningIds}};
    std::cout << json.dump(2) << '\n';
}

// Three digits, as in 12.3 or 0.000456; above 999 a whole number.
std::string threeDigits(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, value < 999.5 ? "%.3g" : "%.0f", value);
    return text;
}

std::string shortPointText(const glm::dvec3& p)
{
    char text[64];
    std::snprintf(text, sizeof text, "(%.3g, %.3g, %.3g)", p.x, p.y, p.z);
    return text;
}

// To a millionth of `size`.
std::string coordinateText(double value, double size)
{
    const double digits = value == 0.0 ? 1.0 : std::ceil(std::log10(std::abs(value) / (1e-6 * size)));
    return format("%.*g", static_cast<int>(std::clamp(digits, 1.0, 17.0)), value + 0.0);
}

std::string boundsText(const Bounds& bounds)
{
    const glm::dvec3 sides = bounds.high - bounds.low;
    const double size = std::max({sides.x, sides.y, sides.z});
    const auto corner = [size](const glm::dvec3& p) {
        return "(" + coordinateText(p.x, size) + ", " + coordinateText(p.y, size) + ", " + coordinateText(p.z, size) + ")";
    };
    return corner(bounds.low) + " to " + corner(bounds.high) + " m";
}

std::string mebibytesText(std::uint64_t bytes) { return threeDigits(static_cast<double>(bytes) / (1 << 20)) + " MiB"; }

void printLooks(const PreparedScene& prepared)
{
    const char* separator = "  lobes: ";
    for (const auto& [name, count] : countMaterialTypes(prepared.flat)) {
        std::cout << separator << name << ' ' << count;
        separator = ", ";
    }
    std::cout << '\n';
    if (const std::size_t count = singleSided(prepared.scene); count > 0) {
        std::cout << "  single-sided: " << counted(count, "material") << ", whose back faces are not drawn (--back-faces)\n";
    }
    for (std::size_t i = 0; i < prepared.scene.images.size(); ++i) {
        const TextureImage& image = prepared.scene.images[i];
        const std::uint64_t bytes = prepared.flat.imageBytes[i];
        std::cout << "  texture " << escaped(shortened(image.name)) << ", " << image.width << 'x' << image.height << ", "
                  << (bytes > 0 ? mebibytesText(bytes) : "of one colour") << '\n';
    }
    if (prepared.scene.environment) {
        const Environment& environment = *prepared.scene.environment;
        std::cout << "  environment: " << escaped(environment.source);
        if (environment.map) {
            std::cout << ", " << environment.map->width << 'x' << environment.map->height << ", "
                      << mebibytesText(environmentBytes(prepared));
        }
        std::cout << '\n';
    }
    if ((prepared.flat.features & kFeatureCaustics) != 0) {
        std::cout << "  caustics: from " << prepared.flat.causticLights << " lights to " << prepared.flat.causticTargets
                  << " places with specular surfaces\n";
    }
    for (std::uint32_t i = 1; i <= prepared.flat.media.size(); ++i) {
        const MediumData& medium = prepared.flat.media[i - 1];
        std::cout << "  medium " << i << ": index " << threeDigits(static_cast<double>(medium.ior)) << ", absorption "
                  << shortPointText(glm::dvec3(absorptionOf(prepared.flat, i))) << " per metre";
        if (const vec3 scattering = scatteringOf(prepared.flat, i); scattering != vec3(0.0F)) {
            std::cout << ", scattering " << shortPointText(glm::dvec3(scattering)) << " per metre, anisotropy "
                      << threeDigits(static_cast<double>(anisotropyOf(prepared.flat, i)));
        }
        std::cout << (medium.spread > 0.0F ? ", dispersive" : "") << '\n';
    }
}

void printText(const InspectOptions& options, const PreparedScene& prepared)
{
    std::cout << escaped(options.scene.string()) << '\n';
    for (const auto& [name, count] : countsOf(prepared)) {
        std::cout << "  " << name << ' ' << count << '\n';
    }
    if (const Instancing instancing = instancingOf(prepared); instancing.instances > 0) {
        std::cout << "  " << instancing.instances << " instances of " << instancing.meshes << (instancing.meshes == 1 ? " mesh" : " meshes")
                  << " (" << counted(instancing.triangles, "triangle") << ") " << (instancing.shared ? "share these" : "are flattened")
                  << ": " << instancing.reason << '\n';
    }
    std::cout << "  bounds " << boundsText(computeBounds(prepared)) << '\n'
              << "  BVH: " << prepared.bvh.nodes.size() << " nodes, depth " << prepared.bvh.depth << ", surface-area cost "
              << threeDigits(static_cast<double>(prepared.bvh.cost)) << ", built in " << threeDigits(prepared.buildSeconds) << " s\n"
              << "  on the device: " << mebibytesText(sizeInBytes(prepared.flat)) << ", " << mebibytesText(textureBytes(prepared.flat))
              << " of it textures\n  needs:";
    const char* separator = " ";
    for (const auto& [name, needed] : needsOf(getFeatures(prepared))) {
        if (needed) {
            std::cout << separator << name;
            separator = ", ";
        }
    }
    std::cout << (*separator == ' ' ? " nothing but flat diffuse triangles\n" : "\n");
    printLooks(prepared);
    for (const auto& [name, effect] : describeExtensions(prepared.scene, "drawn", "ignored, as it changes no still picture",
                                                         "missing: the picture lacks what it asks for")) {
        std::cout << "  extension " << escaped(shortened(name)) << ": " << effect << '\n';
    }
    for (const std::string& variant : prepared.scene.variants) {
        std::cout << "  variant " << escaped(inQuotes(variant)) << '\n';
    }
    for (std::size_t i = 0; i < prepared.scene.animations.size(); ++i) {
        const Animation& animation = prepared.scene.animations[i];
        std::cout << "  animation " << i << ' ' << escaped(inQuotes(animation.name)) << ", " << threeDigits(animation.duration) << " s\n";
    }
    for (std::size_t i = 0; i < prepared.scene.cameras.size(); ++i) {
        const Camera& camera = prepared.scene.cameras[i];
        std::cout << "  camera " << i << ' ' << escaped(inQuotes(camera.name)) << ", " << kindOf(camera) << '\n';
    }
}

void runInspect(const InspectOptions& options)
{
    const PreparedScene prepared = prepareScene(options.scene, options.load);
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
    Command& command = line.addCommand("inspect", "Print what a scene contains, costs and needs");
    command.beginGroup("Picture");
    command.addPath("SCENE", "FILE", "Scene, .gltf or .glb", options->scene).require();
    addSceneIndex(command, options->load.scene);
    addAnimation(command, options->load.at, options->load.animation);
    addTextures(command, options->load.missingTextures, options->load.maxTexture);
    command.beginGroup("Output");
    command.addFlag("--json", "Print JSON with every digit; sizes in bytes", options->json);
    command.onFinished([&command, options] { resolveAnimation(command, options->load.at.has_value()); });
    command.onRun([options] {
        runInspect(*options);
        return ExitCode::Done;
    });
}

}  // namespace glim
