// Reads materials: maps glTF's model to glim's materials.
#pragma once

#include "host/scene/gltf/gltf_file.hpp"
#include "host/scene/scene.hpp"

namespace glim {

struct MaterialReading {
    Material material;
    std::string warning;  // names every property of the material that glim ignores; empty if there is none
};

// -1 is glTF's default material.
MaterialReading readMaterial(const GltfFile& file, int index);

}  // namespace glim
