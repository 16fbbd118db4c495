// Changes a document before it is read.
#pragma once

#include "host/scene/edit.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace glim {

// An edit sets a number, an array of numbers, a boolean or an enumerated string of a node, a material, a camera
// or a light, or the weights of a mesh. Missing objects on the way are created. If an edit sets the translation, rotation or scale of a
// node with a matrix, the matrix is first split into the three. An edit of the matrix removes them. `document` has passed checkGltfJson,
// and is to pass it again, which checks the values. Throws InputError.
void editGltf(const std::string& path, nlohmann::json& document, const Edit& edit);

}  // namespace glim
