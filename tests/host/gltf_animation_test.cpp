// Animations of files: what LoadOptions::at makes of the properties that they point to, worked out on paper.
#include "host/flatten/flatten_scene.hpp"
#include "host/render/prepare_scene.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace glim::test {
namespace {

using nlohmann::json;

constexpr double kTolerance = 1e-14;
constexpr float kFloatTolerance = 1e-6F;
const float kHalf = std::sqrt(0.5F);

// Animations of a triangle at node 0.
struct AnimatedTriangle : GltfBuilder {
    AnimatedTriangle()
    {
        addNode({{"mesh", addTriangleMesh()}});
        addAnimation("first");
    }

    void addAnimation(const std::string& name)
    {
        append("animations", {{"name", name}, {"samplers", json::array()}, {"channels", json::array()}});
    }

    // To the last animation. `type` is that of the values.
    void addChannel(const json& target, const std::vector<float>& times, const std::vector<float>& values, const char* type,
                    const char* interpolation = "LINEAR")
    {
        const std::size_t width = std::string(type) == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
        connect(target, times, addAccessor(toBytes(values), kFloat, type, values.size() / width), interpolation);
    }

    void connect(const json& target, const std::vector<float>& times, std::size_t values, const char* interpolation)
    {
        json& animation = document["animations"].back();
        const std::size_t input = addAccessor(toBytes(times), kFloat, "SCALAR", times.size());
        animation["channels"].push_back({{"sampler", animation["samplers"].size()}, {"target", target}});
        animation["samplers"].push_back({{"input", input}, {"output", values}, {"interpolation", interpolation}});
    }
};

json nodeTarget(const char* path) { return {{"node", 0}, {"path", path}}; }

json pointerTarget(const std::string& pointer)
{
    return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

Scene loadAt(const GltfBuilder& builder, double seconds, const std::string& animation = "")
{
    LoadOptions options;
    options.at = seconds;
    options.animation = animation;
    return load(builder, options);
}

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = kTolerance)
{
    EXPECT_LT(glm::length(value - expected), tolerance) << value.x << ' ' << value.y << ' ' << value.z;
}

// After a second: moved by (1, 0, 3), turned by 22.5 degrees, scaled by 2.
TEST(GltfAnimation, MovesTurnsAndScalesNodes)
{
    AnimatedTriangle builder;
    builder.document["nodes"][0]["translation"] = {0, 9, 0};
    builder.addChannel(nodeTarget("translation"), {0, 2}, {0, 0, 3, 2, 0, 3}, "VEC3");
    builder.addChannel(nodeTarget("rotation"), {0, 4}, {0, 0, 0, 1, 0, 0, kHalf, kHalf}, "VEC4");
    builder.addChannel(nodeTarget("scale"), {0, 1, 5}, {1, 1, 1, 2, 2, 2, 9, 9, 9}, "VEC3", "STEP");
    const double angle = std::acos(-1.0) / 8.0;
    expectNear(placedVertex(loadAt(builder, 1.0), 1), {1 + 2 * std::cos(angle), 2 * std::sin(angle), 3}, 1e-7);
    expectNear(placedVertex(loadAt(builder, 100.0), 1), {2, 9, 3}, 1e-6);

    const Scene rest = load(builder);
    expectNear(placedVertex(rest, 1), {1, 9, 0});
    EXPECT_EQ(findWarning(rest.warnings, MessageId::RestPose).value, "0 (\"first\", 5 s)");
    EXPECT_FALSE(hasWarning(loadAt(builder, 1.0).warnings, MessageId::RestPose));
    ASSERT_EQ(rest.animations.size(), 1U);
    EXPECT_EQ(rest.animations[0].name, "first");
    EXPECT_EQ(rest.animations[0].duration, 5.0);
}

TEST(GltfAnimation, IsChosenByNameOrIndex)
{
    AnimatedTriangle builder;
    builder.addChannel(nodeTarget("translation"), {0}, {1, 0, 0}, "VEC3");
    builder.addAnimation("second");
    builder.addChannel(nodeTarget("translation"), {0.25F}, {2, 0, 0}, "VEC3");
    expectNear(placedVertex(loadAt(builder, 0.0), 0), {1, 0, 0});
    expectNear(placedVertex(loadAt(builder, 0.0, "first"), 0), {1, 0, 0});
    expectNear(placedVertex(loadAt(builder, 0.0, "second"), 0), {2, 0, 0});
    expectNear(placedVertex(loadAt(builder, 0.0, "1"), 0), {2, 0, 0});
    EXPECT_EQ(findWarning(load(builder).warnings, MessageId::RestPose).value, "0 (\"first\", 0 s)");
    LoadOptions options;
    options.at = 1.0;
    options.animation = "third";
    expectRefused(builder, MessageId::UnknownName, {.value = "third", .expected = "0 (\"first\", 0 s), 1 (\"second\", 0.25 s)"}, options);
    GltfBuilder still;
    still.addNode({{"mesh", still.addTriangleMesh()}});
    options.animation = "";
    expectRefused(still, MessageId::Missing, {.expected = "no --at"}, options);
}

// Half way through 4 s of a spline for two weights, whose tangents only the first has: 0.5 + 4 (2 - 0)/8 and 0.5.
TEST(GltfAnimation, BlendsMorphTargets)
{
    AnimatedTriangle builder;
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}},
                            {{"POSITION", builder.addVec3({0, 1, 0, 0, 1, 0, 0, 1, 0})}}};
    builder.addChannel(nodeTarget("weights"), {0, 4}, {0, 0, 0, 0, 2, 0, 0, 0, 1, 1, 0, 0}, "SCALAR", "CUBICSPLINE");
    expectNear(placedVertex(loadAt(builder, 2.0), 0), {0, 0.5, 1.5});
    expectNear(placedVertex(loadAt(builder, 4.0), 0), {0, 1, 1});
    expectNear(placedVertex(load(builder), 0), {0, 0, 0});
}

// One weight of a node that names none takes the other from the mesh.
TEST(GltfAnimation, PointsToSingleWeights)
{
    AnimatedTriangle builder;
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}},
                            {{"POSITION", builder.addVec3({0, 1, 0, 0, 1, 0, 0, 1, 0})}}};
    builder.document["meshes"][0]["weights"] = {0.25, 0};
    builder.addChannel(pointerTarget("/nodes/0/weights/1"), {0, 1}, {0, 1}, "SCALAR");
    expectNear(placedVertex(loadAt(builder, 0.5), 0), {0, 0.5, 0.25});
    builder.addAnimation("mesh");
    builder.addChannel(pointerTarget("/meshes/0/weights"), {0, 1}, {0, 0, 1, 3}, "SCALAR");
    expectNear(placedVertex(loadAt(builder, 0.5, "mesh"), 0), {0, 1.5, 0.5});
}

TEST(GltfAnimation, RotationsMayBeBytes)
{
    AnimatedTriangle builder;
    const std::size_t values = builder.addAccessor({0, 0, 0, 127, 0, 0, 127, 0}, kByte, "VEC4", 2);
    builder.document["accessors"][values]["normalized"] = true;
    builder.connect(nodeTarget("rotation"), {0, 1}, values, "LINEAR");
    expectNear(placedVertex(loadAt(builder, 0.5), 1), {0, 1, 0});
}

TEST(GltfAnimation, MovesJoints)
{
    AnimatedTriangle builder;
    json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = builder.addAccessor(Bytes(12, 0), kUnsignedByte, "VEC4", 3);
    attributes["WEIGHTS_0"] = builder.addAccessor(toBytes<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), kFloat, "VEC4", 3);
    builder.addNode(json::object());
    builder.document["skins"] = json::array({{{"joints", {1}}}});
    builder.document["nodes"][0]["skin"] = 0;
    builder.addChannel({{"node", 1}, {"path", "translation"}}, {0, 1}, {0, 0, 0, 0, 0, 8}, "VEC3");
    builder.addChannel(nodeTarget("translation"), {0, 1}, {0, 0, 0, 5, 0, 0}, "VEC3");
    expectNear(placedVertex(loadAt(builder, 0.5), 1), {1, 0, 4});
}

// KHR_node_visibility as bytes, by steps.
TEST(GltfAnimation, PointsToVisibility)
{
    AnimatedTriangle builder;
    builder.addNode({{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
    const std::size_t values = builder.addAccessor({1, 0}, kUnsignedByte, "SCALAR", 2);
    builder.connect(pointerTarget("/nodes/1/extensions/KHR_node_visibility/visible"), {0, 1}, values, "STEP");
    EXPECT_EQ(loadAt(builder, 0.5).instances.size(), 2U);
    EXPECT_EQ(loadAt(builder, 1.0).instances.size(), 1U);
    EXPECT_EQ(load(builder).instances.size(), 2U);
}

TEST(GltfAnimation, PointsToMaterials)
{
    AnimatedTriangle builder;
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    builder.document["materials"] = json::array(
        {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", json::object()}}}}}}},
          {"emissiveFactor", {1, 1, 1}},
          {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1}}}, {"KHR_materials_clearcoat", json::object()}}}}});
    builder.document["textures"] = json::array({{{"source", 0}}});
    builder.document["images"] = json::array({{{"uri", "no such file.png"}}});
    builder.addChannel(pointerTarget("/materials/0/pbrMetallicRoughness/baseColorFactor"), {0, 1}, {0, 0, 0, 1, 1, 0.5F, 0, 0}, "VEC4");
    builder.addChannel(pointerTarget("/materials/0/pbrMetallicRoughness/roughnessFactor"), {0, 1}, {0, 0.5F}, "SCALAR");
    builder.addChannel(pointerTarget("/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength"), {0, 1}, {0, 20},
                       "SCALAR");
    builder.addChannel(pointerTarget("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor"), {0, 1}, {0, 1}, "SCALAR");
    const std::string transform = "/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/";
    builder.addChannel(pointerTarget(transform + "offset"), {0, 1}, {0, 0, 0.5F, 1}, "VEC2");
    builder.addChannel(pointerTarget(transform + "scale"), {0, 1}, {0, 0, 4, 8}, "VEC2");
    LoadOptions options;
    options.at = 0.5;
    options.missingTextures = MissingTextures::Grey;
    const Material material = load(builder, options).materials.at(0);
    EXPECT_EQ(material.baseColor, glm::vec3(0.5F, 0.25F, 0.0F));
    EXPECT_EQ(material.alpha, 0.5F);
    EXPECT_EQ(material.roughness, 0.25F);
    EXPECT_EQ(material.emission, glm::vec3(10.0F));
    EXPECT_EQ(material.clearcoat, 0.5F);
    const Texture texture = material.textures[kSlotBaseColor].value();
    EXPECT_EQ(texture.rowU, glm::vec3(2.0F, 0.0F, 0.25F));
    EXPECT_EQ(texture.rowV, glm::vec3(0.0F, 4.0F, 0.5F));
}

TEST(GltfAnimation, PointsToLightsAndCameras)
{
    AnimatedTriangle builder;
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] =
        json::array({{{"type", "spot"}, {"range", 1}, {"spot", {{"innerConeAngle", 0}, {"outerConeAngle", 1}}}}});
    builder.document["cameras"] =
        json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}},
                     {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.addNode({{"camera", 0}});
    builder.addNode({{"camera", 1}});
    const std::string light = "/extensions/KHR_lights_punctual/lights/0/";
    builder.addChannel(pointerTarget(light + "intensity"), {0, 1}, {0, 40}, "SCALAR");
    builder.addChannel(pointerTarget(light + "color"), {0, 1}, {0, 0, 0, 1, 0.5F, 0}, "VEC3");
    builder.addChannel(pointerTarget(light + "range"), {0, 1}, {1, 3}, "SCALAR");
    builder.addChannel(pointerTarget(light + "spot/outerConeAngle"), {0, 1}, {1, 0.5F}, "SCALAR");
    builder.addChannel(pointerTarget("/cameras/0/perspective/yfov"), {0, 1}, {1, 2}, "SCALAR");
    builder.addChannel(pointerTarget("/cameras/1/orthographic/xmag"), {0, 1}, {1, 4}, "SCALAR");
    builder.addChannel(pointerTarget("/nodes/2/rotation"), {0, 1}, {0, 0, 0, 1, 0, kHalf, 0, kHalf}, "VEC4");
    const Scene scene = loadAt(builder, 0.5);
    EXPECT_EQ(scene.lights.at(0).intensity, glm::vec3(10.0F, 5.0F, 0.0F));
    EXPECT_EQ(scene.lights.at(0).range, 2.0F);
    EXPECT_NEAR(scene.lights.at(0).versineOuter, 1.0F - std::cos(0.75F), kFloatTolerance);
    EXPECT_EQ(scene.cameras.at(0).yfov, 1.5F);
    EXPECT_EQ(scene.cameras.at(1).halfWidth, 2.5F);
    EXPECT_LT(glm::length(scene.cameras.at(0).forward - glm::vec3(-kHalf, 0, -kHalf)), kFloatTolerance) << "45 degrees about y";
}

TEST(GltfAnimation, SaysWhatItDoesNotAnimate)
{
    AnimatedTriangle builder;
    builder.document["materials"] = json::array({{{"occlusionTexture", {{"index", 0}}}}});
    builder.document["textures"] = json::array({json::object()});
    for (const char* pointer : {"/materials/0/occlusionTexture/strength", "/asset/generator", "/nodes/0/matrix", "/materials/0/doubleSided",
                                "/accessors/0/normalized", "", "x", "/", "xnodes/0/scale"}) {
        builder.addChannel(pointerTarget(pointer), {0}, {1}, "SCALAR", "STEP");
    }
    builder.addChannel({{"path", "translation"}}, {0}, {9, 9, 9}, "VEC3");  // no node: nothing
    const Scene scene = loadAt(builder, 0.0);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::AnimationIgnored).place,
              "/materials/0/occlusionTexture/strength, /asset/generator, /nodes/0/matrix and 5 more");
    expectNear(placedVertex(scene, 0), {0, 0, 0});
}

// A spline may leave the range of a colour: at the middle of 1 s from 1 to 1, leaving and arriving by 8/s and -8/s, it is at 3.
TEST(GltfAnimation, ClampsValues)
{
    AnimatedTriangle builder;
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    builder.document["materials"] = json::array({{{"pbrMetallicRoughness", json::object()}}});
    const std::string pointer = "/materials/0/pbrMetallicRoughness/metallicFactor";
    builder.addChannel(pointerTarget(pointer), {0, 1}, {0, 1, 8, -8, 1, 0}, "SCALAR", "CUBICSPLINE");
    const Scene scene = loadAt(builder, 0.5);
    EXPECT_EQ(scene.materials.at(0).metallic, 1.0F);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::AnimatedValueClamped).place, pointer);
    EXPECT_FALSE(hasWarning(loadAt(builder, 1.0).warnings, MessageId::AnimatedValueClamped));
}

// Films of two times must not be merged.
TEST(GltfAnimation, ChangesTheFingerprint)
{
    AnimatedTriangle builder;
    builder.addChannel(nodeTarget("scale"), {0, 4}, {1, 1, 1, 3, 1, 1}, "VEC3");
    const std::string path = writeTemporary("scene.gltf", builder.toGltf());
    const auto print = [&path](std::optional<double> at) {
        LoadOptions options;
        options.at = at;
        const PreparedScene prepared = prepareScene(path, options);
        const Camera camera = prepared.scene.cameras.at(0);
        return fingerprint(fingerprint(prepared.flat), flattenCamera(camera, 1.0F, {}));
    };
    EXPECT_EQ(print(std::nullopt), print(0.0));
    EXPECT_EQ(print(1.0), print(1.0));
    EXPECT_NE(print(1.0), print(2.0));
    EXPECT_NE(print(std::nullopt), print(1.0));
}

// Exporters write a jump as two keys of one time, and float32 may put the second one before the first.
TEST(GltfAnimation, JumpsWhereTimesAreEqual)
{
    for (const float second : {1.0F, std::nextafter(1.0F, 0.0F)}) {
        AnimatedTriangle builder;
        builder.addChannel(nodeTarget("translation"), {0, 1, second, 2}, {0, 0, 0, 2, 0, 0, 5, 0, 0, 6, 0, 0}, "VEC3");
        for (const auto& [seconds, x] : {std::pair(0.5, 1.0), {0.99999, 1.99998}, {1.0, 5.0}, {1.5, 5.5}, {3.0, 6.0}}) {
            expectNear(placedVertex(loadAt(builder, seconds), 0), {x, 0, 0}, 1e-12);
        }
        EXPECT_TRUE(hasWarning(loadAt(builder, 0.5).warnings, MessageId::UnorderedKeys, "accessors[2] (times of animations[0]"));
    }
}

// glTF forbids both on one node; exporters write them. The matrix turns by 90 degrees about z, mirrors and scales.
TEST(GltfAnimation, NodesWithAMatrixAreMoved)
{
    AnimatedTriangle builder;
    builder.document["nodes"][0]["matrix"] = {0, 2, 0, 0, 3, 0, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1};
    builder.addChannel(nodeTarget("translation"), {0, 1}, {0, 0, 0, 8, 0, 0}, "VEC3");
    const Scene scene = loadAt(builder, 0.5);
    expectNear(placedVertex(scene, 0), {4, 0, 0}, 1e-12);
    expectNear(placedVertex(scene, 1), {4, 2, 0}, 1e-12);
    expectNear(placedVertex(scene, 2), {7, 0, 0}, 1e-12);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::MatrixDecomposed).place, "/nodes/0/translation");
    const Scene rest = load(builder);
    expectNear(placedVertex(rest, 1), {10, 22, 30});
}

TEST(GltfAnimation, RefusesWhatIsBroken)
{
    const auto expect = [](const std::function<void(AnimatedTriangle&)>& edit, MessageId id, const Parts& parts) {
        AnimatedTriangle builder;
        builder.addChannel(nodeTarget("translation"), {0, 1}, {0, 0, 0, 1, 1, 1}, "VEC3");
        edit(builder);
        LoadOptions options;
        options.at = 0.5;
        expectRefused(builder, id, parts, options);
    };
    const std::string place = "animations[0] (\"first\").channels[0]", second = "animations[0] (\"first\").channels[1]";
    const auto first = [](AnimatedTriangle& b) -> json& { return b.document["animations"][0]; };
    expect([&](AnimatedTriangle& b) { first(b).erase("samplers"); }, MessageId::Missing, {.place = "animations[0].samplers"});
    expect([&](AnimatedTriangle& b) { first(b)["samplers"][0]["interpolation"] = "BEZIER"; }, MessageId::UnknownName,
           {.place = "animations[0].samplers[0].interpolation", .value = "\"BEZIER\"", .expected = "LINEAR, STEP, CUBICSPLINE"});
    expect([&](AnimatedTriangle& b) { first(b)["channels"][0]["target"]["node"] = 3; }, MessageId::DanglingIndex,
           {.place = "animations[0].channels[0].target.node", .value = "3", .expected = "nodes"});
    expect([&](AnimatedTriangle& b) { first(b)["channels"][0]["target"]["path"] = "colour"; }, MessageId::UnknownName,
           {.place = "animations[0].channels[0].target.path",
            .value = "\"colour\"",
            .expected = "translation, rotation, scale, weights, pointer"});
    expect([&](AnimatedTriangle& b) { first(b)["channels"][0]["sampler"] = 1; }, MessageId::DanglingIndex,
           {.place = place + ".sampler", .value = "1", .expected = "1"});
    expect(
        [&](AnimatedTriangle& b) {
            first(b)["samplers"][0]["input"] = b.addAccessor(toBytes<float>({1, 0.99F}), kFloat, "SCALAR", 2);
        },
        MessageId::OutOfRange, {.place = "accessors[3] (times of animations[0] (\"first\"))", .value = "0.99"});
    expect(
        [&](AnimatedTriangle& b) {
            first(b)["samplers"][0]["input"] = b.addAccessor(toBytes<float>({0, NAN}), kFloat, "SCALAR", 2);
        },
        MessageId::OutOfRange, {.place = "accessors[3] (times of animations[0] (\"first\"))", .value = "nan"});
    expect(
        [&](AnimatedTriangle& b) {
            first(b)["samplers"][0]["output"] = b.addVec3({1, 2, 3});
        },
        MessageId::Mismatch, {.place = place, .value = "1 value", .expected = "2"});
    expect([&](AnimatedTriangle& b) { first(b)["samplers"][0]["interpolation"] = "CUBICSPLINE"; }, MessageId::Mismatch,
           {.place = place, .value = "2 values", .expected = "6"});
    expect([&](AnimatedTriangle& b) { first(b)["channels"][0]["target"]["path"] = "rotation"; }, MessageId::WrongType,
           {.place = "accessors[1] (values of " + place + ")", .expected = "VEC4"});
    expect([&](AnimatedTriangle& b) { first(b)["channels"][0]["target"]["path"] = "weights"; }, MessageId::Missing,
           {.place = place, .value = "nodes[0]"});
    expect(
        [&](AnimatedTriangle& b) {
            b.addChannel(pointerTarget("/nodes/0/translation"), {0}, {0, 0, 0}, "VEC3");
        },
        MessageId::Duplicate, {.place = second, .value = "/nodes/0/translation"});
    for (const json& matrix :
         {json{1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, json{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}) {
        expect([&](AnimatedTriangle& b) { b.document["nodes"][0]["matrix"] = matrix; }, MessageId::Degenerate,
               {.place = place, .value = "/nodes/0/translation"});
    }
    expect([&](AnimatedTriangle& b) { b.document["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0.5, 0, 0, 1, 0, 0, 0, 0, 1}; },
           MessageId::OutOfRange, {.place = "nodes[0].matrix", .value = "0 0.5 0 1", .expected = "0 0 0 1"});
    for (const char* pointer : {"/nodes/1/scale", "/nodes/99999999999/scale", "/materials/0/alphaCutoff"}) {
        expect(
            [&](AnimatedTriangle& b) {
                b.addChannel(pointerTarget(pointer), {0}, {0, 0, 0}, "VEC3");
            },
            MessageId::UnknownName, {.place = second, .value = pointer});
    }
    expect(
        [&](AnimatedTriangle& b) {
            b.document["nodes"][0]["extensions"]["KHR_node_visibility"] = json::object();
            b.addChannel(pointerTarget("/nodes/0/extensions/KHR_node_visibility/visible"), {0}, {1}, "SCALAR");
        },
        MessageId::WrongType, {.place = second, .expected = "STEP"});
    expect(
        [&](AnimatedTriangle& b) {
            b.addChannel(nodeTarget("rotation"), {0}, {0, 0, 0, 0}, "VEC4");
        },
        MessageId::Degenerate, {.place = "nodes[0].rotation", .value = "0"});
}

}  // namespace
}  // namespace glim::test
