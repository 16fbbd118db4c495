// The targets at which light paths are aimed, and the lights at which these paths begin.
#pragma once

#include "host/flatten/flat_scene.hpp"
#include "host/flatten/primitives.hpp"

namespace glim {

// Sets kFeatureCaustics and what it needs if a light may reach a specular surface: a mirror, smooth glass, or a glTF material with a
// smooth interface or coat somewhere. After addLights.
void addCaustics(FlatScene& flat, const Scene& scene, const Primitives& primitives);

}  // namespace glim
