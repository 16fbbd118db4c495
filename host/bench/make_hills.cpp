#include "host/bench/make_hills.hpp"

#include <cmath>
#include <iterator>

namespace glim {
namespace {

glm::vec3 hillAt(int cells, int i, int j)
{
    const float x = 20.0F * static_cast<float>(i) / static_cast<float>(cells) - 10.0F;
    const float z = 20.0F * static_cast<float>(j) / static_cast<float>(cells) - 10.0F;
    return {x, std::sin(0.7F * x) * std::cos(0.9F * z) + 0.2F * std::sin(5.0F * x + 3.0F * z), z};
}

void addPrimitive(Scene& scene, const char* name, const std::vector<Triangle>& triangles, const Material& material)
{
    Primitive primitive;
    primitive.name = name;
    primitive.firstTriangle = static_cast<std::uint32_t>(scene.triangles.size());
    primitive.triangleCount = static_cast<std::uint32_t>(triangles.size());
    primitive.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.primitives.push_back(primitive);
    scene.materials.push_back(material);
    scene.triangles.insert(scene.triangles.end(), triangles.begin(), triangles.end());
}

std::vector<Triangle> hills(int cells)
{
    std::vector<Triangle> triangles;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const glm::vec3 a = hillAt(cells, i, j), b = hillAt(cells, i, j + 1), c = hillAt(cells, i + 1, j);
            triangles.push_back({{a, b, c}});
            triangles.push_back({{hillAt(cells, i + 1, j + 1), c, b}});
        }
    }
    return triangles;
}

}  // namespace

Scene makeHills(int cells)
{
    Scene scene;
    Material lamp, grass;
    lamp.baseColor = glm::vec3(0.0F);
    lamp.emission = glm::vec3(20.0F);
    grass.baseColor = glm::vec3(0.7F);
    const glm::vec3 a(-4, 14, -4), b(4, 14, -4), c(4, 14, 4), d(-4, 14, 4);
    addPrimitive(scene, "lamp", {{{a, b, c}}, {{a, c, d}}}, lamp);
    addPrimitive(scene, "hills", hills(cells), grass);
    scene.environment = glm::vec3(0.5F);
    Camera camera;
    camera.position = glm::vec3(-9, 6, 11);
    camera.forward = glm::normalize(glm::vec3(0, 0.5F, 0) - camera.position);
    camera.right = glm::normalize(glm::cross(camera.forward, glm::vec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, camera.forward);
    camera.yfov = 0.7F;
    scene.cameras.push_back(camera);
    return scene;
}

}  // namespace glim
