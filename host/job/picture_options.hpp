// The options that render, preview and bench share.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/job/look_options.hpp"
#include "host/job/option_table.hpp"
#include "host/render/settings.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/pose.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace glim {

enum class CausticsChoice { Off, On, Auto };
enum class GuidingChoice { Off, On, Auto };

struct PictureOptions {
    std::filesystem::path scene;
    std::optional<glm::uvec2> size;
    std::optional<std::size_t> sceneIndex;
    std::optional<std::string> device, camera;
    std::optional<Pose> pose;
    FieldOfView field;
    Projection projection;  // without the picture's size
    std::optional<EnvironmentChoice> environment;
    std::string variant, animation;
    std::optional<double> at;          // seconds
    std::optional<Shutter> shutter;    // of renders
    float environmentRotation = 0.0F;  // degrees
    float environmentStrength = 1.0F;
    bool environmentBackground = true;
    std::optional<Sun> sun;
    bool showsBackFaces = false;
    std::optional<double> pointRadius, lineRadius;  // of all points and lines, metres
    std::optional<SceneFloor> floor;
    std::vector<std::string> catchers;
    LightGroupChoice lightGroups;
    std::vector<Edit> edits;
    std::vector<Addition> additions;
    MissingTextures missingTextures = MissingTextures::Refuse;
    bool confined = false;  // the files that the scene names lie in its folder
    std::uint32_t maxTexture = kMaxImageSide;
    LookOptions look;
    Lens lens;
    SplitRule split = SplitRule::Sah;
    CausticsChoice caustics = CausticsChoice::Auto;
    GuidingChoice guiding = GuidingChoice::Off;
    RenderSettings settings;  // all but width, height and what `caustics` and `guiding` decide
};

// Each adds options to the help's current group. They write into `options` or `settings`, which must outlive the table.
void addPicture(OptionTable& table, PictureOptions& options, const std::string& height = "512");  // default of --size
void addAnimation(OptionTable& table, std::optional<double>& at, std::string& animation);
void addTextures(OptionTable& table, MissingTextures& missing, std::uint32_t& largest);
void addSampleCount(OptionTable& table, RenderSettings& settings, const std::string& sppDefault, const std::string& rangeDefault);
void addAdaptive(OptionTable& table, RenderSettings& settings);
void addSampler(OptionTable& table, RenderSettings& settings);

// Each adds a whole group of the help. `more`: what else --camera may be.
void addCamera(OptionTable& table, PictureOptions& options, const std::string& more = "");
void addProjection(OptionTable& table, PictureOptions& options);
void addCrop(OptionTable& table, PictureOptions& options);
void addFocus(OptionTable& table, std::optional<glm::uvec2>& pixel);
void addLightTransport(OptionTable& table, RenderSettings& settings);
void addCaustics(OptionTable& table, CausticsChoice& caustics);
void addGuiding(OptionTable& table, GuidingChoice& guiding);
void addGuidingAtRest(OptionTable& table, GuidingChoice& guiding);
void addCourseEstimators(OptionTable& table, RenderSettings& settings);
void addDevice(OptionTable& table, PictureOptions& options);

// Adds the limits of --adaptive course to the group of addCourseEstimators.
void addCourseRule(OptionTable& table, RenderSettings& settings);

LoadOptions makeLoadOptions(const PictureOptions& options);
// The camera that the options choose, placed where they say and with the angle that they say. Throws InputError if that cannot be.
Camera makeCamera(const Scene& scene, const PictureOptions& options);
// The settings with a size: that of the camera's crop, or of the options, or else by the camera.
RenderSettings settingsFor(const PictureOptions& options, const Camera& camera);
// Throws InputError for a pixel that the option names and the picture lacks.
void refuseOutside(const std::string& option, const glm::uvec2& pixel, const RenderSettings& settings);

}  // namespace glim
