// Changes a document before it is read.
#pragma once

#include "host/scene/edit.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace glim {

// Sets each property that glim reads and that has a value: numbers, truths and words of nodes, materials, cameras, lights and weights of
// meshes. Objects on the way that the file leaves out are made. A translation, a rotation or a scale of a node with a matrix takes its
// place, and a matrix theirs. `document` has passed checkGltfJson, and is to pass it again, which checks the values. Throws InputError.
void editGltf(const std::string& path, nlohmann::json& document, std::span<const Edit> edits);

}  // namespace glim
