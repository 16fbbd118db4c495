// A scene as plain values: no Vulkan, no glTF. Meshes are in object space; instances place them in the world, in double. All other
// positions are float32 relative to `origin`, a point amid the scene in world coordinates (choose_origin.hpp). It was subtracted in double,
// so that a scene far from the world's origin loses no accuracy.
#pragma once

#include "host/image/decode_image.hpp"
#include "host/image/radiance_map.hpp"
#include "host/message.hpp"
#include "host/scene/motion.hpp"
#include "host/scene/projection.hpp"
#include "host/shared_vector.hpp"
#include "shaders/shared/texture_slots.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glim {

enum class Wrap : std::uint32_t { Clamp, Mirrored, Repeat };
enum class AlphaMode : std::uint32_t { Opaque, Mask, Blend };

// How a property of a material uses an image.
struct Texture {
    std::uint32_t image = 0;
    std::uint32_t uvSet = 0;  // 0 or 1: of the mesh's uv0 and uv1
    Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
    bool nearest = false;  // else bilinear
    // Coordinates of the image are (dot(rowU, (u, v, 1)), dot(rowV, (u, v, 1))).
    glm::vec3 rowU{1.0F, 0.0F, 0.0F}, rowV{0.0F, 1.0F, 0.0F};

    bool operator==(const Texture&) const = default;
};

// What a surface does to light: glTF's material, with glTF's defaults. Colours are linear Rec.709. Textures multiply.
struct Material {
    std::string name;
    glm::vec3 baseColor{1.0F};
    float metallic = 1.0F, roughness = 1.0F;
    float ior = 1.5F;               // 0: infinite
    float specular = 1.0F;          // strength of the dielectric's reflection
    glm::vec3 specularColor{1.0F};  // of that reflection at normal incidence; may exceed 1
    glm::vec3 emission{0.0F};       // radiance, W/(sr m^2)
    std::uint32_t lightGroup = 0;   // of Scene::lightGroups
    bool isDisplay = false;         // it emits to be seen, not to light the scene: without KHR_materials_emissive_strength
    bool doubleSided = false;       // emits from both sides; and rays meet its back faces, as those of what transmits (meetsBackFaces)
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alpha = 1.0F, alphaCutoff = 0.5F;
    float normalScale = 1.0F;
    // KHR_materials_transmission, _volume, _dispersion, _diffuse_transmission.
    float transmission = 0.0F;
    bool thick = false;          // has a volume, even if nothing transmits
    bool solid = false;          // what transmits encloses a medium; else it is a thin wall
    glm::vec3 absorption{0.0F};  // of the medium, 1/m
    // KHR_materials_scatter and its forerunners, of the medium: 1/m, and the mean cosine of a deflection.
    glm::vec3 scattering{0.0F};
    float scatterAnisotropy = 0.0F;
    // KHR_materials_scatter of a thin wall: diffuseTransmission is the share of what it transmits that scatters, most of it onwards if the
    // anisotropy is positive.
    bool scattersThin = false;
    float dispersion = 0.0F;  // of the medium: 20 / Abbe number
    float diffuseTransmission = 0.0F;
    glm::vec3 diffuseTransmissionColor{1.0F};
    // _clearcoat, _sheen, _anisotropy, _iridescence.
    float clearcoat = 0.0F, clearcoatRoughness = 0.0F, clearcoatNormalScale = 1.0F;
    glm::vec3 sheenColor{0.0F};
    float sheenRoughness = 0.0F;
    float anisotropy = 0.0F, anisotropyRotation = 0.0F;  // radians, counter-clockwise from the tangent
    float iridescence = 0.0F, iridescenceIor = 1.3F;
    float iridescenceThicknessMinimum = 100.0F, iridescenceThicknessMaximum = 400.0F;  // nm
    std::array<std::uint32_t, 2> uvSets{0, 1};  // the sets of the file that uv0 and uv1 of the material's meshes are
    bool isCatcher = false;                     // of shadows: pictures show what it is like beside what it would be without the rest
    bool unlit = false;                         // _unlit: the base colour, for the camera alone
    bool glossy = false;                        // _pbrSpecularGlossiness: specularColor is F0, and roughness the glossiness
    std::array<std::optional<Texture>, std::size(kTextureSlots)> textures;  // at kSlotBaseColor ...
};

inline bool isTextured(const Material& m)
{
    return std::ranges::any_of(m.textures, [](const std::optional<Texture>& texture) { return texture.has_value(); });
}

// Whether rays from behind meet the surface; glTF 2.0, section 3.9.6. Extensions that let light through leave no back face out.
inline bool meetsBackFaces(const Material& m) { return m.doubleSided || m.transmission > 0.0F || m.thick || m.diffuseTransmission > 0.0F; }

// A material that has a diffuse lobe alone.
inline Material makeLambert(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0F), bool doubleSided = false)
{
    Material material;
    material.baseColor = albedo;
    material.metallic = material.specular = 0.0F;
    material.emission = emission;
    material.doubleSided = doubleSided;
    return material;
}

// Of what the file does not have.
inline constexpr std::uint32_t kNoIndex = std::numeric_limits<std::uint32_t>::max();

// Indexed triangles of one material, or a cloud of points or lines, which are drawn as spheres or as cylinders with round ends. Attributes
// are per vertex: one for each position, or none if the file has none.
struct Mesh {
    std::string name;
    // In double: what a file stores as normalised integers need not fit a float.
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;  // of any length, possibly not finite
    std::vector<glm::vec4> tangents;  // w: the sign of the bitangent
    std::vector<glm::vec2> uv0, uv1;
    std::vector<glm::vec4> colors;       // linear, with alpha
    std::vector<std::uint32_t> indices;  // three per triangle, counter-clockwise seen from the front
    std::uint32_t material = 0;
    std::uint32_t fileMesh = kNoIndex;  // the file's mesh that this is a primitive of
    bool isCloud = false;               // has no triangles, but a point at each position or lines; with colours at most
    double pointRadius = 0.0;           // of a cloud, in its own space; 0: Scene::lonePointRadius
    std::vector<glm::uvec2> lines;      // of a cloud: between these positions, and then no points
};

// A mesh placed in the world.
struct MeshInstance {
    std::string name;
    std::uint32_t mesh = 0;
    glm::dmat4 worldFromMesh{1.0};         // affine and invertible; if it mirrors, front sides stay front sides
    std::uint32_t node = kNoIndex;         // of the file
    std::shared_ptr<const Motion> motion;  // while the shutter is open; worldFromMesh is that of the frame's time. Null: it stands still
};

// What all images of a scene may take: as much as kernels address.
inline constexpr std::uint64_t kMaxTextureBytes = std::uint64_t{1} << 32U;

struct TextureImage {
    TextureImage(std::string nameInMessages, std::shared_ptr<const DecodedImage> decoded)
        : name(std::move(nameInMessages)),
          width(decoded->width),
          height(decoded->height),
          pixels(std::move(decoded))
    {}
    TextureImage(std::string nameInMessages, const DecodedImage& decoded)
        : TextureImage(std::move(nameInMessages), std::make_shared<DecodedImage>(decoded))
    {}

    std::string name;
    std::uint32_t width, height;
    std::shared_ptr<const DecodedImage> pixels;
};

// Radiance from infinitely far: a latitude-longitude map whose middle is -z and whose first row is +y, or the same radiance from
// everywhere.
struct Environment {
    glm::vec3 radiance{1.0F};  // of the constant one; of a map what multiplies its texels
    std::shared_ptr<const RadianceMap> map;
    float rotation = 0.0F;    // of the map about +y, counter-clockwise seen from above, radians
    bool background = true;   // the camera sees it
    std::string source;       // the map's file, studio, EXT_lights_image_based or constant
    std::uint32_t group = 0;  // of Scene::lightGroups
};

struct Sphere {
    std::string name;
    glm::vec3 center{0.0F};
    float radius = 1.0F;  // metres, >= 0
    std::uint32_t material = 0;
    std::uint32_t node = kNoIndex;  // of the file
};

struct PunctualLight {
    enum class Kind : std::uint32_t { Point, Directional, Spot };
    std::string name;
    Kind kind = Kind::Point;
    glm::vec3 position{0.0F};             // point, spot
    glm::vec3 direction{0.0F, 0.0F, -1};  // unit, the way light travels; directional, spot
    glm::vec3 intensity{1.0F};            // point, spot: W/sr; directional: W/m^2 on a surface facing it
    float versineInner = 0.0F;            // 1 - cos; spot: full intensity inside this angle,
    float versineOuter = 1.0F;            // none outside this one
    float range = 0.0F;                   // point, spot: metres beyond which there is no light; 0: no limit
    std::uint32_t group = 0;              // of Scene::lightGroups
};

// The default size of a picture follows its camera's aspect ratio up to this, and down to its inverse.
inline constexpr float kMaxAspectRatio = 16.0F;
// Of a perspective camera that names none.
inline constexpr float kUsualAspectRatio = 16.0F / 9.0F;

struct Camera {
    enum class Kind : std::uint32_t { Perspective, Orthographic };
    std::string name;
    Kind kind = Kind::Perspective;
    glm::vec3 position{0.0F};
    glm::vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  // orthonormal; right x up = -forward
    float yfov = 0.7F;                                         // radians, perspective
    float halfWidth = 1.0F, halfHeight = 1.0F;                 // metres, orthographic: glTF's xmag and ymag, negative if mirrored
    std::optional<float> aspectRatio;                          // width / height, where the file names one
    Projection projection;                                     // from here on; files know none
    std::shared_ptr<const Motion> motion;  // in the world, while the shutter is open: what turns it from the frame's pose, and where it is
};

// A motion of the file, which poses the scene at a time.
struct Animation {
    std::string name;
    double duration = 0.0;  // seconds
};

struct Scene {
    std::string file;
    std::vector<std::filesystem::path> files;  // the files it was read from: `file`, its buffers, images and map
    glm::dvec3 origin{0.0};
    SharedVector<Mesh> meshes;
    std::vector<MeshInstance> instances;
    std::vector<Sphere> spheres;
    std::size_t addedInstances = 0, addedSpheres = 0;  // the last ones: of files that were added. Cameras are framed on the others
    std::optional<double> pointRadius, lineRadius;     // of all, metres; else each cloud has its own, which its instances scale
    double lonePointRadius = 0.0;                      // of clouds that have none, metres
    std::size_t flattened = 0;  // meshes and spheres of the file that are left out as their nodes are scaled to a plane, a line or a point
    std::vector<Material> materials;                // in the file's order
    std::optional<std::uint32_t> defaultMaterial;   // the one of them that the file does not have
    bool showsBackFaces = false;                    // of every material, as if meetsBackFaces
    std::vector<std::string> nodeNames, meshNames;  // of all that the file has, in its order; empty without a name
    std::vector<TextureImage> images;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;     // never empty after load_gltf: one is framed where the file has none
    std::optional<Shutter> shutter;  // by which instances and cameras have motions
    std::optional<Environment> environment;
    std::vector<std::string> lightGroups;  // their names; empty if the film is to have none (light_groups.hpp)
    std::vector<std::string> variants;     // names in KHR_materials_variants
    std::vector<Animation> animations;
    std::vector<std::string> extensions;      // that the file uses; getEffect says what becomes of them
    std::size_t skins = 0, morphTargets = 0;  // of the file
    std::vector<Message> warnings;            // one line each: what was ignored, mapped, dropped or framed
};

// By material, whether a mesh or a sphere has it.
inline std::vector<bool> findUsedMaterials(const Scene& scene)
{
    std::vector<bool> used(scene.materials.size(), false);
    for (const Mesh& mesh : scene.meshes) {
        used[mesh.material] = true;
    }
    for (const Sphere& sphere : scene.spheres) {
        used[sphere.material] = true;
    }
    return used;
}

}  // namespace glim
