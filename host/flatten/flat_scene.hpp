// The scene as the arrays that kernels read. shaders/shared/scene_types.h says what is in their elements.
#pragma once

#include "shaders/shared/features.h"
#include "shaders/shared/limits.h"
#include "shaders/shared/scene_types.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glim {

// Readable names for the bits of shaders/shared/features.h.
struct Feature {
    std::uint32_t bit;
    const char* name;
};

constexpr Feature kFeatures[] = {{kFeatureSpheres, "spheres"},
                                 {kFeatureSlivers, "slivers"},
                                 {kFeatureSmooth, "smooth normals"},
                                 {kFeatureMirror, "mirrors"},
                                 {kFeatureDielectric, "glass"},
                                 {kFeatureTriangleLights, "triangle lights"},
                                 {kFeatureSphereLights, "sphere lights"},
                                 {kFeaturePunctualLights, "punctual lights"},
                                 {kFeatureEnvironment, "environment"}};

struct FlatScene {
    std::vector<uvec4> nodes;
    std::vector<uvec4> records;              // for traversal, in the order of the BVH's leaves
    std::vector<uvec4> triangles, vertices;  // for shading, by primitive id; empty if no triangle has vertex normals
    std::vector<MaterialData> materials;
    std::vector<FlatLight> lights;
    std::vector<FlatEmitter> emitters;
    std::uint32_t features = 0;                   // kFeatureSpheres ...: what the scene needs
    std::uint32_t stackLevels = kMaxStackLevels;  // of the traversal stack
    vec3 environment{0.0F};
    std::uint32_t environmentLight = 0;  // index among lights, if the scene has kFeatureEnvironment
};

// How many bytes the scene takes on the device.
std::uint64_t sizeInBytes(const FlatScene& scene);

// A fingerprint of all of the above except the tree.
std::uint64_t fingerprint(const FlatScene& scene);
// The fingerprint of a scene and a camera. Films with equal fingerprints show the same picture.
std::string fingerprint(std::uint64_t scene, const FlatCamera& camera);

}  // namespace glim
