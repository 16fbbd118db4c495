// glTF 2.0 (.gltf, .glb) to Scene: the only place that knows tinygltf.
#pragma once

#include "host/scene/scene.hpp"

#include <filesystem>
#include <optional>

namespace glim {

struct LoadOptions {
    std::optional<std::size_t> scene;  // index into the file's scenes; its default scene, else the first, if absent
    std::optional<glm::vec3> environment;  // constant radiance in place of whatever the file says of its environment
    float aspectRatio = 1.0F;              // of the picture, for the camera that is framed where the file has none
};

// Reads and checks a whole file; the result has passed check_scene.
// Throws InputError with one sentence that names file, place, value and what was expected.
Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace glim
