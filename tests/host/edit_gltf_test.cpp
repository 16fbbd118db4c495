// Changes of a file by pointers: the scene is that of a file that has the values.
#include "host/flatten/flatten_scene.hpp"
#include "host/scene/edit.hpp"
#include "host/scene/load_gltf.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace glim::test {
namespace {

using nlohmann::json;

// A triangle below two nodes, with a material, a light and a camera. Some names are those of several things.
GltfBuilder builder()
{
    GltfBuilder builder;
    builder.append("materials", {{"name", "paint"}});
    builder.append("materials", {{"name", "other"}});
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}, {"name", "card"}});
    builder.addNode({{"mesh", mesh}, {"name", "card"}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 2, 3, 1}}});
    builder.addNode({{"camera", 0}, {"name", "eye"}, {"translation", {0, 0, 5}}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.append("cameras", {{"type", "perspective"}, {"name", "lens"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"name", "bulb"}, {"intensity", 3.0}}};
    return builder;
}

LoadOptions edited(const std::vector<Edit>& edits)
{
    LoadOptions options;
    options.edits = edits;
    return options;
}

// Of the scene and its first camera.
std::string fingerprintOf(const Scene& scene)
{
    return fingerprint(fingerprint(flattened(scene)), flattenCamera(scene.cameras.front(), 1.0F));
}

// The edit gives what the file gives with `value` at the place.
void expectSame(const std::string& pointer, const json& value, const std::string& place)
{
    GltfBuilder other = builder();
    other.document[json::json_pointer(place)] = value;
    const std::string before = fingerprintOf(load(builder())), expected = fingerprintOf(load(other));
    EXPECT_NE(expected, before) << pointer;
    EXPECT_EQ(fingerprintOf(load(builder(), edited({{pointer, value.dump()}}))), expected) << pointer;
}

TEST(EditGltf, SetsWhatAFileCouldHave)
{
    for (const auto& [pointer, value, place] :
         {std::tuple("/materials/0/pbrMetallicRoughness/baseColorFactor", json{1, 0.5, 0, 1}, ""),
          {"/materials/paint/pbrMetallicRoughness/roughnessFactor", 0.25, "/materials/0/pbrMetallicRoughness/roughnessFactor"},
          {"/materials/paint/extensions/KHR_materials_clearcoat/clearcoatFactor", 1,
           "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor"},
          {"/materials/0/emissiveFactor", json{1, 2, 3}, ""},
          {"/materials/0/alphaMode", "BLEND", ""},
          {"/materials/0/doubleSided", true, ""},
          {"/nodes/0/translation", json{1, 2, 3}, ""},
          {"/nodes/eye/rotation", json{0, 0.6, 0, 0.8}, "/nodes/2/rotation"},
          {"/nodes/0/extensions/KHR_node_visibility/visible", false, ""},
          {"/cameras/lens/perspective/yfov", 0.7, "/cameras/0/perspective/yfov"},
          {"/extensions/KHR_lights_punctual/lights/bulb/intensity", 7, "/extensions/KHR_lights_punctual/lights/0/intensity"}}) {
        expectSame(pointer, value, *place == '\0' ? pointer : place);
    }
}

TEST(EditGltf, EditsApplyInOrder)
{
    GltfBuilder other = builder();
    other.document["materials"][0]["pbrMetallicRoughness"] = {{"roughnessFactor", 0.5}, {"metallicFactor", 0.25}};
    const Scene scene = load(builder(), edited({{"/materials/0/pbrMetallicRoughness/roughnessFactor", "0.1"},
                                                {"/materials/0/pbrMetallicRoughness/metallicFactor", "0.25"},
                                                {"/materials/paint/pbrMetallicRoughness/roughnessFactor", "0.5"}}));
    EXPECT_EQ(fingerprintOf(scene), fingerprintOf(load(other)));
}

// An edit of a part splits the matrix; one of the matrix removes the parts.
TEST(EditGltf, ANodeHasAMatrixOrParts)
{
    const auto placeOf = [](const std::vector<Edit>& edits, std::size_t instance) {
        return load(builder(), edited(edits)).instances[instance].worldFromMesh;
    };
    glm::dmat4 moved = placeOf({}, 1);
    moved[3] = {7.0, 8.0, 9.0, 1.0};
    EXPECT_EQ(placeOf({{"/nodes/1/translation", "[7, 8, 9]"}}, 1), moved);
    EXPECT_EQ(placeOf({{"/nodes/0/scale", "[3, 3, 3]"}, {"/nodes/0/matrix", "[2,0,0,0, 0,2,0,0, 0,0,2,0, 7,8,9,1]"}}, 0), moved);
}

void expectRefused(const Edit& edit, MessageId id, const Parts& parts) { test::expectRefused(builder(), id, parts, edited({edit})); }

TEST(EditGltf, RefusesWithThePointerOrThePlace)
{
    expectRefused({"/materials/glass/alphaCutoff", "1"}, MessageId::UnknownName,
                  {.place = "/materials/glass/alphaCutoff", .value = "glass", .expected = "0 to 1, or one of \"paint\", \"other\""});
    expectRefused({"/nodes/card/scale", "[1, 1, 1]"}, MessageId::AmbiguousName,
                  {.place = "/nodes/card/scale", .value = "card", .expected = "0, 1"});
    expectRefused({"/materials/2/alphaCutoff", "1"}, MessageId::DanglingIndex,
                  {.place = "/materials/2/alphaCutoff", .value = "/materials", .expected = "0 to 1"});
    expectRefused({"/materials/0/alphaCutoff/deep", "1"}, MessageId::Unsupported, {.place = "/materials/0/alphaCutoff/deep"});
    expectRefused({"/lights/0/intensity", "1"}, MessageId::UnknownName, {.place = "/lights/0/intensity", .value = "/lights"});
    for (const char* pointer :
         {"/", "/asset/version", "/materials", "/materials/0", "/materials/0/name", "/nodes/0/mesh", "/scene", "/accessors/0/count",
          "/meshes/0/primitives/0/material", "/cameras/0/type", "/materials/0/unknown", "/materials/0/normalTexture/index",
          "/materials/0/pbrMetallicRoughness.roughnessFactor", "/materials[]/alphaCutoff"}) {
        expectRefused({pointer, "1"}, MessageId::Unsupported, {.place = pointer});
    }
    expectRefused({"", "1"}, MessageId::Malformed, {.expected = "begins with /, since no file is added"});
    expectRefused({"/materials/0/alphaCutoff", "-2"}, MessageId::OutOfRange, {.place = "materials[0].alphaCutoff", .value = "-2"});
    expectRefused({"/materials/0/pbrMetallicRoughness/baseColorFactor", "[1, 2]"}, MessageId::Mismatch,
                  {.place = "materials[0].pbrMetallicRoughness.baseColorFactor", .expected = "4"});
    expectRefused({"/materials/0/alphaMode", "\"GLASS\""}, MessageId::UnknownName,
                  {.place = "materials[0].alphaMode", .value = "\"GLASS\""});
    expectRefused({"/materials/0/doubleSided", "3"}, MessageId::WrongType, {.place = "materials[0].doubleSided", .value = "3"});
    expectRefused({"/materials/0/alphaCutoff", "1,2"}, MessageId::Malformed, {.place = "/materials/0/alphaCutoff", .value = "1,2"});
    expectRefused({"/images/0/uri", "\"a.png\""}, MessageId::UnknownName, {.place = "/images/0/uri", .value = "/images"});
    expectRefused({"/nodes/0/weights/0", "1"}, MessageId::UnknownName, {.place = "/nodes/0/weights/0", .value = "/nodes/0/weights"});
}

// Each edit is checked before the next one reads what it wrote.
TEST(EditGltf, AWrongValueIsRefusedBeforeTheNextEdit)
{
    struct Case {
        const char* matrix;
        MessageId id;
        const char* place;
    };
    for (const auto& [matrix, id, place] : {Case{"[1, 2]", MessageId::Mismatch, "nodes[0].matrix"},
                                            {"5", MessageId::WrongType, "nodes[0].matrix"},
                                            {"[2,0,0,0, 0,2,0,0, 0,0,2,0, 1,2,3,9]", MessageId::Degenerate, "/nodes/0/translation"}}) {
        const LoadOptions options = edited({{"/nodes/0/matrix", matrix}, {"/nodes/0/translation", "[1, 2, 3]"}});
        test::expectRefused(builder(), id, {.place = place}, options);
    }
    test::expectRefused(builder(), MessageId::WrongType, {.place = "nodes[0].weights", .value = "5"},
                        edited({{"/nodes/0/weights", "5"}, {"/nodes/0/weights/0", "1"}}));
}

// What Python shows of a file.
TEST(EditableFileTest, KnowsNamesAndValues)
{
    const EditableFile file(writeTemporary("editable.gltf", builder().toGltf()));
    using Names = std::vector<std::string>;
    EXPECT_EQ(file.namesAt("/materials"), (Names{"paint", "other"}));
    EXPECT_EQ(file.namesAt("/nodes"), (Names{"card", "card", "eye", ""}));
    EXPECT_EQ(file.namesAt("/skins"), Names());
    const auto valueAt = [&file](const std::string& pointer, const std::vector<Edit>& edits) {
        return json::parse(file.valueAt(pointer, edits));
    };
    EXPECT_EQ(valueAt("/materials/0", {}), (json{{"name", "paint"}}));
    EXPECT_EQ(valueAt("/materials/0", {{"/materials/paint/alphaCutoff", "0.25"}}), (json{{"name", "paint"}, {"alphaCutoff", 0.25}}));
    EXPECT_EQ(valueAt("/materials/0", {}), (json{{"name", "paint"}})) << "edits are of one call";
    const json card = valueAt("/nodes/1", {});
    EXPECT_EQ(card["translation"], (json{1.0, 2.0, 3.0}));
    EXPECT_EQ(card["scale"], (json{2.0, 2.0, 2.0}));
    EXPECT_TRUE(card.contains("matrix"));
    const json sheared = valueAt("/nodes/1", {{"/nodes/1/matrix", "[1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1]"}});
    EXPECT_FALSE(sheared.contains("scale"));
    expectRefusal<InputError>(
        [&] {
            valueAt("/materials/0", {{"/materials/0/alphaCutoff", "-2"}});
        },
        MessageId::OutOfRange, {.place = "materials[0].alphaCutoff"});
}

// The image of the extension, not the one beside it for other readers; uris are not kept, and need none.
TEST(EditableFileTest, KnowsTheImagesOfTextures)
{
    GltfBuilder textured = builder();
    for (const char* const name : {"a.png", "b.webp"}) {
        textured.append("images", {{"uri", name}});
    }
    textured.append("textures", {{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}});
    textured.append("textures", {{"source", 0}});
    textured.append("textures", json::object());
    const EditableFile file(writeTemporary("editable.gltf", textured.toGltf()));
    EXPECT_EQ(file.imageOf(0), 1U);
    EXPECT_EQ(file.imageOf(1), 0U);
    EXPECT_EQ(file.imageOf(2), std::nullopt);
    EXPECT_EQ(json::parse(file.valueAt("/images/1", {{"/images/1/uri", "\"c.png\""}})), (json{{"uri", "c.png"}}));
}

TEST(EditGltf, APointerIsEscaped)
{
    GltfBuilder slashes = builder();
    slashes.document["materials"][0]["name"] = "a/b~c";
    const Scene scene = load(slashes, edited({{"/materials/a~1b~0c/alphaCutoff", "0.75"}}));
    EXPECT_EQ(scene.materials[0].alphaCutoff, 0.75F);
}

}  // namespace
}  // namespace glim::test
