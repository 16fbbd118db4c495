// The scene as the arrays that kernels read. Element types: shaders/shared/scene_types.h, which says what is in the texels.
#pragma once

#include "shaders/shared/limits.h"
#include "shaders/shared/scene_types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

// What the scene needs; the rest is compiled out of the kernels.
struct SceneFeatures {
    bool spheres = false;
    bool slivers = false;         // some triangles are thinner than kSliverHeight
    bool smooth = false;          // some triangles have vertex normals
    bool mirrors = false;
    bool glasses = false;
    bool triangleLights = false;
    bool sphereLights = false;
    bool punctualLights = false;
    bool environment = false;
    std::uint32_t stackLevels = kMaxStackLevels;  // of a traversal
};

struct FlatScene {
    std::vector<uvec4> nodes;
    std::vector<uvec4> records;   // in the order of the BVH's leaves
    std::vector<uvec4> normals;   // parallel to records, or empty
    std::vector<FlatMaterial> materials;
    std::vector<FlatLight> lights;
    std::vector<FlatEmitter> emitters;
    SceneFeatures features;
    vec3 environment{0.0F};
    std::uint32_t environmentLight = 0;  // index among lights, if features.environment
};

// Bytes that the scene takes on the device.
std::uint64_t sizeInBytes(const FlatScene& scene);

// A fingerprint of everything above but the tree.
std::uint64_t fingerprint(const FlatScene& scene);
// Of a scene and a camera: equal pictures come from equal ones.
std::string fingerprint(std::uint64_t scene, const FlatCamera& camera);

}  // namespace glim
