#include "host/scene/check_scene.hpp"

#include "host/error.hpp"

#include <cmath>

namespace glim {
namespace {

// Length and right angles of float32 unit vectors that were rounded from double, or came from a file as floats.
constexpr float kUnitTolerance = 1e-4F;

constexpr float kPi = 3.14159265F;

bool isFinite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isUnit(const glm::vec3& v)
{
    return std::abs(glm::dot(v, v) - 1.0F) <= kUnitTolerance;
}

bool isRadiance(const glm::vec3& v)
{
    return isFinite(v) && v.x >= 0.0F && v.y >= 0.0F && v.z >= 0.0F;
}

bool isReflectance(const glm::vec3& v)
{
    return isRadiance(v) && v.x <= 1.0F && v.y <= 1.0F && v.z <= 1.0F;
}

class SceneCheck {
public:
    explicit SceneCheck(const Scene& scene) : m_scene(scene) {}

    void checkTriangles() const;
    void checkPrimitives() const;
    void checkSpheres() const;
    void checkMaterials() const;
    void checkLights() const;
    void checkCameras() const;
    void require(bool holds, const char* kind, std::size_t index, const char* what) const
    {
        if (!holds) {
            throw InputError(m_scene.file + ": " + kind + " " + std::to_string(index) + " " + what);
        }
    }

private:
    const Scene& m_scene;
};

void SceneCheck::checkTriangles() const
{
    for (std::size_t i = 0; i < m_scene.triangles.size(); ++i) {
        for (const glm::vec3& vertex : m_scene.triangles[i].vertices) {
            require(isFinite(vertex), "triangle", i, "has a vertex that is not finite");
        }
    }
    if (!m_scene.normals.empty() && m_scene.normals.size() != m_scene.triangles.size()) {
        throw InputError(m_scene.file + ": " + std::to_string(m_scene.normals.size()) + " triangles have normals; " +
                         "expected none or all " + std::to_string(m_scene.triangles.size()));
    }
}

void SceneCheck::checkPrimitives() const
{
    std::size_t next = 0;
    for (std::size_t i = 0; i < m_scene.primitives.size(); ++i) {
        const Primitive& primitive = m_scene.primitives[i];
        require(primitive.firstTriangle == next && primitive.triangleCount > 0, "primitive", i,
                "does not begin where the one before ends; expected primitives that tile the triangles");
        next += primitive.triangleCount;
        require(next <= m_scene.triangles.size(), "primitive", i, "ends after the last triangle");
        require(primitive.material < m_scene.materials.size(), "primitive", i, "has a material that does not exist");
        require(!primitive.smooth || !m_scene.normals.empty(), "primitive", i, "is smooth without normals");
        for (std::size_t t = primitive.firstTriangle; primitive.smooth && t < next; ++t) {
            for (const glm::vec3& normal : m_scene.normals[t].normals) {
                require(isUnit(normal), "triangle", t, "has a normal that is not of unit length");
            }
        }
    }
    require(next == m_scene.triangles.size(), "triangle", next, "belongs to no primitive");
}

void SceneCheck::checkSpheres() const
{
    for (std::size_t i = 0; i < m_scene.spheres.size(); ++i) {
        const Sphere& sphere = m_scene.spheres[i];
        require(isFinite(sphere.center), "sphere", i, "has a centre that is not finite");
        require(std::isfinite(sphere.radius) && sphere.radius >= 0.0F, "sphere", i,
                "has a radius that is negative or not finite");
        require(sphere.material < m_scene.materials.size(), "sphere", i, "has a material that does not exist");
    }
}

void SceneCheck::checkMaterials() const
{
    for (std::size_t i = 0; i < m_scene.materials.size(); ++i) {
        const Material& material = m_scene.materials[i];
        require(isReflectance(material.baseColor), "material", i, "has a base colour outside 0 to 1");
        require(isRadiance(material.emission), "material", i, "has an emission that is negative or not finite");
        require(std::isfinite(material.ior) && material.ior >= 1.0F, "material", i,
                "has an index of refraction below 1 or not finite");
    }
    require(!m_scene.environment || isRadiance(*m_scene.environment), "environment", 0,
            "has a radiance that is negative or not finite");
}

void SceneCheck::checkLights() const
{
    for (std::size_t i = 0; i < m_scene.lights.size(); ++i) {
        const PunctualLight& light = m_scene.lights[i];
        require(isFinite(light.position), "light", i, "has a position that is not finite");
        require(isUnit(light.direction), "light", i, "has a direction that is not of unit length");
        require(isRadiance(light.intensity), "light", i, "has an intensity that is negative or not finite");
        require(light.kind != PunctualLight::Kind::Spot || light.cosInner > light.cosOuter, "light", i,
                "has an inner cone that is not inside the outer one");
    }
}

void SceneCheck::checkCameras() const
{
    for (std::size_t i = 0; i < m_scene.cameras.size(); ++i) {
        const Camera& camera = m_scene.cameras[i];
        const bool perspective = camera.kind == Camera::Kind::Perspective;
        require(isFinite(camera.position), "camera", i, "has a position that is not finite");
        require(isUnit(camera.right) && isUnit(camera.up) && isUnit(camera.forward) &&
                    glm::length(glm::cross(camera.right, camera.up) + camera.forward) <= kUnitTolerance,
                "camera", i, "has axes that are not a right-handed orthonormal frame");
        require(!perspective || (camera.yfov > 0.0F && camera.yfov < kPi), "camera", i,
                "has a field of view outside 0 to pi");
        require(perspective || (camera.halfWidth > 0.0F && camera.halfHeight > 0.0F &&
                                std::isfinite(camera.halfWidth) && std::isfinite(camera.halfHeight)),
                "camera", i, "has a width or height that is not positive and finite");
        require(!camera.aspectRatio || (*camera.aspectRatio > 0.0F && std::isfinite(*camera.aspectRatio)), "camera", i,
                "has an aspect ratio that is not positive and finite");
    }
}

}  // namespace

void checkScene(const Scene& scene)
{
    if (scene.triangles.empty() && scene.spheres.empty()) {
        throw InputError(scene.file + ": the scene has no triangle and no sphere; expected at least one");
    }
    const SceneCheck check(scene);
    check.checkTriangles();
    check.checkPrimitives();
    check.checkSpheres();
    check.checkMaterials();
    check.checkLights();
    check.checkCameras();
}

}  // namespace glim
