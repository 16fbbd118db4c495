#include "host/scene/load_gltf.hpp"

#include "host/scene/check_scene.hpp"
#include "host/scene/frame_camera.hpp"
#include "host/scene/gltf/check_gltf_json.hpp"
#include "host/scene/gltf/read_geometry.hpp"
#include "host/scene/gltf/read_lights_cameras.hpp"
#include "host/scene/gltf/read_material.hpp"

#include <algorithm>

namespace glim {
namespace {

void noteIgnoredParts(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene)
{
    for (const std::string& extension : file.model.extensionsUsed) {
        const bool ofMaterials = extension.find("_materials_") != std::string::npos;  // noted with each material
        if (!isSupportedExtension(extension) && !ofMaterials) {
            scene.warnings.push_back("the extension " + extension + " is ignored");
        }
    }
    const bool skinned =
        std::any_of(nodes.begin(), nodes.end(), [&](const PlacedNode& node) { return file.model.nodes[node.index].skin >= 0; });
    if (skinned) {
        scene.warnings.push_back("skins are ignored: their meshes stand in the rest pose of their nodes");
    }
    if (file.animated) {
        scene.warnings.push_back("animations are ignored");
    }
}

// Refuses the file's environment map instead of ignoring it, since the picture would be wrong without it.
void placeEnvironment(const GltfFile& file, const LoadOptions& options, Scene& scene)
{
    scene.environment = options.environment;
    if (options.environment || file.model.scenes.empty()) {
        return;
    }
    const auto first = static_cast<std::size_t>(std::max(file.model.defaultScene, 0));
    const std::size_t index = options.scene.value_or(first);
    const tinygltf::Value& extras = file.model.scenes[index].extras;
    if (!extras.IsObject() || !extras.Has("environment")) {
        return;
    }
    const tinygltf::Value& environment = extras.Get("environment");
    const std::string place = label("scenes", index, file.model.scenes[index].name) + ".extras.environment";
    if (environment.IsObject() && environment.Has("file")) {
        refuse(file, place +
                         " names a map, which this version cannot read; expected none (--environment r,g,b gives a"
                         " constant one)");
    }
    scene.warnings.push_back(place + " has no \"file\" and is ignored");
}

// Keeps the default material (the last one) only if something uses it, and notes what glim ignores of each used material.
void noteUsedMaterials(const std::vector<MaterialReading>& readings, Scene& scene)
{
    std::vector<bool> used(readings.size(), false);
    for (const Mesh& mesh : scene.meshes) {
        used[mesh.material] = true;
    }
    for (const Sphere& sphere : scene.spheres) {
        used[sphere.material] = true;
    }
    for (std::size_t i = 0; i < readings.size(); ++i) {
        if (used[i] && !readings[i].warning.empty()) {
            scene.warnings.push_back(readings[i].warning);
        }
    }
    if (!used.back()) {
        scene.materials.pop_back();
    }
}

}  // namespace

Scene loadGltf(const std::filesystem::path& path, const LoadOptions& options)
{
    const GltfFile file = readGltfFile(path);
    Scene scene;
    scene.file = file.path;
    scene.files = file.files;
    scene.images = file.images;

    std::vector<MaterialReading> readings;
    for (int i = 0; i < static_cast<int>(file.model.materials.size()); ++i) {
        readings.push_back(readMaterial(file, i));
    }
    readings.push_back(readMaterial(file, -1));
    for (const MaterialReading& reading : readings) {
        scene.materials.push_back(reading.material);
    }

    const std::vector<PlacedNode> nodes = placeNodes(file, options, scene.warnings);
    placeEnvironment(file, options, scene);
    noteIgnoredParts(file, nodes, scene);
    readGeometry(file, nodes, scene);
    noteUsedMaterials(readings, scene);
    readLightsAndCameras(file, nodes, scene);
    if (scene.cameras.empty()) {
        scene.cameras.push_back(frameCamera(scene, options.aspectRatio));
        scene.warnings.push_back("the scene has no camera: one is framed on its bounding box");
    }
    checkScene(scene);
    return scene;
}

}  // namespace glim
