// Properties of a glTF document by pointers of its object model: /nodes/3/scale. Animations and edits find them in the same way.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace glim {

// The steps of a pointer (RFC 6901): nodes, 3, scale.
std::vector<std::string> splitPointer(const std::string& pointer);

bool isIndex(const std::string& step);

// A member or an element; null if there is none.
nlohmann::json* follow(nlohmann::json& at, const std::string& step);

// The schema's path (gltf_schema.hpp): nodes[].scale. Empty if a step has one of .[]{}, which no property has.
std::string makeSchemaPath(const std::vector<std::string>& steps);

// Gives a node a translation, a rotation and a scale in place of its matrix. Returns false, and changes nothing, if the matrix shears,
// flattens or projects.
bool splitMatrix(nlohmann::json& node);

}  // namespace glim
