// From a file to what the renderer takes, timed.
#pragma once

#include "host/bvh/build_bvh.hpp"
#include "host/bvh/wide_bvh.hpp"
#include "host/flatten/flat_scene.hpp"
#include "host/scene/load_gltf.hpp"

#include <filesystem>
#include <functional>
#include <optional>

namespace glim {

struct PreparedScene {
    Scene scene;
    WideBvh bvh;
    SplitRule split = SplitRule::Sah;  // that the tree was built by
    FlatScene flat;
    double loadSeconds = 0.0, buildSeconds = 0.0;  // build: BVH and flattening
};

// Throws InputError. Prints the scene's notices to stderr. Says what it begins to do to `stage`, as in "loading a.gltf".
PreparedScene prepareScene(const std::filesystem::path& file, const LoadOptions& options, SplitRule split = SplitRule::Sah,
                           const std::function<void(const std::string&)>& stage = [](const std::string&) {});

// To stderr, if the scene has no light.
void warnOfDarkness(const PreparedScene& prepared);

// The camera of that name or index (the first if absent). Throws InputError listing what there is.
const Camera& findCamera(const Scene& scene, const std::optional<std::string>& choice);

// Of the picture that nobody gave a size: 512 pixels high, as wide as the camera says.
glm::uvec2 naturalSize(const Camera& camera);

}  // namespace glim
