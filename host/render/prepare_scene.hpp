// Prepares a scene file for the renderer, and times the steps.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/wide_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/primitives.hpp"
#include "host/scene/load_gltf.hpp"

#include <filesystem>
#include <functional>
#include <optional>

namespace glim {

struct PreparedScene {
    Scene scene;
    Primitives primitives;
    WideBvh bvh;
    SplitRule split = SplitRule::Sah;  // the rule that the tree was built by
    FlatScene flat;
    double loadSeconds = 0.0, buildSeconds = 0.0;  // load: file and primitives; build: BVH and flattening
};

// Throws InputError. Prints the scene's warnings to stderr. Calls `stage` with what it begins to do, as in "loading a.gltf".
PreparedScene prepareScene(
    const std::filesystem::path& file, const LoadOptions& options, SplitRule split = SplitRule::Sah,
    const std::function<void(const std::string&)>& stage = [](const std::string&) {});

// Says on stderr whether a number was an index or a name.
void sayIfCameraIsNumber(const Scene& scene, const std::optional<std::string>& choice);

// Warns on stderr if the scene has no light.
void warnIfNoLights(const PreparedScene& prepared);

// Once: frees what the file has read and the tree's nodes as soon as the flat scene needs them no more.
enum class SceneUse { Once, Again };

// Makes it the scene of a file at `seconds` into its animation, or if absent in its rest pose. If it holds the file's scene at another time
// or with other edits, only what differs is made again, and what it warned of is not printed again. If the file refuses, throws InputError
// and leaves it as it was.
void updateScene(
    PreparedScene& prepared, SceneFile& file, std::optional<double> seconds, SplitRule split,
    const std::function<void(const std::string&)>& stage = [](const std::string&) {}, SceneUse use = SceneUse::Again);
// The same by other options in place of the file's, at the time that they have. If they are refused, neither scene nor file has changed.
void changeScene(PreparedScene& prepared, SceneFile& file, const LoadOptions& options, SplitRule split);

// The camera of that index, else of that name (the first if absent). Throws InputError that lists the cameras.
const Camera& findCamera(const Scene& scene, const std::optional<std::string>& choice);

// With its motion, and the media that its rays begin in.
FlatCamera flattenCamera(const PreparedScene& prepared, const Camera& camera, float aspectRatio, const Lens& lens);

// The default size of a picture: 512 pixels high, and as wide as the camera's aspect ratio says.
glm::uvec2 defaultSize(const Camera& camera);

}  // namespace glim
