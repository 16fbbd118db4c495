// The options that render, preview and bench share.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/cli/command.hpp"
#include "host/cli/look_options.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/settings.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/pose.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace glim {

struct PictureOptions {
    std::filesystem::path scene;
    std::optional<glm::uvec2> size;
    std::optional<std::size_t> sceneIndex;
    std::optional<std::string> device, camera;
    std::optional<Pose> pose;
    std::optional<EnvironmentChoice> environment;
    std::string variant, animation;
    std::optional<double> at;          // seconds
    float environmentRotation = 0.0F;  // degrees
    bool environmentBackground = true;
    std::optional<Sun> sun;
    bool showsBackFaces = false;
    MissingTextures missingTextures = MissingTextures::Refuse;
    bool confined = false;  // the files that the scene names lie in its folder
    std::uint32_t maxTexture = kMaxImageSide;
    LookOptions look;
    Lens lens;
    SplitRule split = SplitRule::Sah;
    RenderSettings settings;  // all but width and height
};

// Each adds options to the help's current group. They write into `options` or `settings`, which must outlive the command.
void addPicture(const Command& command, PictureOptions& options, const std::string& height = "512");  // default of --size
void addAnimation(const Command& command, std::optional<double>& at, std::string& animation);
void addTextures(const Command& command, MissingTextures& missing, std::uint32_t& largest);
void addSampleCount(const Command& command, RenderSettings& settings, const std::string& sppDefault, const std::string& rangeDefault);
void addAdaptive(const Command& command, RenderSettings& settings);
void addSampler(const Command& command, RenderSettings& settings);

// Each adds a whole group of the help. `more`: what else --camera may be.
void addCamera(const Command& command, PictureOptions& options, const std::string& more = "");
void addLightTransport(const Command& command, RenderSettings& settings);
void addCaustics(const Command& command, RenderSettings& settings);
void addCourseEstimators(const Command& command, RenderSettings& settings);
void addDevice(const Command& command, PictureOptions& options);

// Adds the limits of --adaptive course to the group of addCourseEstimators.
void addCourseRule(const Command& command, RenderSettings& settings);

LoadOptions loadOptionsOf(const PictureOptions& options);
// The camera that the options choose, placed where they say.
Camera cameraOf(const Scene& scene, const PictureOptions& options);
// The settings with a size: from the options, or else from the camera.
RenderSettings settingsFor(const PictureOptions& options, const Camera& camera);

}  // namespace glim
