// Each invariant of Scene is broken in turn.
#include "host/error.hpp"
#include "host/scene/check_scene.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace glim {
namespace {

Scene makeScene()
{
    Scene scene;
    scene.file = "made.gltf";
    scene.triangles = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}}};
    scene.normals = {{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}}, {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}}};
    scene.primitives = {{"a", 0, 1, 0, false}, {"b", 1, 1, 0, true}};
    scene.spheres.resize(1);
    scene.materials.resize(1);
    scene.lights.resize(1);
    scene.cameras.resize(1);
    scene.environment = glm::vec3(1.0F);
    return scene;
}

struct Breakage {
    const char* sentence;
    std::function<void(Scene&)> apply;
};

TEST(CheckScene, AcceptsASoundScene)
{
    EXPECT_NO_THROW(checkScene(makeScene()));
}

const float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

const Breakage kBreakages[] = {
    {"triangle 1 has a vertex that is not finite", [](Scene& s) { s.triangles[1].vertices[2].y = kNan; }},
    {"1 triangles have normals; expected none or all 2", [](Scene& s) { s.normals.pop_back(); }},
    {"primitive 1 does not begin", [](Scene& s) { s.primitives[1].firstTriangle = 0; }},
    {"primitive 1 ends after", [](Scene& s) { s.primitives[1].triangleCount = 2; }},
    {"triangle 1 belongs to no primitive", [](Scene& s) { s.primitives.pop_back(); }},
    {"primitive 0 has a material", [](Scene& s) { s.primitives[0].material = 1; }},
    {"primitive 1 is smooth", [](Scene& s) { s.normals.clear(); }},
    {"triangle 1 has a normal", [](Scene& s) { s.normals[1].normals[0] = {0, 0, 2}; }},
    {"triangle 1 has a normal", [](Scene& s) { s.normals[1].normals[2] = {0, kNan, 1}; }},
    {"sphere 0 has a centre", [](Scene& s) { s.spheres[0].center.x = kInfinity; }},
    {"sphere 0 has a radius", [](Scene& s) { s.spheres[0].radius = -1; }},
    {"sphere 0 has a material", [](Scene& s) { s.spheres[0].material = 9; }},
    {"material 0 has a base colour", [](Scene& s) { s.materials[0].baseColor.x = 1.5F; }},
    {"material 0 has an emission", [](Scene& s) { s.materials[0].emission.x = kInfinity; }},
    {"material 0 has an index", [](Scene& s) { s.materials[0].ior = 0.9F; }},
    {"light 0 has a direction", [](Scene& s) { s.lights[0].direction = {0, 0, -2}; }},
    {"light 0 has an intensity", [](Scene& s) { s.lights[0].intensity.z = -1; }},
    {"light 0 has a position", [](Scene& s) { s.lights[0].position.z = kNan; }},
    {"light 0 has an inner cone",
     [](Scene& s) {
         s.lights[0].kind = PunctualLight::Kind::Spot;
         s.lights[0].cosInner = -0.5F;
     }},
    {"camera 0 has axes", [](Scene& s) { s.cameras[0].right = {-1, 0, 0}; }},
    {"camera 0 has axes", [](Scene& s) { s.cameras[0].up = {0, 0, 1}; }},
    {"camera 0 has a position", [](Scene& s) { s.cameras[0].position.x = kNan; }},
    {"camera 0 has a field of view", [](Scene& s) { s.cameras[0].yfov = 4; }},
    {"camera 0 has a width",
     [](Scene& s) {
         s.cameras[0].kind = Camera::Kind::Orthographic;
         s.cameras[0].halfHeight = 0;
     }},
    {"camera 0 has an aspect ratio", [](Scene& s) { s.cameras[0].aspectRatio = 0.0F; }},
    {"environment 0 has a radiance", [](Scene& s) { s.environment = glm::vec3(-1.0F); }},
    {"no triangle and no sphere",
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
