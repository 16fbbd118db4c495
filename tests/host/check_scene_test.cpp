// Each invariant of Scene is broken in turn.
#include "host/scene/check_scene.hpp"
#include "host/error.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace glim {
namespace {

Scene makeScene()
{
    Scene scene;
    scene.file = "made.gltf";
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    mesh.indices = {0, 1, 2};
    scene.meshes = std::vector<Mesh>{mesh, mesh};
    scene.instances = {{"a", 0}, {"b", 1}};
    scene.spheres.resize(1);
    scene.materials.resize(1);
    scene.lights.resize(1);
    scene.cameras.resize(1);
    scene.environment.emplace();
    return scene;
}

struct Breakage {
    MessageId id;
    const char *place, *value;
    std::function<void(Scene&)> apply;
};

TEST(CheckScene, AcceptsASoundScene) { EXPECT_NO_THROW(checkScene(makeScene())); }

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

const Breakage kBreakages[] = {
    {MessageId::OutOfRange, "mesh 1", "a position", [](Scene& s) { s.meshes.change()[1].positions[2].y = kNan; }},
    {MessageId::Mismatch, "mesh 0", "an attribute", [](Scene& s) { s.meshes.change()[0].normals.pop_back(); }},
    {MessageId::Mismatch, "mesh 0", "an attribute", [](Scene& s) { s.meshes.change()[0].uv0.resize(1); }},
    {MessageId::Mismatch, "mesh 1", "an attribute", [](Scene& s) { s.meshes.change()[1].uv1.resize(4); }},
    {MessageId::Mismatch, "mesh 1", "an attribute", [](Scene& s) { s.meshes.change()[1].tangents.resize(2); }},
    {MessageId::Mismatch, "mesh 1", "an attribute", [](Scene& s) { s.meshes.change()[1].colors.resize(2); }},
    {MessageId::Mismatch, "mesh 1", "a triangle", [](Scene& s) { s.meshes.change()[1].indices.push_back(0); }},
    {MessageId::DanglingIndex, "mesh 1", "a triangle", [](Scene& s) { s.meshes.change()[1].indices[1] = 3; }},
    {MessageId::DanglingIndex, "mesh 0", "a material", [](Scene& s) { s.meshes.change()[0].material = 1; }},
    {MessageId::DanglingIndex, "instance 1", "a mesh", [](Scene& s) { s.instances[1].mesh = 2; }},
    {MessageId::OutOfRange, "instance 0", "a transform", [](Scene& s) { s.instances[0].worldFromMesh[3].x = kInfinity; }},
    {MessageId::Degenerate, "instance 0", "a transform", [](Scene& s) { s.instances[0].worldFromMesh[1].w = 1.0; }},
    {MessageId::Degenerate, "instance 0", "a transform", [](Scene& s) { s.instances[0].worldFromMesh[1].y = 0.0; }},
    {MessageId::Mismatch, "mesh 1", "points", [](Scene& s) { s.meshes.change()[1].isCloud = true; }},
    {MessageId::OutOfRange, "instance 1", "points",
     [](Scene& s) {
         s.meshes.change()[1].indices.clear();
         s.meshes.change()[1].isCloud = true;
         s.pointRadius = 1e300;
     }},
    {MessageId::OutOfRange, "sphere 0", "a centre", [](Scene& s) { s.spheres[0].center.x = kInfinity; }},
    {MessageId::OutOfRange, "sphere 0", "a radius", [](Scene& s) { s.spheres[0].radius = -1; }},
    {MessageId::DanglingIndex, "sphere 0", "a material", [](Scene& s) { s.spheres[0].material = 9; }},
    {MessageId::OutOfRange, "material 0", "a base colour", [](Scene& s) { s.materials[0].baseColor.x = 1.5F; }},
    {MessageId::OutOfRange, "material 0", "an emission", [](Scene& s) { s.materials[0].emission.x = kInfinity; }},
    {MessageId::OutOfRange, "material 0", "an index of refraction", [](Scene& s) { s.materials[0].ior = 0.9F; }},
    {MessageId::Degenerate, "light 0", "a direction",
     [](Scene& s) {
         s.lights[0].direction = {0, 0, -2};
     }},
    {MessageId::OutOfRange, "light 0", "an intensity", [](Scene& s) { s.lights[0].intensity.z = -1; }},
    {MessageId::OutOfRange, "light 0", "a position", [](Scene& s) { s.lights[0].position.z = kNan; }},
    {MessageId::OutOfRange, "light 0", "an inner cone",
     [](Scene& s) {
         s.lights[0].kind = PunctualLight::Kind::Spot;
         s.lights[0].versineInner = 1.5F;
     }},
    {MessageId::Degenerate, "camera 0", "axes",
     [](Scene& s) {
         s.cameras[0].right = {-1, 0, 0};
     }},
    {MessageId::Degenerate, "camera 0", "axes",
     [](Scene& s) {
         s.cameras[0].up = {0, 0, 1};
     }},
    {MessageId::OutOfRange, "camera 0", "a position", [](Scene& s) { s.cameras[0].position.x = kNan; }},
    {MessageId::OutOfRange, "camera 0", "a field of view", [](Scene& s) { s.cameras[0].yfov = 4; }},
    {MessageId::OutOfRange, "camera 0", "a width or height",
     [](Scene& s) {
         s.cameras[0].kind = Camera::Kind::Orthographic;
         s.cameras[0].halfHeight = 0;
     }},
    {MessageId::OutOfRange, "camera 0", "an aspect ratio", [](Scene& s) { s.cameras[0].aspectRatio = 0.0F; }},
    {MessageId::OutOfRange, "environment 0", "a radiance", [](Scene& s) { s.environment->radiance = glm::vec3(-1.0F); }},
    {MessageId::Empty, "", "",
     [](Scene& s) {
         s = Scene();
         s.file = "made.gltf";
     }},
};

TEST(CheckScene, RefusesEachBrokenInvariant)
{
    for (const Breakage& breakage : kBreakages) {
        Scene scene = makeScene();
        breakage.apply(scene);
        test::expectRefusal<InputError>([&] { checkScene(scene); }, breakage.id,
                                        {.file = "made.gltf", .place = breakage.place, .value = breakage.value});
    }
}

}  // namespace
}  // namespace glim
