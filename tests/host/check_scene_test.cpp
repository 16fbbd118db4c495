// Each invariant of Scene is broken in turn.
#include "host/scene/check_scene.hpp"
#include "host/error.hpp"

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
    const char* sentence;
    std::function<void(Scene&)> apply;
};

TEST(CheckScene, AcceptsASoundScene) { EXPECT_NO_THROW(checkScene(makeScene())); }

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

const Breakage kBreakages[] = {
    {"mesh 1 has a position that is not finite", [](Scene& s) { s.meshes.change()[1].positions[2].y = kNan; }},
    {"mesh 0 has an attribute", [](Scene& s) { s.meshes.change()[0].normals.pop_back(); }},
    {"mesh 0 has an attribute", [](Scene& s) { s.meshes.change()[0].uv0.resize(1); }},
    {"mesh 1 has an attribute", [](Scene& s) { s.meshes.change()[1].uv1.resize(4); }},
    {"mesh 1 has an attribute", [](Scene& s) { s.meshes.change()[1].tangents.resize(2); }},
    {"mesh 1 has an attribute", [](Scene& s) { s.meshes.change()[1].colors.resize(2); }},
    {"mesh 1 has a triangle with fewer", [](Scene& s) { s.meshes.change()[1].indices.push_back(0); }},
    {"mesh 1 has a triangle with a vertex", [](Scene& s) { s.meshes.change()[1].indices[1] = 3; }},
    {"mesh 0 has a material", [](Scene& s) { s.meshes.change()[0].material = 1; }},
    {"instance 1 is of a mesh", [](Scene& s) { s.instances[1].mesh = 2; }},
    {"instance 0 has a transform that is not finite", [](Scene& s) { s.instances[0].worldFromMesh[3].x = kInfinity; }},
    {"instance 0 has a transform that is not affine", [](Scene& s) { s.instances[0].worldFromMesh[1].w = 1.0; }},
    {"instance 0 has a transform that is not affine", [](Scene& s) { s.instances[0].worldFromMesh[1].y = 0.0; }},
    {"sphere 0 has a centre", [](Scene& s) { s.spheres[0].center.x = kInfinity; }},
    {"sphere 0 has a radius", [](Scene& s) { s.spheres[0].radius = -1; }},
    {"sphere 0 has a material", [](Scene& s) { s.spheres[0].material = 9; }},
    {"material 0 has a base colour", [](Scene& s) { s.materials[0].baseColor.x = 1.5F; }},
    {"material 0 has an emission", [](Scene& s) { s.materials[0].emission.x = kInfinity; }},
    {"material 0 has an index", [](Scene& s) { s.materials[0].ior = 0.9F; }},
    {"light 0 has a direction",
     [](Scene& s) {
         s.lights[0].direction = {0, 0, -2};
     }},
    {"light 0 has an intensity", [](Scene& s) { s.lights[0].intensity.z = -1; }},
    {"light 0 has a position", [](Scene& s) { s.lights[0].position.z = kNan; }},
    {"light 0 has an inner cone",
     [](Scene& s) {
         s.lights[0].kind = PunctualLight::Kind::Spot;
         s.lights[0].versineInner = 1.5F;
     }},
    {"camera 0 has axes",
     [](Scene& s) {
         s.cameras[0].right = {-1, 0, 0};
     }},
    {"camera 0 has axes",
     [](Scene& s) {
         s.cameras[0].up = {0, 0, 1};
     }},
    {"camera 0 has a position", [](Scene& s) { s.cameras[0].position.x = kNan; }},
    {"camera 0 has a field of view", [](Scene& s) { s.cameras[0].yfov = 4; }},
    {"camera 0 has a width",
     [](Scene& s) {
         s.cameras[0].kind = Camera::Kind::Orthographic;
         s.cameras[0].halfHeight = 0;
     }},
    {"camera 0 has an aspect ratio", [](Scene& s) { s.cameras[0].aspectRatio = 0.0F; }},
    {"environment 0 has a radiance", [](Scene& s) { s.environment->radiance = glm::vec3(-1.0F); }},
    {"no mesh and no sphere",
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
        try {
            checkScene(scene);
            ADD_FAILURE() << "not refused: " << breakage.sentence;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(breakage.sentence), std::string::npos) << error.what();
            EXPECT_EQ(std::string(error.what()).rfind("made.gltf: ", 0), 0U) << error.what();
        }
    }
}

}  // namespace
}  // namespace glim
