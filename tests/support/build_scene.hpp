// Scenes made of a few parts, for tests that know the answer.
#pragma once

#include "host/scene/scene.hpp"

#include <array>

namespace glim {

class SceneBuilder {
public:
    // Each returns the index of the material.
    std::uint32_t add(const Material& material);
    std::uint32_t lambert(const glm::vec3& albedo, const glm::vec3& emission = glm::vec3(0.0F), bool doubleSided = false);
    std::uint32_t mirror(const glm::vec3& reflectance);
    std::uint32_t glass(float ior);

    SceneBuilder& sphere(const glm::vec3& center, float radius, std::uint32_t material);
    // Two triangles; counter-clockwise corners seen from the front. One mesh, so one light if it emits.
    SceneBuilder& quad(const std::array<glm::vec3, 4>& corners, std::uint32_t material);
    // A convex polygon as a fan.
    SceneBuilder& polygon(const std::vector<glm::vec3>& corners, std::uint32_t material);
    // The cube [-half, half]^3 as one mesh, fronts inwards or outwards.
    SceneBuilder& cube(float half, std::uint32_t material, bool inwards);
    SceneBuilder& light(const PunctualLight& light);
    SceneBuilder& environment(const glm::vec3& radiance);
    SceneBuilder& environment(const Environment& environment);
    // Looks from `position` at `target`; up is +y, or -z when looking along y.
    SceneBuilder& perspective(const glm::vec3& position, const glm::vec3& target, float yfov);
    SceneBuilder& orthographic(const glm::vec3& position, const glm::vec3& target, float halfSize);

    const Scene& scene() const { return scene_; }

private:
    void addCamera(Camera camera, const glm::vec3& position, const glm::vec3& target);

    Scene scene_;
};

// A scene for tests that need any scene: a box with a quad light, a Lambert, a mirror and a glass sphere, a point light and an
// environment, so that every path through the kernels runs.
Scene mixedScene();

}  // namespace glim
