// A scene as plain values: no Vulkan, no glTF. Every position is float32 relative to `origin`, which is the centre of
// the scene's bounding box in world coordinates (to 1/256 of its extent) and was subtracted in double: far from the
// world's origin nothing is lost.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glim {

enum class Scattering : std::uint32_t { Lambert = 0, Mirror = 1, Glass = 2 };

// What a surface does to light. Colours are linear Rec.709.
struct Material {
    std::string name;
    Scattering scattering = Scattering::Lambert;
    glm::vec3 baseColor{1.0F};  // Lambert: albedo; mirror: reflectance at normal incidence; glass: transmitted tint
    glm::vec3 emission{0.0F};   // radiance, W/(sr m^2)
    float ior = 1.5F;           // glass only
    bool doubleSided = false;   // emits from both sides; scattering is always two-sided
};

// Counter-clockwise seen from the front. Shared vertices hold equal bits, which watertightness rests on.
struct Triangle {
    glm::vec3 vertices[3];
};

struct TriangleNormals {
    glm::vec3 normals[3];  // unit length
};

// One glTF primitive placed by one node: triangles [firstTriangle, firstTriangle + triangleCount).
struct Primitive {
    std::string name;
    std::uint32_t firstTriangle = 0;
    std::uint32_t triangleCount = 0;
    std::uint32_t material = 0;
    bool smooth = false;  // its entries of Scene::normals are meaningful
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
    glm::vec3 position{0.0F};            // point, spot
    glm::vec3 direction{0.0F, 0.0F, -1}; // unit, the way light travels; directional, spot
    glm::vec3 intensity{1.0F};           // point, spot: W/sr; directional: W/m^2 on a surface facing it
    float cosInner = 1.0F;               // spot: full intensity inside this angle,
    float cosOuter = 0.0F;               // none outside this one
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
    std::vector<std::filesystem::path> files;  // that it was read from: `file` and those of its buffers
    glm::dvec3 origin{0.0};
    std::vector<Triangle> triangles;
    std::vector<TriangleNormals> normals;  // empty, or one entry per triangle
    std::vector<Primitive> primitives;     // in order of firstTriangle, covering all triangles
    std::vector<Sphere> spheres;
    std::vector<Material> materials;
    std::vector<PunctualLight> lights;
    std::vector<Camera> cameras;  // never empty after load_gltf: one is framed where the file has none
    std::optional<glm::vec3> environment;  // constant radiance from everywhere
    std::vector<std::string> notices;      // one line each: what was ignored, mapped, dropped or framed
};

}  // namespace glim
