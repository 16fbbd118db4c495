// glTF's material model to the three that glim has.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/scene.hpp"

namespace glim {

struct MaterialReading {
    Material material;
    std::string notice;  // names everything that the material asks for and does not get; empty if it is exact
};

// -1 is glTF's default material.
MaterialReading readMaterial(const GltfFile& file, int index);

}  // namespace glim
