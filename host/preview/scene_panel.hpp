// The panel that changes how the scene is lit and set: environment, sun, variant, floor.
#pragma once

#include "host/scene/load_gltf.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace glim {

// What the panel shows, and the user does not change there.
struct SceneFigures {
    std::vector<std::string> variants;
    std::vector<std::filesystem::path> maps;  // that the environment may be
    bool hasEnvironment = false, hasMap = false;
};

// What the user changes there.
struct SceneChoices {
    LoadOptions load;
    bool dragsSun = false;  // the mouse moves the sun in place of the camera

    bool operator==(const SceneChoices&) const = default;
};

// A sun high on one side, as bright on a white diffuse surface as white paper.
inline constexpr Sun kFirstSun{45.0, 45.0, 3.0F};

// The maps in the scene's folder, and the one of the options.
std::vector<std::filesystem::path> findMaps(const std::filesystem::path& scene, const LoadOptions& options);

// The sun after a drag by `motion` pixels; the height of the picture makes half a turn.
Sun dragSun(const Sun& sun, const glm::dvec2& motion, double height);

// In the lower right corner, closed at first. Call it inside a frame (host/window/gui.hpp). Returns `choices` with what the user changes
// in this frame.
SceneChoices showScene(const SceneFigures& figures, SceneChoices choices);

}  // namespace glim
