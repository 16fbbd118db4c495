// Checks a glTF document against the part of the schema that glim reads (gltf_schema.hpp).
#pragma once

#include "host/scene/warnings.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace glim {

// Checks types, required properties, ranges of numbers, indices, version and required extensions. Throws InputError with the place in
// glTF's own words (accessors[3].count). tinygltf checks none of this. Mends what exporters write in other words than the schema's:
// members that are null, 4.0 for 4, zeros for no value, numbers that rounding has put out of their range.
void checkGltfJson(const std::string& path, nlohmann::json& document, Warnings& warnings);

// What the schema says of a property, by a path such as materials[].alphaCutoff; null if glim does not read it.
struct SchemaRule;
const SchemaRule* findRule(const std::string& path);

}  // namespace glim
