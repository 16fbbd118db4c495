// glTF 2.0 (.gltf, .glb) to Scene: the only place that knows tinygltf.
#pragma once

#include "host/scene/edit.hpp"
#include "host/scene/light_groups.hpp"
#include "host/scene/scene.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace glim {

class Warnings;

enum class MissingTextures { Refuse, Grey };

// No environment at all, the built-in studio, a constant radiance or a map.
enum class BuiltInEnvironment { None, Studio };
using EnvironmentChoice = std::variant<BuiltInEnvironment, glm::vec3, std::filesystem::path>;

// A directional light from `azimuth` to the right of -z and `elevation` above the horizon, in degrees.
struct Sun {
    double azimuth, elevation;
    float irradiance;  // W/m^2 on a surface that faces it

    bool operator==(const Sun&) const = default;
};

// A file whose shapes and lights stand in the scene too.
struct Addition {
    std::filesystem::path file;
    glm::dmat4 worldFromFile{1.0};  // affine and invertible

    bool operator==(const Addition&) const = default;
};

// A floor under everything, which the scene's file does not have (make_floor.hpp).
struct SceneFloor {
    std::optional<double> height;    // metres; if absent the lowest point of the rest pose
    glm::vec3 color{0.8F};           // linear Rec.709
    std::optional<float> roughness;  // of a dielectric; if absent the floor is matte
    std::optional<double> backdrop;  // degrees to the right of -z: there the floor becomes a wall

    bool operator==(const SceneFloor&) const = default;
};

struct LoadOptions {
    std::optional<std::size_t> scene;              // index into the file's scenes; if absent its default scene, else the first
    std::optional<EnvironmentChoice> environment;  // replaces the file's
    float environmentRotation = 0.0F;              // of a map about +y, degrees, added to the file's
    float environmentStrength = 1.0F;              // multiplies the radiance of any environment
    bool environmentBackground = true;             // the camera sees the environment
    std::optional<Sun> sun;
    bool showsBackFaces = false;
    std::optional<double> pointRadius, lineRadius;  // of all points and lines, metres
    MissingTextures missingTextures = MissingTextures::Refuse;
    bool confined = false;                     // refuses files that the scene names outside of its folder
    std::uint32_t maxTexture = kMaxImageSide;  // images with a longer side are scaled down
    std::string variant;                       // of KHR_materials_variants; empty: the file's own materials
    std::optional<double> at;                  // seconds into the animation; if absent the file's rest pose
    std::optional<Shutter> shutter;            // open while things move; only with `at`
    std::string animation;                     // name or index; empty: the first
    float aspectRatio = 1.0F;                  // of the picture, for the framed camera
    float yfov = Camera().yfov;                // of the framed camera
    bool framed = false;                       // adds it to the file's cameras; it is always there if the file has none

    std::optional<SceneFloor> floor;
    LightGroupChoice lightGroups;       // of which a film keeps the light apart
    std::vector<std::string> catchers;  // names of materials that are shadow catchers, besides those that files mark

    std::vector<Edit> edits;          // of the file, one after the other
    std::vector<Addition> additions;  // in their rest pose

    bool operator==(const LoadOptions&) const = default;
};

// A file that gives its scene at one time after another, and is read once, with its buffers, images and maps.
class SceneFile {
public:
    // Reads nothing yet.
    explicit SceneFile(const std::filesystem::path& file, const LoadOptions& options = {});
    ~SceneFile();
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;

    // The scene at `seconds` into the animation; if absent in the file's rest pose. It has passed checkScene. A framed camera sees the
    // file's whole rest pose, at any time, and what is added as it comes. Throws InputError with one sentence that names file, place, value
    // and what was expected. `blurred`: with motions while the options' shutter is open.
    Scene sceneAt(std::optional<double> seconds, bool blurred = true);
    // Frees what was read; the next scene reads it again.
    void release();
    // Other options in place of those before. What was read stays unless they say that it is read otherwise: buffers, images and maps, and
    // meshes that no edit bends. An edit's pointer begins with the name of an added file and a # where it is one of that file. Throws
    // InputError, and then nothing is changed.
    void choose(const LoadOptions& options);
    const std::filesystem::path& path() const { return path_; }
    const LoadOptions& options() const { return options_; }

    // Where edits find a node or a material of the last scene, as in /materials/3 or floor.glb#/materials/0; nothing for what no file has,
    // as the default material.
    std::optional<std::string> pointerToNode(std::uint32_t node) const;
    std::optional<std::string> pointerToMaterial(std::uint32_t material) const;
    // The nodes that hide all but this one of what is drawn in `scene`, the last one, where edits find them. Lights stay.
    std::vector<std::string> pointersToOthers(const Scene& scene, std::uint32_t node) const;
    // Of that node, relative to its parent, as the file and the edits have it.
    glm::dvec3 translationOf(std::uint32_t node) const;

private:
    struct Contents;

    // Without the light that chooseLight gives it.
    Scene read(std::optional<double> seconds, bool blurred, Warnings& warnings);
    // The floor, under the rest pose.
    Scene addFloor(Scene scene, bool isPosed);
    void markCatchers(Scene& scene) const;
    void addLightGroups(Scene& scene);
    // The built-in studio, where nothing else would show what is in the scene.
    void chooseLight(Scene& scene, bool isPosed, Warnings& warnings);
    std::string prefixOf(std::size_t part) const;

    std::filesystem::path path_;
    LoadOptions options_;
    std::unique_ptr<Contents> contents_;  // null before the first scene
};

// The index of the one that a name or an index means, or of the first if `choice` is empty; nothing if there is none.
std::optional<std::size_t> findAnimation(const std::vector<Animation>& animations, const std::string& choice);

// The scene at options.at.
Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace glim
