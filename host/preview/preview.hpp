// A window that shows the picture while it refines.
#pragma once

#include "host/flatten/flatten_scene.hpp"
#include "host/render/settings.hpp"
#include "host/scene/load_gltf.hpp"
#include "host/scene/pose.hpp"
#include "host/bvh/build_bvh.hpp"

#include <filesystem>
#include <optional>

namespace glim {

struct PreviewOptions {
    std::filesystem::path scene;
    LoadOptions load;
    SplitRule split = SplitRule::Sah;
    std::optional<glm::uvec2> size;  // pixels; as the camera says, if absent
    std::optional<std::string> camera, device;
    std::optional<Pose> pose;
    Lens lens;
    double exposure = 0.0;
    RenderSettings settings;
    std::optional<std::uint64_t> frames;           // ends after as many
    std::optional<std::filesystem::path> script;
};

// Until the window is closed, as a script may, or the frames are shown. Throws InputError where there is no display or the scene is
// refused, DeviceError as a render does.
void preview(const PreviewOptions& options);

}  // namespace glim
