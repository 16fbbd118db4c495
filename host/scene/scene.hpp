// A scene as plain values: no Vulkan, no glTF. Meshes are in object space; instances place them in the world, in double. All other
// positions are float32 relative to `origin`, which is the centre of the scene's bounding box in world coordinates (to 1/256 of its
// extent) and was subtracted in double: far from the world's origin nothing is lost.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glim {

enum class Scattering : std::uint32_t { Lambert = 0, Mirror = 1, Dielectric = 2 };

// What a surface does to light. Colours are linear Rec.709.
struct Material {
    std::string name;
    Scattering scattering = Scattering::Lambert;
    glm::vec3 baseColor{1.0F};  // Lambert: albedo; mirror: reflectance at normal incidence; glass: transmitted tint
    glm::vec3 emission{0.0F};   // radiance, W/(sr m^2)
    float ior = 1.5F;           // glass only
    bool doubleSided = false;   // emits from both sides; scattering is always two-sided
};

// Indexed triangles of one material. Attributes are per vertex: one for each position, or none if the file has none.
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
};

// A mesh placed in the world.
struct MeshInstance {
    std::string name;
    std::uint32_t mesh = 0;
    glm::dmat4 worldFromMesh{1.0};  // affine and invertible; if it mirrors, front sides stay front sides
};

// An encoded image: in a file of its own, or in a range of one of the scene file's buffers.
struct EncodedImage {
    struct Range {
        std::uint32_t buffer = 0;
        std::uint64_t offset = 0, length = 0;
    };
    std::string name;
    std::string mimeType;        // empty where the file does not say
    std::string uri;             // relative to the scene's file, or data:
    std::optional<Range> range;  // where there is no uri
};

struct Sphere {
    std::string name;
    glm::vec3 center{0.0F};
    float radius = 1.0F;  // metres, >= 0
    std::uint32_t material = 0;
};

struct PunctualLight {
    enum class Kind : std::uint32_t { Point, Directional, Spot };
    std::string name;
    Kind kind = Kind::Point;
    glm::vec3 position{0.0F};             // point, spot
    glm::vec3 direction{0.0F, 0.0F, -1};  // unit, the way light travels; directional, spot
    glm::vec3 intensity{1.0F};            // point, spot: W/sr; directional: W/m^2 on a surface facing it
    float cosInner = 1.0F;                // spot: full intensity inside this angle,
    float cosOuter = 0.0F;                // none outside this one
};

struct Camera {
    enum class Kind : std::uint32_t { Perspective, Orthographic };
    std::string name;
    Kind kind = Kind::Perspective;
    glm::vec3 position{0.0F};
    glm::vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1};  // orthonormal; right x up = -forward
    float yfov = 0.7F;                                         // radians, perspective
    float halfWidth = 1.0F, halfHeight = 1.0F;                 // metres, orthographic: glTF's xmag and ymag
    std::optional<float> aspectRatio;                          // width / height, where the file names one
};

struct Scene {
    std::string file;
    std::vector<std::filesystem::path> files;  // the files it was read from: `file` and its buffers'
    glm::dvec3 origin{0.0};
    std::vector<Mesh> meshes;
    std::vector<MeshInstance> instances;
    std::vector<Sphere> spheres;
    std::vector<Material> materials;
    std::vector<EncodedImage> images;  // nothing reads them yet
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;           // never empty after load_gltf: one is framed where the file has none
    std::optional<glm::vec3> environment;  // constant radiance from everywhere
    std::vector<std::string> warnings;     // one line each: what was ignored, mapped, dropped or framed
};

}  // namespace glim
