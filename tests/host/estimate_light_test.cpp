// What a scene's own lights show of what its camera sees, and when the built-in studio joins them.
#include "host/scene/estimate_light.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

using test::GltfBuilder;
using test::hasWarning;

// What shows a lamp whose light has an irradiance of .126: a grey of albedo .5 then has a radiance of .02.
constexpr float kJustShown = 0.04F * std::numbers::pi_v<float>;

// A floor of 2 m that fills the picture, seen from above.
class LitFloor : public SceneBuilder {
public:
    explicit LitFloor(const Material& material = makeLambert(glm::vec3(0.5F)))
    {
        quad({glm::vec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}}, add(material));
        orthographic({0, 5, 0}, {0, 0, 0}, 1.0F);
    }

    double share() const { return estimateLitShare(scene(), scene().cameras.front()); }
};

PunctualLight pointAbove(float height, float intensity)
{
    PunctualLight light;
    light.position = {0, height, 0};
    light.intensity = glm::vec3(intensity);
    return light;
}

// The circle in which a point light is bright enough has an area that a formula gives.
TEST(EstimateLight, PointLightsReachAsFarAsTheirLight)
{
    for (const float radius : {0.3F, 0.6F, 0.9F}) {
        LitFloor floor;
        floor.light(pointAbove(1.0F, kJustShown * (1.0F + radius * radius)));
        EXPECT_NEAR(floor.share(), 0.25 * std::numbers::pi * static_cast<double>(radius * radius), 0.02) << radius;
    }
    LitFloor several;
    for (int i = 0; i < 8; ++i) {
        several.light(pointAbove(1.0F, kJustShown * 1.25F / 8.0F));
    }
    EXPECT_NEAR(several.share(), 0.25 * std::numbers::pi * 0.25, 0.02) << "lights add up";
    LitFloor many;
    for (int i = 0; i < 9000; ++i) {
        many.light(pointAbove(1.0F, kJustShown * 1.25F / 9000.0F));
    }
    EXPECT_NEAR(many.share(), 0.25 * std::numbers::pi * 0.25, 0.02) << "every third stands for three";
}

TEST(EstimateLight, ConesAndRangesEnd)
{
    PunctualLight spot = pointAbove(1.0F, 100.0F);
    spot.kind = PunctualLight::Kind::Spot;
    spot.direction = {0, -1, 0};
    spot.versineOuter = 1.0F - 1.0F / std::hypot(1.0F, 0.5F);
    PunctualLight ranged = pointAbove(1.0F, 100.0F);
    ranged.range = std::hypot(1.0F, 0.5F);
    for (const PunctualLight& light : {spot, ranged}) {
        LitFloor floor;
        floor.light(light);
        EXPECT_NEAR(floor.share(), 0.25 * std::numbers::pi * 0.25, 0.02);
    }
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::Directional;
    for (const float irradiance : {0.9F * kJustShown, 1.1F * kJustShown}) {
        LitFloor floor;
        sun.intensity = glm::vec3(irradiance);
        floor.light(sun);
        EXPECT_EQ(floor.share(), irradiance > kJustShown ? 1.0 : 0.0);
    }
}

// A small lamp of radiance L and area A is a light of intensity L A cos. So it reaches as far, and only where its front is.
TEST(EstimateLight, LampsLightWhereTheirFrontIs)
{
    for (const bool downwards : {true, false}) {
        for (const bool doubleSided : {false, true}) {
            LitFloor floor;
            const float s = downwards ? 0.01F : -0.01F;
            const auto lamp = floor.add(makeLambert(glm::vec3(0.0F), glm::vec3(kJustShown * 1.25F * 1.118F / 4e-4F), doubleSided));
            floor.quad({glm::vec3(-s, 1, -0.01F), {s, 1, -0.01F}, {s, 1, 0.01F}, {-s, 1, 0.01F}}, lamp);
            EXPECT_NEAR(floor.share(), downwards || doubleSided ? 0.25 * std::numbers::pi * 0.25 : 0.0, 0.02);
        }
    }
    LitFloor ball;
    ball.sphere({0, 1, 0}, 0.01F, ball.lambert(glm::vec3(0.0F), glm::vec3(kJustShown * 1.25F / (std::numbers::pi_v<float> * 1e-4F))));
    EXPECT_NEAR(ball.share(), 0.25 * std::numbers::pi * 0.25, 0.02);
    LitFloor fine;  // 20,480 triangles, of which 256 points stand for all
    const auto lamp = fine.lambert(glm::vec3(0.0F), glm::vec3(kJustShown * 1.25F / (std::numbers::pi_v<float> * 1e-4F)));
    Scene scene = fine.scene();
    Triangles sphere = icosphere(5);
    for (auto& triangle : sphere) {
        for (glm::vec3& vertex : triangle.vertices) {
            vertex = 0.01F * vertex + glm::vec3(0, 1, 0);
        }
    }
    addMesh(scene, sphere, lamp);
    EXPECT_NEAR(estimateLitShare(scene, scene.cameras.front()), 0.25 * std::numbers::pi * 0.25, 0.03);
}

TEST(EstimateLight, MirrorsAndGlassAreDarkUnderLamps)
{
    Material mirror = makeLambert(glm::vec3(1.0F)), rough = mirror, glass = makeLambert(glm::vec3(1.0F));
    mirror.metallic = rough.metallic = 1.0F;
    mirror.roughness = glass.roughness = 0.1F;
    rough.roughness = 0.6F;
    glass.transmission = 1.0F;
    for (const auto& [material, share] : {std::pair(mirror, 0.0), std::pair(rough, 1.0), std::pair(glass, 0.0)}) {
        LitFloor floor(material);
        floor.light(pointAbove(1.0F, 100.0F));
        EXPECT_EQ(floor.share(), share) << material.roughness;
    }
}

// Neither lit nor dark: what shines by itself. Back faces are not there.
TEST(EstimateLight, OnlySurfacesThatWaitForLightCount)
{
    Material unlit = makeLambert(glm::vec3(0.5F)), shining = makeLambert(glm::vec3(0.5F), glm::vec3(1.0F));
    unlit.unlit = true;
    for (const Material& material : {unlit, shining}) {
        EXPECT_EQ(LitFloor(material).share(), 1.0);
        LitFloor half;
        half.quad({glm::vec3(-1, 1, 1), {0, 1, 1}, {0, 1, -1}, {-1, 1, -1}}, half.add(material));
        EXPECT_EQ(half.share(), 0.0) << "the other half is dark";
    }
    LitFloor under;
    under.quad({glm::vec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, under.add(unlit));
    EXPECT_EQ(under.share(), 0.0) << "the floor is seen through a back face";
    EXPECT_EQ(estimateLitShare(SceneBuilder().orthographic({0, 5, 0}, {0, 0, 0}, 1.0F).scene(), under.scene().cameras.front()), 1.0);
}

// A ball on the left under a lamp, and a ball on the right in the dark, beside which a plane passes through the camera.
TEST(EstimateLight, PerspectiveCamerasSeeWhatIsBeforeThem)
{
    SceneBuilder builder;
    const auto grey = builder.lambert(glm::vec3(0.5F), glm::vec3(0.0F), true);
    builder.sphere({-1, 0, 0}, 0.5F, grey).sphere({1, 0, 0}, 0.5F, grey).perspective({0, 0, 5}, {0, 0, 0}, 0.7F);
    PunctualLight light = pointAbove(0.0F, 100.0F);
    light.position = {-1, 1, 0};
    light.range = 1.6F;
    builder.light(light);
    EXPECT_NEAR(estimateLitShare(builder.scene(), builder.scene().cameras.front()), 0.5, 0.02);
    builder.quad({glm::vec3(-50, -1, 50), {50, -1, 50}, {50, -1, -50}, {-50, -1, -50}}, grey);
    builder.sphere({0, 0, 9}, 1.0F, grey);  // behind
    const double withFloor = estimateLitShare(builder.scene(), builder.scene().cameras.front());
    EXPECT_GT(withFloor, 0.02);
    EXPECT_LT(withFloor, 0.3);
}

// --- in files ---

// A triangle of a material, and a light of this intensity before it.
GltfBuilder triangleBefore(double intensity, nlohmann::json material = nlohmann::json::object())
{
    GltfBuilder builder;
    const std::size_t mesh = builder.addTriangleMesh();
    if (!material.contains("pbrMetallicRoughness")) {
        material["pbrMetallicRoughness"] = {{"metallicFactor", 0}};
    }
    builder.document["meshes"][mesh]["primitives"][0]["material"] = builder.append("materials", material);
    builder.addNode({{"mesh", mesh}});
    if (intensity > 0.0) {
        builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
        builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", intensity}}};
        builder.addNode({{"translation", {0, 0, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    }
    return builder;
}

bool isByStudio(const Scene& scene) { return scene.environment && scene.environment->source == "studio"; }

Scene loadFile(const GltfBuilder& builder, const LoadOptions& options = {}) { return test::load(builder, options); }

TEST(EstimateLight, TheStudioJoinsWeakLightsOnly)
{
    const Scene weak = loadFile(triangleBefore(0.01)), strong = loadFile(triangleBefore(10.0));
    EXPECT_TRUE(isByStudio(weak));
    EXPECT_EQ(weak.lights.size(), 1U) << "it joins them";
    EXPECT_TRUE(hasWarning(weak.warnings, MessageId::StudioLight));
    EXPECT_FALSE(strong.environment);
    EXPECT_FALSE(hasWarning(strong.warnings, MessageId::StudioLight));
    LoadOptions chosen;
    chosen.environment = BuiltInEnvironment::None;
    EXPECT_FALSE(loadFile(triangleBefore(0.01), chosen).environment);
    chosen.environment = BuiltInEnvironment::Studio;
    EXPECT_TRUE(isByStudio(loadFile(triangleBefore(10.0), chosen)));
    LoadOptions sunny;
    sunny.sun = Sun{0.0, 45.0, 1e-3F};
    EXPECT_FALSE(loadFile(triangleBefore(0.0), sunny).environment);
}

TEST(EstimateLight, EmissionWithoutAStrengthIsOfDisplays)
{
    nlohmann::json material = {{"emissiveFactor", {1, 1, 1}}};
    EXPECT_TRUE(isByStudio(loadFile(triangleBefore(0.0, material))));
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 1.0;
    GltfBuilder lamp = triangleBefore(0.0, material);
    lamp.document["extensionsUsed"] = {"KHR_materials_emissive_strength"};
    EXPECT_FALSE(loadFile(lamp).environment) << "nothing waits for light";
    lamp.addNode({{"mesh", 0}, {"translation", {3, 0, 0}}});
    EXPECT_FALSE(loadFile(lamp).environment);
}

// The light goes out during the animation; all frames have the light of the rest pose.
TEST(EstimateLight, FramesOfAnAnimationHaveOneLight)
{
    for (const double intensity : {0.01, 10.0}) {
        GltfBuilder builder = triangleBefore(intensity);
        const std::size_t times = builder.addAccessor(test::toBytes<float>({0, 1}), test::kFloat, "SCALAR", 2);
        builder.document["accessors"][times]["min"] = {0};
        builder.document["accessors"][times]["max"] = {1};
        const std::size_t places = builder.addVec3({0, 0, intensity < 1.0 ? 0.1F : 500.0F, 0, 0, intensity < 1.0 ? 0.1F : 500.0F});
        builder.append("animations", {{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}},
                                      {"samplers", {{{"input", times}, {"output", places}}}}});
        LoadOptions options;
        options.at = 0.5;
        const Scene posed = loadFile(builder, options);
        EXPECT_EQ(posed.lights[0].position.z > 100.0F, intensity > 1.0) << "the animation is played";
        EXPECT_EQ(isByStudio(posed), intensity < 1.0);
    }
}

}  // namespace
}  // namespace glim
