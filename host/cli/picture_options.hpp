// What `glim render` and `glim preview` are both told.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/settings.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/pose.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace glim {

struct PictureOptions {
    std::filesystem::path scene;
    std::optional<glm::uvec2> size;
    std::optional<std::size_t> sceneIndex;
    std::optional<std::string> device, camera;
    std::optional<Pose> pose;
    std::optional<glm::vec3> environment;
    double exposure = 0.0;
    Lens lens;
    SplitRule split = SplitRule::Sah;
    RenderSettings settings;  // all but width and height
};

// Adds their options to `command`; they write into `options`, which must outlive it.
void addSceneOptions(CLI::App& command, PictureOptions& options);
void addSceneChoice(CLI::App& command, PictureOptions& options);  // of them, all but the file
void addCameraOptions(CLI::App& command, PictureOptions& options, const std::string& height = "512");  // without --size
void addDevice(CLI::App& command, PictureOptions& options);

LoadOptions loadOptionsOf(const PictureOptions& options);
// The camera of the scene that the options choose, where they place it.
Camera cameraOf(const Scene& scene, const PictureOptions& options);
// With the size that the options or, without one, the camera names.
RenderSettings settingsFor(const PictureOptions& options, const Camera& camera);

}  // namespace glim
