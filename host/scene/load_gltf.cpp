#include "host/scene/load_gltf.hpp"

#include "host/error.hpp"
#include "host/message.hpp"
#include "host/scene/check_scene.hpp"
#include "host/scene/frame_camera.hpp"
#include "host/scene/gltf/animate_gltf.hpp"
#include "host/scene/gltf/check_gltf_json.hpp"
#include "host/scene/gltf/pose_mesh.hpp"
#include "host/scene/gltf/read_geometry.hpp"
#include "host/scene/gltf/read_image_light.hpp"
#include "host/scene/gltf/read_images.hpp"
#include "host/scene/gltf/read_lights_cameras.hpp"
#include "host/scene/gltf/read_material.hpp"
#include "host/scene/make_studio.hpp"
#include "host/scene/make_tangents.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glim {
namespace {

constexpr double kMaxFloat = std::numeric_limits<float>::max();

void noteIgnoredParts(const GltfFile& file, Warnings& warnings)
{
    for (const std::string& extension : file.model.extensionsUsed) {
        const ExtensionEffect effect = effectOf(extension);
        const bool ofMaterials = extension.find("_materials_") != std::string::npos;  // noted with each material
        if ((effect == ExtensionEffect::Looks && !ofMaterials) || effect == ExtensionEffect::Content) {
            warnings.add("extensions are ignored", shortened(extension));
        }
    }
}

std::vector<Animation> listAnimations(const GltfFile& file)
{
    std::vector<Animation> animations;
    for (std::size_t i = 0; i < file.animations.size(); ++i) {
        animations.push_back({file.animations[i].name, durationOf(file, i)});
    }
    return animations;
}

std::size_t countAllMorphTargets(const GltfFile& file)
{
    std::size_t count = 0;
    for (const tinygltf::Mesh& mesh : file.model.meshes) {
        count += countMorphTargets(mesh);
    }
    return count;
}

std::string describeAnimation(const std::vector<Animation>& animations, std::size_t index)
{
    const std::string& name = animations[index].name;
    return std::to_string(index) + " (" + (name.empty() ? "" : inQuotes(name) + ", ") + toText(animations[index].duration) + " s)";
}

std::size_t findAnimation(const GltfFile& file, const std::vector<Animation>& animations, const std::string& choice)
{
    std::string known;
    for (std::size_t i = 0; i < animations.size(); ++i) {
        if (choice.empty() || animations[i].name == choice || std::to_string(i) == choice) {
            return i;
        }
        if (i < kMostListed) {
            known += (known.empty() ? "" : ", ") + describeAnimation(animations, i);
        }
    }
    refuse(file,
           "it has no animation" + (choice.empty() ? "" : ' ' + inQuotes(choice)) + "; expected " +
               (known.empty() ? "no --at and no --frames, since it has none" : "one of " + known + moreThanListed(animations.size())));
}

// The rest pose is what the file's nodes, weights and materials say, without any animation.
void chooseTime(GltfFile& file, const LoadOptions& options, std::optional<double> seconds, const std::vector<Animation>& animations,
                Warnings& warnings)
{
    if (seconds) {
        animateGltf(file, findAnimation(file, animations, options.animation), *seconds, warnings);
    } else if (!animations.empty()) {
        warnings.add("the scene is drawn in its rest pose: --at SECONDS poses it by animation " + describeAnimation(animations, 0) +
                     (animations.size() == 1 ? "" : ", --animation by another of " + std::to_string(animations.size())));
    }
}

Environment readMap(const std::filesystem::path& path, const LoadOptions& options, DecodedParts& decoded, Scene& scene, Warnings& warnings)
{
    Environment environment;
    environment.map = decoded.findMap(path.string(), [&path] { return readRadianceMap(path); });
    environment.rotation = options.environmentRotation;
    environment.source = path.string();
    scene.files.push_back(path);
    if (environment.map->repaired > 0) {
        warnings.add(path.string() + " holds " + counted(environment.map->repaired, "texel") +
                     " that are negative or not finite; they count as 0");
    }
    return environment;
}

// scenes[i].extras.environment: {"file", "strength"}.
std::optional<Environment> readNamedMap(const GltfFile& file, const LoadOptions& options, std::size_t index, DecodedParts& decoded,
                                        Scene& scene, Warnings& warnings)
{
    const tinygltf::Value& extras = file.model.scenes[index].extras;
    if (!extras.IsObject() || !extras.Has("environment")) {
        return std::nullopt;
    }
    const tinygltf::Value& source = extras.Get("environment");
    const std::string place = label("scenes", index, file.model.scenes[index].name) + ".extras.environment";
    if (!source.IsObject() || !source.Has("file") || !source.Get("file").IsString()) {
        warnings.add(place + " has no \"file\" and is ignored");
        return std::nullopt;
    }
    const std::string name = source.Get("file").Get<std::string>();
    if (options.confined) {
        refuseOutside(file.path, place, name);
    }
    Environment environment;
    try {
        environment = readMap(externalFile(file.path, name), options, decoded, scene, warnings);
    } catch (const InputError& error) {
        refuse(file, place + " names the map " + inQuotes(name) + ", which cannot be read (" + error.what() + ")");
    }
    if (source.Has("strength")) {
        const tinygltf::Value& strength = source.Get("strength");
        const double factor = strength.IsNumber() ? strength.GetNumberAsDouble() : -1.0;
        if (!(factor >= 0.0 && factor <= kMaxFloat)) {
            refuse(file, place + ".strength is " + (strength.IsNumber() ? toText(factor) : "not a number") +
                             "; expected a number from 0 that fits a float");
        }
        environment.radiance = glm::vec3(static_cast<float>(factor));
    }
    return environment;
}

std::optional<Environment> readFileEnvironment(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene,
                                               Warnings& warnings)
{
    if (file.model.scenes.empty()) {
        return std::nullopt;
    }
    const auto first = static_cast<std::size_t>(std::max(file.model.defaultScene, 0));
    const std::size_t index = options.scene.value_or(first);
    std::optional<Environment> environment = readNamedMap(file, options, index, decoded, scene, warnings);
    if (!environment) {
        environment = readImageLight(file, index, decoded, scene, warnings);
        if (environment) {
            environment->rotation = options.environmentRotation;
        }
    }
    return environment;
}

std::vector<bool> findUsedMaterials(const Scene& scene)
{
    std::vector<bool> used(scene.materials.size(), false);
    for (const Mesh& mesh : scene.meshes) {
        used[mesh.material] = true;
    }
    for (const Sphere& sphere : scene.spheres) {
        used[sphere.material] = true;
    }
    return used;
}

Environment makeStudioEnvironment(const LoadOptions& options, DecodedParts& decoded)
{
    Environment environment;
    environment.source = "studio";
    environment.map = decoded.findMap(environment.source, makeStudio);
    environment.rotation = options.environmentRotation;
    environment.background = options.environmentBackground;
    return environment;
}

// Emission by a texture, as of the lamps of a model, is not there to light a scene.
bool hasLight(const Scene& scene)
{
    const std::vector<bool> used = findUsedMaterials(scene);
    bool lamp = false;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        lamp = lamp || (used[i] && !scene.materials[i].emissiveTexture && scene.materials[i].emission != glm::vec3(0.0F));
    }
    return lamp || !scene.lights.empty() || scene.environment;
}

std::optional<Environment> chooseEnvironment(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene,
                                             Warnings& warnings)
{
    std::optional<Environment> environment;
    if (!options.environment) {
        environment = readFileEnvironment(file, options, decoded, scene, warnings);
    } else if (const auto* radiance = std::get_if<glm::vec3>(&*options.environment)) {
        environment.emplace().radiance = *radiance;
        environment->source = "constant";
    } else if (const auto* path = std::get_if<std::filesystem::path>(&*options.environment)) {
        environment = readMap(*path, options, decoded, scene, warnings);
    }
    if (options.environment == EnvironmentChoice(BuiltInEnvironment::Studio)) {
        environment = makeStudioEnvironment(options, decoded);
    }
    if (environment) {
        environment->background = options.environmentBackground;
    }
    return environment;
}

PunctualLight lightOf(const Sun& sun)
{
    const double azimuth = glm::radians(sun.azimuth), elevation = glm::radians(sun.elevation);
    PunctualLight light;
    light.name = "sun";
    light.kind = PunctualLight::Kind::Directional;
    light.direction =
        -glm::vec3(glm::dvec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)));
    light.intensity = glm::vec3(sun.irradiance);
    return light;
}

std::vector<std::string> readVariants(const GltfFile& file)
{
    std::vector<std::string> names;
    const auto extension = file.model.extensions.find("KHR_materials_variants");
    const tinygltf::Value variants = extension == file.model.extensions.end() ? tinygltf::Value() : extension->second.Get("variants");
    for (std::size_t i = 0; variants.IsArray() && i < variants.ArrayLen(); ++i) {
        names.push_back(variants.Get(static_cast<int>(i)).Get("name").Get<std::string>());
    }
    return names;
}

std::optional<std::size_t> findVariant(const GltfFile& file, const std::vector<std::string>& variants, const std::string& name)
{
    const auto found = std::find(variants.begin(), variants.end(), name);
    if (name.empty() || found != variants.end()) {
        return name.empty() ? std::nullopt : std::optional<std::size_t>(found - variants.begin());
    }
    std::string known;
    for (std::size_t i = 0; i < std::min(variants.size(), kMostListed); ++i) {
        known += (known.empty() ? "" : ", ") + inQuotes(variants[i]);
    }
    refuse(file, "it has no variant " + inQuotes(name) + "; expected " +
                     (known.empty() ? "no --variant, since it has none" : "one of " + known + moreThanListed(variants.size())));
}

// The file's materials, then the default one. Those of unused ones say nothing.
void readMaterials(const GltfFile& file, const LoadOptions& options, DecodedParts& decoded, Scene& scene, Warnings& warnings)
{
    const std::vector<bool> used = findUsedMaterials(scene);
    Warnings unheard;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const int index = i + 1 < scene.materials.size() ? static_cast<int>(i) : -1;
        scene.materials[i] = readMaterial(file, index, used[i] ? warnings : unheard);
    }
    readImages(file, options, used, decoded, scene, warnings);
    if (used.back()) {
        scene.defaultMaterial = static_cast<std::uint32_t>(scene.materials.size() - 1);
    } else {
        scene.materials.pop_back();
    }
}

// The texture coordinates that the material's tangents follow, if it needs any.
std::optional<std::uint32_t> uvSetOfTangents(const Material& material)
{
    for (const auto* texture : {&material.normalTexture, &material.clearcoatNormalTexture, &material.anisotropyTexture}) {
        if (*texture) {
            return (*texture)->uvSet;
        }
    }
    return material.anisotropy > 0.0F ? std::optional<std::uint32_t>(0) : std::nullopt;
}

// Gives tangents to every mesh that is drawn with a normal map and has none, by the texture coordinates of that map. Flat meshes have those
// of their faces, whatever the file says.
void giveTangents(Scene& scene, Warnings& warnings)
{
    for (Mesh& mesh : scene.meshes) {
        const std::optional<std::uint32_t> uvSet = uvSetOfTangents(scene.materials[mesh.material]);
        if (!uvSet || (!mesh.tangents.empty() && !mesh.normals.empty())) {
            continue;
        }
        mesh.tangents.clear();
        if ((*uvSet == 0 ? mesh.uv0 : mesh.uv1).empty()) {
            warnings.add("normal maps and anisotropy without texture coordinates are ignored", mesh.name);
        } else if (addTangents(mesh, *uvSet == 1) > 0) {
            warnings.add("texture coordinates of normal maps have no area in some triangles", mesh.name);
        }
    }
}

template <class Entries>
std::vector<std::string> namesOf(const Entries& entries)
{
    std::vector<std::string> names;
    for (const auto& entry : entries) {
        names.push_back(entry.name);
    }
    return names;
}

// What a framed camera was framed on.
struct Framed {
    Camera camera;
    glm::dvec3 origin;  // of the scene
};

Camera placeFramed(const Framed& framed, const glm::dvec3& origin)
{
    Camera camera = framed.camera;
    camera.position = glm::dvec3(camera.position) + framed.origin - origin;
    return camera;
}

}  // namespace

struct SceneFile::Contents {
    GltfFile file;
    LoadOptions options;
    std::vector<Animation> animations;
    DecodedParts decoded;
    std::optional<Framed> framed;  // on the rest pose
    bool posed = false;            // the file's model is not in its rest pose

    Framed frameRestPose();
    Camera frame(const Scene& scene);
};

Framed SceneFile::Contents::frameRestPose()
{
    restoreRestPose(file);
    posed = false;
    Scene rest;
    rest.materials.resize(file.model.materials.size() + 1);
    Warnings unheard;
    readGeometry(file, placeNodes(file, options, unheard), rest, unheard);
    return {frameCamera(rest, options.aspectRatio), rest.origin};
}

Camera SceneFile::Contents::frame(const Scene& scene)
{
    if (!posed) {
        return frameCamera(scene, options.aspectRatio);
    }
    framed = framed ? framed : frameRestPose();
    return placeFramed(*framed, scene.origin);
}

SceneFile::SceneFile(const std::filesystem::path& file, const LoadOptions& options)
    : path_(file),
      options_(options)
{}

SceneFile::~SceneFile() = default;

Scene SceneFile::sceneAt(std::optional<double> seconds)
{
    if (!contents_) {
        contents_ = std::make_unique<Contents>(Contents{readGltfFile(path_, options_.confined, options_.edits), options_, {}, {}, {}});
        contents_->animations = listAnimations(contents_->file);
    }
    auto& [file, options, animations, decoded, framed, posed] = *contents_;
    Scene scene;
    scene.variants = readVariants(file);
    file.variant = findVariant(file, scene.variants, options.variant);
    scene.file = file.path;
    scene.files = file.files;
    scene.nodeNames = namesOf(file.model.nodes);
    scene.meshNames = namesOf(file.model.meshes);
    scene.animations = animations;
    scene.skins = file.skins.size();
    scene.morphTargets = countAllMorphTargets(file);
    scene.showsBackFaces = options.showsBackFaces;
    scene.materials.resize(file.model.materials.size() + 1);
    Warnings warnings = file.warnings;
    if (posed) {
        restoreRestPose(file);
    }
    chooseTime(file, options, seconds, animations, warnings);
    posed = seconds.has_value();
    const std::vector<PlacedNode> nodes = placeNodes(file, options, warnings);
    scene.environment = chooseEnvironment(file, options, decoded, scene, warnings);
    noteIgnoredParts(file, warnings);
    readGeometry(file, nodes, scene, warnings);
    readMaterials(file, options, decoded, scene, warnings);
    giveTangents(scene, warnings);
    readLightsAndCameras(file, nodes, scene, warnings);
    if (options.sun) {
        scene.lights.push_back(lightOf(*options.sun));
    }
    if (!options.environment && !hasLight(scene)) {
        scene.environment = makeStudioEnvironment(options, decoded);
        warnings.add("the scene has no light: the built-in studio lights it (--environment none keeps it dark)");
    }
    if (scene.cameras.empty()) {
        warnings.add("the scene has no camera: one is framed on its bounding box");
    }
    if (scene.cameras.empty() || options.framed) {
        scene.cameras.push_back(contents_->frame(scene));
    }
    scene.warnings = warnings.lines();
    checkScene(scene);
    return scene;
}

void SceneFile::edit(const std::vector<Edit>& edits)
{
    if (contents_) {
        contents_->file = readGltfFile(path_, options_.confined, edits);
        contents_->options.edits = edits;
        contents_->framed.reset();
        contents_->posed = false;
    }
    options_.edits = edits;
}

Scene loadGltf(const std::filesystem::path& path, const LoadOptions& options) { return SceneFile(path, options).sceneAt(options.at); }

}  // namespace glim
