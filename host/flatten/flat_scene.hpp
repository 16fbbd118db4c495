// The scene as the arrays that kernels read. shaders/shared/scene_types.h says what is in their elements.
#pragma once

#include "host/image/decode_image.hpp"
#include "host/image/radiance_map.hpp"
#include "host/scene/placed_mesh.hpp"
#include "host/shared_vector.hpp"
#include "shaders/shared/features.h"
#include "shaders/shared/limits.h"
#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glim {

// By which the colours of lights count: it does not change when channels are swapped.
inline double strongestChannel(const glm::vec3& color) { return static_cast<double>(std::max({color.r, color.g, color.b})); }

// The images of a scene as kernels read them: each once, however many textures use it.
struct PackedImages {
    std::vector<std::weak_ptr<const DecodedImage>> sources;  // in this order
    std::vector<std::uint32_t> texels;                       // a byte per channel
    std::uint64_t fingerprint = 0;
};

// An environment map as kernels read it (shaders/access/environment_map.glsl).
struct PackedEnvironment {
    std::shared_ptr<const RadianceMap> source;  // null: there is no map
    double integral = 0.0;                      // of its strongest channel over all directions
    std::vector<uvec2> texels;                  // empty, as the cells are, if the map is black
    std::vector<uvec4> cells;                   // by which it is sampled
    uvec2 size{0}, cellCount{0};
    // Light paths carry what exceeds the radiance `split`, in the strongest channel; its integral over all directions, and the cells with
    // such directions, as scene_types.h says. None if all of the map is left to camera paths.
    float split = 0.0F;
    double brightIntegral = 0.0;
    std::vector<uvec4> brightCells;
    std::uint64_t fingerprint = 0;  // of the texels
};

// What the emission of an instance's triangles is multiplied by on average, by a texture. It takes longer than all else of an edit.
struct EmissionMeans {
    std::weak_ptr<const DecodedImage> image;
    Texture texture;
    std::vector<glm::vec4> uvs;  // three of each triangle: set 0 and set 1
    std::vector<double> means;   // 0 only where the texture is black all over the triangle
};

// That the references of a primitive say which light it is.
struct LightMark {
    std::uint32_t primitive;
    std::uint32_t light;  // its index plus 1

    bool operator==(const LightMark&) const = default;
};

// Where a camera's motion is among those of the scene.
struct MovingCamera {
    std::shared_ptr<const Motion> motion;
    std::uint32_t flat;                 // as FlatCamera::motion
    std::vector<glm::dvec3> positions;  // on its way
};

struct FlatScene {
    SharedVector<uvec4> nodes;
    SharedVector<uvec4> primitiveRefs;        // for traversal, in the order of the BVH's leaves
    SharedVector<uvec4> triangles, vertices;  // for shading; empty if no triangle has vertex attributes
    SharedVector<uvec4> instances;            // of shared meshes; empty without kFeatureInstances
    SharedVector<uvec4> motions;              // of instances in their order, then of cameras (scene_types.h)
    std::vector<MovingCamera> movingCameras;  // not on the device
    float frameTime = 0.0F;                   // the frame's time, from when the shutter opens (0) to when it closes (1)
    std::uint32_t triangleCount = 0;
    std::uint32_t firstInstanceRef = 0;                           // references from here on are those of instances (scene_types.h)
    std::uint32_t firstUv = 0, firstTangent = 0, firstColor = 0;  // sections of `vertices`
    std::vector<MaterialData> materials;
    std::vector<PrincipledData> principled;  // behind the materials, in the same buffer
    std::vector<LayersData> layers;          // behind these
    std::vector<TextureData> textures;       // behind these
    std::vector<MediumData> media;           // behind these, from texel firstMedium on
    std::vector<ScatteringData> scattering;  // behind these, from texel firstScattering on; empty without kFeatureScattering
    std::uint32_t firstMedium = 0, firstScattering = 0;
    std::vector<std::uint32_t> mediumOfMaterial;  // its number; 0: none, or paths need not know. Not on the device
    std::vector<FeatureMask> materialFeatures;    // what each material needs, used or not; not on the device
    std::shared_ptr<const PackedImages> images = std::make_shared<PackedImages>();  // never null
    std::vector<std::uint64_t> imageBytes;  // of each image of the scene; 0: of one colour, which is in the factors. Not on the device
    std::vector<uvec4> albedos;             // empty without kFeaturePrincipled
    std::vector<FlatLight> lights;
    std::vector<LightMark> lightMarks;                                // in the references; not on the device
    std::vector<std::shared_ptr<const EmissionMeans>> emissionMeans;  // not on the device
    std::vector<LightNode> lightNodes;
    std::vector<uvec4> lightPowers;               // behind the lights, in the same buffer; empty without kFeatureLightClusters
    std::uint32_t finiteLights = 0;               // the first lights
    float infiniteImportance = 0.0F;              // as in RenderParameters
    FeatureMask features = 0;                     // kFeatureSpheres ...: what the scene needs
    FeatureMask surfaceFeatures = 0;              // of these, what its shapes need, whatever they are made of
    std::uint32_t stackLevels = kMaxStackLevels;  // of the traversal stack
    vec3 environment{0.0F};                       // radiance, or what multiplies that of the map
    bool hidesEnvironment = false;                // from the camera
    vec2 environmentRotation{1.0F, 0.0F};         // cosine and sine of the map's rotation
    std::shared_ptr<const PackedEnvironment> environmentMap = std::make_shared<PackedEnvironment>();  // never null
    std::uint32_t environmentLight = 0;  // index among lights, if the scene has kFeatureEnvironment
    std::vector<uvec4> caustics;         // as scene_types.h says; empty without kFeatureCaustics
    std::uint32_t causticTargets = 0, causticLights = 0;
    bool hasHiddenCaustics = false;  // of lights without extent, which camera paths never find
    // Of the fingerprint what references, triangles and vertices make of it, once somebody has asked.
    std::shared_ptr<std::optional<std::uint64_t>> surfacesPrint = std::make_shared<std::optional<std::uint64_t>>();
    std::vector<Triangle> largest;  // the 64 largest triangles outside of shared meshes; not on the device
    float brightness = 0.0F;        // about the radiance, W/(sr m^2), that the brightest light gives a white surface; of caustics
};

// How many bytes the scene takes on the device.
// Of a medium by its number, 1/m.
vec3 scatteringOf(const FlatScene& scene, std::uint32_t medium);
vec3 absorptionOf(const FlatScene& scene, std::uint32_t medium);

std::uint64_t sizeInBytes(const FlatScene& scene);

// How many of these bytes are images and environment maps, and images alone.
std::uint64_t textureBytes(const FlatScene& scene);
std::uint64_t imageBytes(const FlatScene& scene);

// A fingerprint of all of the above except the tree.
std::uint64_t fingerprint(const FlatScene& scene);
// Of a scene and a camera.
std::string fingerprint(std::uint64_t scene, const FlatCamera& camera);

}  // namespace glim
