// A window that shows a scene while its picture refines.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/film_pictures.hpp"
#include "host/render/settings.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/pose.hpp"

#include <filesystem>
#include <optional>

namespace glim {

struct PreviewOptions {
    std::filesystem::path scene;
    LoadOptions load;
    SplitRule split = SplitRule::Sah;
    std::optional<glm::uvec2> size;    // pixels; absent: the size that fits the camera
    std::optional<glm::uvec2> window;  // pixels; absent: the picture's size at first, and then the picture follows the window
    std::optional<std::string> camera, device;
    std::optional<Pose> pose;
    FieldOfView field;
    Projection projection;  // without the picture's size
    Lens lens;
    LookOptions look;
    RenderSettings settings;
    bool guiding = false;                 // by a guide that is learned for each view that rests
    std::optional<std::uint64_t> frames;  // ends after this many pictures
    std::optional<std::filesystem::path> script;
    std::optional<std::filesystem::path> shaders;  // a folder of kernels in place of glim's own
};

// Runs until the user or the script closes the window, or until all frames are shown. Throws InputError if there is no display or the
// scene is refused, and DeviceError as a render does.
void preview(const PreviewOptions& options);

}  // namespace glim
