#include "host/bench/make_hills.hpp"

#include <cmath>
#include <utility>

namespace glim {
namespace {

glm::vec3 hillAt(int cells, int i, int j)
{
    const float x = 20.0F * static_cast<float>(i) / static_cast<float>(cells) - 10.0F;
    const float z = 20.0F * static_cast<float>(j) / static_cast<float>(cells) - 10.0F;
    return {x, std::sin(0.7F * x) * std::cos(0.9F * z) + 0.2F * std::sin(5.0F * x + 3.0F * z), z};
}

void addMesh(Scene& scene, const char* name, Mesh mesh, const Material& material)
{
    mesh.name = name;
    mesh.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.instances.push_back({name, static_cast<std::uint32_t>(scene.meshes.size())});
    scene.meshes.change().push_back(std::move(mesh));
    scene.materials.push_back(material);
}

Mesh hills(int cells)
{
    Mesh mesh;
    for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
            mesh.positions.emplace_back(hillAt(cells, i, j));
        }
    }
    const auto vertex = [cells](int i, int j) { return static_cast<std::uint32_t>(i * (cells + 1) + j); };
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const std::uint32_t a = vertex(i, j), b = vertex(i, j + 1), c = vertex(i + 1, j), d = vertex(i + 1, j + 1);
            mesh.indices.insert(mesh.indices.end(), {a, b, c, d, c, b});
        }
    }
    return mesh;
}

}  // namespace

Scene makeHills(int cells)
{
    Scene scene;
    const Material lamp = makeLambert(glm::vec3(0.0F), glm::vec3(20.0F)), grass = makeLambert(glm::vec3(0.7F));
    Mesh square;
    square.positions = {{-4, 14, -4}, {4, 14, -4}, {4, 14, 4}, {-4, 14, 4}};
    square.indices = {0, 1, 2, 0, 2, 3};
    addMesh(scene, "lamp", std::move(square), lamp);
    addMesh(scene, "hills", hills(cells), grass);
    scene.environment.emplace().radiance = glm::vec3(0.5F);
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
