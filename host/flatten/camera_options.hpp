// A changed camera, written as command-line options.
#pragma once

#include "host/flatten/flatten_scene.hpp"
#include "host/scene/pose.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glim {

using OptionTexts = std::vector<std::pair<std::string, std::string>>;  // names without dashes, and values

// As in a film's settings: " look-from=0,0,1 look-at=0,0,0 lens-radius=0.1 ...", exact; empty if nothing was changed.
std::string describeCamera(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens, const Projection& projection = {});

// The same as options of `glim render`: look-from, 0,0,1; look-at, 0,0,0; lens-radius, 0.1 ...
OptionTexts cameraOptions(const std::optional<Pose>& pose, const FieldOfView& field, const Lens& lens, const Projection& projection = {});

}  // namespace glim
