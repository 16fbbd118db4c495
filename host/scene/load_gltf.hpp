// glTF 2.0 (.gltf, .glb) to Scene: the only place that knows tinygltf.
#pragma once

#include "host/scene/scene.hpp"

#include <filesystem>
#include <optional>

namespace glim {

struct LoadOptions {
    std::optional<std::size_t> scene;      // index into the file's scenes; if absent its default scene, else the first
    std::optional<glm::vec3> environment;  // a constant radiance that replaces the file's environment
    float aspectRatio = 1.0F;              // of the picture, for the framed camera if the file has none
};

// Reads and checks a whole file; the result has passed checkScene. Throws InputError with one sentence that names file, place, value and
// what was expected.
Scene loadGltf(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace glim
