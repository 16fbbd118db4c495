#include "tests/support/build_scene.hpp"

#include "tests/support/test_meshes.hpp"

#include <cmath>

namespace glim {

std::uint32_t SceneBuilder::add(const Material& material)
{
    scene_.materials.push_back(material);
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t SceneBuilder::lambert(const glm::vec3& albedo, const glm::vec3& emission, bool doubleSided)
{
    return add(makeLambert(albedo, emission, doubleSided));
}

std::uint32_t SceneBuilder::mirror(const glm::vec3& reflectance)
{
    Material material;
    material.baseColor = reflectance;
    material.roughness = 0.0F;
    return add(material);
}

std::uint32_t SceneBuilder::glass(float ior)
{
    Material material;
    material.transmission = 1.0F;
    material.solid = true;
    material.metallic = material.roughness = 0.0F;
    material.ior = ior;
    return add(material);
}

SceneBuilder& SceneBuilder::sphere(const glm::vec3& center, float radius, std::uint32_t material)
{
    scene_.spheres.push_back({"", center, radius, material});
    return *this;
}

SceneBuilder& SceneBuilder::quad(const std::array<glm::vec3, 4>& corners, std::uint32_t material)
{
    return polygon({corners.begin(), corners.end()}, material);
}

SceneBuilder& SceneBuilder::polygon(const std::vector<glm::vec3>& corners, std::uint32_t material)
{
    Triangles fan;
    for (std::size_t i = 2; i < corners.size(); ++i) {
        fan.push_back({{corners[0], corners[i - 1], corners[i]}});
    }
    addMesh(scene_, fan, material);
    return *this;
}

SceneBuilder& SceneBuilder::cube(float half, std::uint32_t material, bool inwards)
{
    Triangles sides;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-half, half}) {
            glm::vec3 n(0.0F), u(0.0F), v(0.0F);
            n[axis] = side;
            u[(axis + 1) % 3] = half;
            v[(axis + 2) % 3] = (side > 0.0F) == inwards ? -half : half;
            const glm::vec3 a = n - u - v, b = n + u - v, c = n + u + v, d = n - u + v;
            sides.push_back({{a, b, c}});
            sides.push_back({{a, c, d}});
        }
    }
    addMesh(scene_, sides, material);
    return *this;
}

SceneBuilder& SceneBuilder::light(const PunctualLight& light)
{
    scene_.lights.push_back(light);
    return *this;
}

SceneBuilder& SceneBuilder::environment(const glm::vec3& radiance)
{
    scene_.environment.emplace().radiance = radiance;
    return *this;
}

SceneBuilder& SceneBuilder::environment(const Environment& environment)
{
    scene_.environment = environment;
    return *this;
}

void SceneBuilder::addCamera(Camera camera, const glm::vec3& position, const glm::vec3& target)
{
    camera.position = position;
    camera.forward = glm::normalize(target - position);
    const glm::vec3 up = std::abs(camera.forward.y) > 0.99F ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
    camera.right = glm::normalize(glm::cross(camera.forward, up));
    camera.up = glm::cross(camera.right, camera.forward);
    scene_.cameras.push_back(camera);
}

SceneBuilder& SceneBuilder::perspective(const glm::vec3& position, const glm::vec3& target, float yfov)
{
    Camera camera;
    camera.yfov = yfov;
    addCamera(camera, position, target);
    return *this;
}

SceneBuilder& SceneBuilder::orthographic(const glm::vec3& position, const glm::vec3& target, float halfSize)
{
    Camera camera;
    camera.kind = Camera::Kind::Orthographic;
    camera.halfWidth = camera.halfHeight = halfSize;
    addCamera(camera, position, target);
    return *this;
}

Scene mixedScene()
{
    SceneBuilder builder;
    const auto white = builder.lambert(glm::vec3(0.7F, 0.6F, 0.5F));
    const auto lamp = builder.lambert(glm::vec3(0.0F), glm::vec3(8.0F, 7.0F, 5.0F));
    builder.quad({glm::vec3(-2, -1, 2), {2, -1, 2}, {2, -1, -2}, {-2, -1, -2}}, white)
        .quad({glm::vec3(-2, -1, -2), {2, -1, -2}, {2, 2, -2}, {-2, 2, -2}}, white)
        .quad({glm::vec3(-0.5F, 1.9F, -0.5F), {0.5F, 1.9F, -0.5F}, {0.5F, 1.9F, 0.5F}, {-0.5F, 1.9F, 0.5F}}, lamp)
        .sphere({-1.1F, -0.4F, 0.0F}, 0.6F, builder.lambert(glm::vec3(0.2F, 0.5F, 0.8F)))
        .sphere({0.2F, -0.4F, -0.7F}, 0.6F, builder.mirror(glm::vec3(0.9F)))
        .sphere({1.1F, -0.4F, 0.4F}, 0.6F, builder.glass(1.5F))
        .sphere({-0.4F, -0.8F, 0.9F}, 0.15F, builder.lambert(glm::vec3(0.1F), glm::vec3(2.0F, 1.0F, 3.0F)))
        .light({"", PunctualLight::Kind::Point, {0.5F, 1.0F, 1.0F}, {0, 0, -1}, glm::vec3(1.5F)})
        .environment(glm::vec3(0.1F, 0.15F, 0.2F))
        .perspective({0.0F, 0.4F, 4.0F}, {0, 0, 0}, 0.8F);
    return builder.scene();
}

}  // namespace glim
