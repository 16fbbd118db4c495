#include "host/flatten/primitives.hpp"
#include "host/render/prepare_scene.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glim::test {
namespace {

using nlohmann::json;

constexpr float kTolerance = 1e-6F;

// Turns -Z to +X.
const json kQuarterTurn = {0, -std::sqrt(0.5), 0, std::sqrt(0.5)};

PunctualLight readLight(const json& light)
{
    GltfBuilder builder = oneTriangle();
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
    builder.addNode({{"name", "lamp"},
                     {"translation", {1, 2, 3}},
                     {"rotation", kQuarterTurn},
                     {"scale", {5, 5, 5}},
                     {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = load(builder);
    PunctualLight result = scene.lights.at(0);
    result.position += glm::vec3(scene.origin);
    return result;
}

TEST(GltfLights, ReadsPointLights)
{
    const PunctualLight light = readLight({{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 20}});
    EXPECT_EQ(light.kind, PunctualLight::Kind::Point);
    EXPECT_EQ(light.name, "lamp");
    EXPECT_EQ(light.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(light.intensity, glm::vec3(20, 10, 0)) << "scale does not change it";
}

TEST(GltfLights, RefusesWhatDoesNotFitAFloatWithItsValue)
{
    GltfBuilder builder = oneTriangle();
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({{{"type", "point"}, {"intensity", 1e39}}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    expectRefused(builder, MessageId::OutOfRange, {.place = "lights[0]", .value = "1e+39"});
}

TEST(GltfLights, DirectionalLightsTravelAlongTheirMinusZ)
{
    const PunctualLight light = readLight({{"type", "directional"}});
    EXPECT_EQ(light.kind, PunctualLight::Kind::Directional);
    EXPECT_LT(glm::length(light.direction - glm::vec3(1, 0, 0)), kTolerance);
    EXPECT_EQ(light.intensity, glm::vec3(1.0F));
}

// LoadOptions::sun: azimuth from -z towards +x, elevation above the horizon.
TEST(GltfLights, ASunCanBeAdded)
{
    const auto directionOf = [](double azimuth, double elevation) {
        LoadOptions options;
        options.sun = Sun{azimuth, elevation, 7.0F};
        const Scene scene = load(oneTriangle(), options);
        EXPECT_EQ(scene.lights.size(), 1U);
        EXPECT_FALSE(scene.environment) << "a sun lights the scene, so that no studio does";
        EXPECT_EQ(scene.lights.at(0).kind, PunctualLight::Kind::Directional);
        EXPECT_EQ(scene.lights.at(0).intensity, glm::vec3(7.0F));
        return scene.lights.at(0).direction;
    };
    EXPECT_LT(glm::length(directionOf(0, 0) - glm::vec3(0, 0, 1)), kTolerance);
    EXPECT_LT(glm::length(directionOf(90, 0) - glm::vec3(-1, 0, 0)), kTolerance);
    EXPECT_LT(glm::length(directionOf(45, 90) - glm::vec3(0, -1, 0)), kTolerance);
}

TEST(GltfLights, SpotConesComeAsVersines)
{
    const PunctualLight plain = readLight({{"type", "spot"}, {"spot", json::object()}});
    EXPECT_EQ(plain.kind, PunctualLight::Kind::Spot);
    EXPECT_EQ(plain.versineInner, 0.0F);
    EXPECT_FLOAT_EQ(plain.versineOuter, 1.0F - std::sqrt(0.5F)) << "pi / 4 unless told otherwise";
    const PunctualLight narrow = readLight({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
    EXPECT_FLOAT_EQ(narrow.versineInner, 1.0F - std::cos(0.25F));
    EXPECT_FLOAT_EQ(narrow.versineOuter, 1.0F - std::cos(0.5F));
    const PunctualLight beam = readLight({{"type", "spot"}, {"spot", {{"innerConeAngle", 1e-4}, {"outerConeAngle", 2e-4}}}});
    EXPECT_NEAR(beam.versineInner, 5e-9F, 1e-15F);
    EXPECT_NEAR(beam.versineOuter, 2e-8F, 4e-15F);
    EXPECT_LT(glm::length(narrow.direction - glm::vec3(1, 0, 0)), kTolerance);
}

TEST(GltfLights, ReadsTheRange)
{
    EXPECT_EQ(readLight({{"type", "point"}, {"range", 3}}).range, 3.0F) << "scale does not change it";
    EXPECT_EQ(readLight({{"type", "point"}}).range, 0.0F);
}

Scene readCamera(const json& camera, json node)
{
    GltfBuilder builder = oneTriangle();
    builder.append("cameras", camera);
    node["camera"] = 0;
    builder.addNode(node);
    return load(builder);
}

const json kPerspective = {{"type", "perspective"}, {"name", "own"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}};

TEST(GltfCameras, ReadsPerspectiveCameras)
{
    json source = kPerspective;
    const Camera bare = readCamera(source, json::object()).cameras.at(0);
    EXPECT_EQ(bare.kind, Camera::Kind::Perspective);
    EXPECT_EQ(bare.name, "own");
    EXPECT_EQ(bare.yfov, 0.5F);
    EXPECT_FALSE(bare.aspectRatio.has_value());
    source["perspective"]["aspectRatio"] = 1.25;
    const Scene scene = readCamera(source, {{"translation", {7, 8, 9}}, {"name", "node"}});
    EXPECT_EQ(scene.cameras.at(0).name, "node");
    EXPECT_EQ(scene.cameras.at(0).aspectRatio, 1.25F);
    EXPECT_EQ(scene.cameras.at(0).position + glm::vec3(scene.origin), glm::vec3(7, 8, 9));
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::FramedCamera));
}

TEST(GltfCameras, ReadsOrthographicCameras)
{
    const json source = {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 10}}}};
    const Camera camera = readCamera(source, {{"scale", {4, 4, 4}}}).cameras.at(0);
    EXPECT_EQ(camera.kind, Camera::Kind::Orthographic);
    EXPECT_EQ(camera.halfWidth, 3.0F);
    EXPECT_EQ(camera.halfHeight, 2.0F);
    EXPECT_EQ(camera.aspectRatio, 1.5F);
}

TEST(GltfCameras, AxesAreOrthonormalWhateverTheScale)
{
    for (const json& scale : {json{1, 1, 1}, json{2, 5, 0.1}, json{1, 1, -1}}) {
        const Camera camera = readCamera(kPerspective, {{"rotation", kQuarterTurn}, {"scale", scale}}).cameras.at(0);
        const float side = scale[2].get<float>() < 0.0F ? -1.0F : 1.0F;
        EXPECT_LT(glm::length(camera.forward - glm::vec3(side, 0, 0)), kTolerance);
        EXPECT_LT(glm::length(camera.up - glm::vec3(0, 1, 0)), kTolerance);
        EXPECT_LT(glm::length(glm::cross(camera.right, camera.up) + camera.forward), kTolerance);
    }
}

TEST(GltfCameras, ShearIsTakenOut)
{
    const json matrix = {1, 0, 0, 0, 0.5, 1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Camera camera = readCamera(kPerspective, {{"matrix", matrix}}).cameras.at(0);
    EXPECT_EQ(camera.forward, glm::vec3(0, 0, -1));
    EXPECT_LT(glm::length(camera.up - glm::normalize(glm::vec3(0.5, 1, 0))), kTolerance);
}

TEST(GltfCameras, ANumberIsAnIndexBeforeItIsAName)
{
    GltfBuilder builder = oneTriangle();
    builder.append("cameras", kPerspective);
    for (const char* name : {"1", "side", "7"}) {
        builder.addNode({{"camera", 0}, {"name", name}});
    }
    const Scene scene = load(builder);
    const auto said = [&scene](const std::optional<std::string>& choice) {
        testing::internal::CaptureStderr();
        sayIfCameraIsNumber(scene, choice);
        return testing::internal::GetCapturedStderr();
    };
    EXPECT_EQ(findCamera(scene, "1").name, "side");
    EXPECT_EQ(said("1"), "glim: --camera 1 is an index: the camera is \"side\", not the one named \"1\"\n");
    EXPECT_EQ(findCamera(scene, "7").name, "7");
    EXPECT_EQ(said("7"), "glim: --camera 7 is a name: the camera has the index 2\n");
    EXPECT_EQ(said("2"), "glim: --camera 2 is an index: the camera is \"7\"\n");
    EXPECT_EQ(findCamera(scene, "side").name, "side");
    EXPECT_EQ(said("side") + said(std::nullopt), "");
}

TEST(GltfCameras, FramesTheWholeBoxWhereThereIsNone)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}, {"translation", {50, 60, 70}}, {"scale", {3, 9, 1}}});
    builder.addNode({{"extras", {{"sphere", {{"radius", 2}}}}}, {"translation", {55, 60, 70}}});
    for (const float aspectRatio : {0.25F, 1.0F, 4.0F}) {
        LoadOptions options;
        options.aspectRatio = aspectRatio;
        const Scene scene = load(builder, options);
        EXPECT_TRUE(hasWarning(scene.warnings, MessageId::FramedCamera));
        const Camera& camera = scene.cameras.at(0);
        const auto isSeen = [&](const glm::vec3& point) {
            const glm::vec3 to = point - camera.position;
            const float reach = std::tan(0.5F * camera.yfov) * glm::dot(to, camera.forward);
            return std::abs(glm::dot(to, camera.up)) <= reach && std::abs(glm::dot(to, camera.right)) <= aspectRatio * reach;
        };
        const Triangle triangle = makePrimitives(scene).triangles.at(0);
        for (const glm::vec3& vertex : triangle.vertices) {
            EXPECT_TRUE(isSeen(vertex));
        }
        for (const glm::vec3& axis : {glm::vec3(2, 0, 0), glm::vec3(0, 2, 0), glm::vec3(0, 0, 2)}) {
            EXPECT_TRUE(isSeen(scene.spheres.at(0).center + axis) && isSeen(scene.spheres.at(0).center - axis));
        }
    }
}

}  // namespace
}  // namespace glim::test
