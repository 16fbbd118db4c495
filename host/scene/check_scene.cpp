#include "host/scene/check_scene.hpp"

#include "host/error.hpp"
#include "host/scene/placed_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

// Tolerance for the length and orthogonality of unit vectors in float32.
constexpr float kUnitTolerance = 1e-4F;

bool isFinite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

template <int Length>
bool isFinite(const glm::vec<Length, double>& v)
{
    for (int c = 0; c < Length; ++c) {
        if (!std::isfinite(v[c])) {
            return false;
        }
    }
    return true;
}

bool isUnit(const glm::vec3& v) { return std::abs(glm::dot(v, v) - 1.0F) <= kUnitTolerance; }

bool isRadiance(const glm::vec3& v) { return isFinite(v) && v.x >= 0.0F && v.y >= 0.0F && v.z >= 0.0F; }

bool isReflectance(const glm::vec3& v) { return isRadiance(v) && v.x <= 1.0F && v.y <= 1.0F && v.z <= 1.0F; }

class SceneCheck {
public:
    explicit SceneCheck(const Scene& scene)
        : scene_(scene)
    {}

    void checkMeshes() const;
    void checkInstances() const;
    void checkSpheres() const;
    void checkMaterials() const;
    void checkLights() const;
    void checkCameras() const;
    void require(bool holds, MessageId id, const char* kind, std::size_t index, const char* property, const char* fault) const
    {
        if (!holds) {
            throw InputError(id, {part::file(scene_.file), ": ", part::place(kind + (" " + std::to_string(index))), " has ",
                                  part::value(property), " ", fault});
        }
    }

private:
    const Scene& scene_;
};

void SceneCheck::checkMeshes() const
{
    for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
        const Mesh& mesh = scene_.meshes[i];
        const std::size_t count = mesh.positions.size();
        const auto isOneEach = [count](const auto& attribute) { return attribute.empty() || attribute.size() == count; };
        require(std::ranges::all_of(mesh.positions, [](const glm::dvec3& p) { return isFinite(p); }), MessageId::OutOfRange, "mesh", i,
                "a position", "that is not finite");
        require(isOneEach(mesh.normals) && isOneEach(mesh.tangents) && isOneEach(mesh.uv0) && isOneEach(mesh.uv1) && isOneEach(mesh.colors),
                MessageId::Mismatch, "mesh", i, "an attribute", "for some positions only");
        require(!mesh.isCloud || (mesh.indices.empty() && std::isfinite(mesh.pointRadius) && mesh.pointRadius >= 0.0), MessageId::Mismatch,
                "mesh", i, "points", "with triangles, or of a radius that is negative or not finite");
        require(mesh.lines.empty() || mesh.isCloud, MessageId::Mismatch, "mesh", i, "lines", "though it is no cloud");
        require(std::ranges::all_of(mesh.lines, [count](const glm::uvec2& line) { return line.x < count && line.y < count; }),
                MessageId::DanglingIndex, "mesh", i, "a line", "with an end that does not exist");
        require(mesh.indices.size() % 3 == 0, MessageId::Mismatch, "mesh", i, "a triangle", "with fewer than three vertices");
        require(std::ranges::all_of(mesh.indices, [count](std::uint32_t index) { return index < count; }), MessageId::DanglingIndex, "mesh",
                i, "a triangle", "with a vertex that does not exist");
        require(mesh.material < scene_.materials.size(), MessageId::DanglingIndex, "mesh", i, "a material", "that does not exist");
    }
}

void SceneCheck::checkInstances() const
{
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
        const MeshInstance& instance = scene_.instances[i];
        const glm::dmat4& m = instance.worldFromMesh;
        require(instance.mesh < scene_.meshes.size(), MessageId::DanglingIndex, "instance", i, "a mesh", "that does not exist");
        require(isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]) && isFinite(m[3]), MessageId::OutOfRange, "instance", i, "a transform",
                "that is not finite");
        require(m[0].w == 0.0 && m[1].w == 0.0 && m[2].w == 0.0 && m[3].w == 1.0 && glm::determinant(glm::dmat3(m)) != 0.0,
                MessageId::Degenerate, "instance", i, "a transform", "that is not affine or cannot be inverted");
        require(!scene_.meshes[instance.mesh].isCloud || std::isfinite(computePointRadius(scene_, instance)), MessageId::OutOfRange,
                "instance", i, "points", "of a radius that does not fit a float");
    }
}

void SceneCheck::checkSpheres() const
{
    for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
        const Sphere& sphere = scene_.spheres[i];
        require(isFinite(sphere.center), MessageId::OutOfRange, "sphere", i, "a centre", "that is not finite");
        require(std::isfinite(sphere.radius) && sphere.radius >= 0.0F, MessageId::OutOfRange, "sphere", i, "a radius",
                "that is negative or not finite");
        require(sphere.material < scene_.materials.size(), MessageId::DanglingIndex, "sphere", i, "a material", "that does not exist");
    }
}

void SceneCheck::checkMaterials() const
{
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) {
        const Material& material = scene_.materials[i];
        require(isReflectance(material.baseColor), MessageId::OutOfRange, "material", i, "a base colour", "outside 0 to 1");
        require(isRadiance(material.emission), MessageId::OutOfRange, "material", i, "an emission", "that is negative or not finite");
        require(std::isfinite(material.ior) && (material.ior >= 1.0F || (material.ior == 0.0F && !material.solid)), MessageId::OutOfRange,
                "material", i, "an index of refraction", "below 1 or not finite");
        const auto isShare = [](float value) { return value >= 0.0F && value <= 1.0F; };
        const auto isNumber = [](float value) { return std::isfinite(value) && value >= 0.0F; };
        require(isShare(material.metallic) && isShare(material.roughness) && isShare(material.specular) && isShare(material.alpha),
                MessageId::OutOfRange, "material", i, "a metallic, roughness, specular or alpha", "outside 0 to 1");
        require(isRadiance(material.specularColor) && std::isfinite(material.normalScale) && material.alphaCutoff >= 0.0F,
                MessageId::OutOfRange, "material", i, "a specular colour, normal scale or alpha cutoff", "that is negative or not finite");
        require(isShare(material.transmission) && isShare(material.diffuseTransmission) && isShare(material.clearcoat) &&
                    isShare(material.clearcoatRoughness) && isShare(material.sheenRoughness) && isShare(material.anisotropy) &&
                    isShare(material.iridescence),
                MessageId::OutOfRange, "material", i, "a share or a roughness of a layer", "outside 0 to 1");
        require(isReflectance(material.diffuseTransmissionColor) && isReflectance(material.sheenColor) && isRadiance(material.absorption) &&
                    isRadiance(material.scattering),
                MessageId::OutOfRange, "material", i, "a colour of a layer",
                "outside 0 to 1, or an absorption or a scattering that is negative or not finite");
        require(std::abs(material.scatterAnisotropy) < (material.scattersThin ? 1.0F + std::numeric_limits<float>::epsilon() : 1.0F),
                MessageId::OutOfRange, "material", i, "an anisotropy of scattering", "outside -1 to 1");
        require(isNumber(material.dispersion) && isNumber(material.iridescenceThicknessMinimum) &&
                    isNumber(material.iridescenceThicknessMaximum) && std::isfinite(material.anisotropyRotation) &&
                    std::isfinite(material.clearcoatNormalScale) && std::isfinite(material.iridescenceIor) &&
                    material.iridescenceIor >= 1.0F,
                MessageId::OutOfRange, "material", i, "a dispersion, film or rotation", "that is negative or not finite");
        for (const std::optional<Texture>& texture : material.textures) {
            require(!texture || (texture->image < scene_.images.size() && texture->uvSet <= 1), MessageId::DanglingIndex, "material", i,
                    "a texture", "without an image");
        }
    }
    require(!scene_.environment || isRadiance(scene_.environment->radiance), MessageId::OutOfRange, "environment", 0, "a radiance",
            "that is negative or not finite");
}

void SceneCheck::checkLights() const
{
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
        const PunctualLight& light = scene_.lights[i];
        require(isFinite(light.position), MessageId::OutOfRange, "light", i, "a position", "that is not finite");
        require(isUnit(light.direction), MessageId::Degenerate, "light", i, "a direction", "that is not of unit length");
        require(isRadiance(light.intensity), MessageId::OutOfRange, "light", i, "an intensity", "that is negative or not finite");
        require(light.kind != PunctualLight::Kind::Spot || light.versineInner < light.versineOuter, MessageId::OutOfRange, "light", i,
                "an inner cone", "that is not inside the outer one");
    }
}

void SceneCheck::checkCameras() const
{
    for (std::size_t i = 0; i < scene_.cameras.size(); ++i) {
        const Camera& camera = scene_.cameras[i];
        const bool perspective = camera.kind == Camera::Kind::Perspective;
        require(isFinite(camera.position), MessageId::OutOfRange, "camera", i, "a position", "that is not finite");
        require(isUnit(camera.right) && isUnit(camera.up) && isUnit(camera.forward) &&
                    glm::length(glm::cross(camera.right, camera.up) + camera.forward) <= kUnitTolerance,
                MessageId::Degenerate, "camera", i, "axes", "that are not a right-handed orthonormal frame");
        require(!perspective || (camera.yfov > 0.0F && camera.yfov < std::numbers::pi_v<float>), MessageId::OutOfRange, "camera", i,
                "a field of view", "outside 0 to pi");
        require(perspective || (camera.halfWidth != 0.0F && camera.halfHeight != 0.0F && std::isfinite(camera.halfWidth) &&
                                std::isfinite(camera.halfHeight)),
                MessageId::OutOfRange, "camera", i, "a width or height", "that is 0 or not finite");
        require(!camera.aspectRatio || (*camera.aspectRatio > 0.0F && std::isfinite(*camera.aspectRatio)), MessageId::OutOfRange, "camera",
                i, "an aspect ratio", "that is not positive and finite");
    }
}

}  // namespace

void checkScene(const Scene& scene)
{
    if (scene.instances.empty() && scene.spheres.empty() && scene.flattened == 0) {
        throw InputError(MessageId::Empty,
                         {part::file(scene.file), ": the scene has no mesh and no sphere; expected ", part::expected("at least one")});
    }
    const SceneCheck check(scene);
    check.checkMeshes();
    check.checkInstances();
    check.checkSpheres();
    check.checkMaterials();
    check.checkLights();
    check.checkCameras();
}

}  // namespace glim
