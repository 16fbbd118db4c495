// What `glim render` is told.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/render/settings.hpp"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace glim {

enum class ProgressStyle { Auto, Bar, Json, None };

struct RenderOptions {
    std::filesystem::path scene, output;
    std::optional<std::filesystem::path> png, rates, stats;
    std::optional<glm::uvec2> size;
    std::optional<std::size_t> sceneIndex;
    std::optional<std::string> device, camera;
    std::optional<glm::vec3> environment;
    double exposure = 0.0;
    Lens lens;
    SplitRule split = SplitRule::Sah;
    ProgressStyle progress = ProgressStyle::Auto;
    RenderSettings settings;  // all but width and height
};

// Adds every option of `render` to `command`; they write into `options`, which must outlive it.
void addRenderOptions(CLI::App& command, RenderOptions& options);

}  // namespace glim
