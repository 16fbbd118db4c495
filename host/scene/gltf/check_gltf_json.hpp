// The part of the glTF 2.0 schema that glim reads, as one table.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace glim {

// Types, required properties, ranges of numbers, indices below the size of what they point into, version and required
// extensions. Throws InputError with the place in glTF's own words (accessors[3].count). tinygltf checks none of this.
void checkGltfJson(const std::string& path, const nlohmann::json& document);

// What extensionsRequired may name.
bool isSupportedExtension(const std::string& name);

}  // namespace glim
