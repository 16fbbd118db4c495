// Files that are added to a scene.
#include "host/error.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/job/parse.hpp"
#include "host/scene/frame_camera.hpp"
#include "tests/support/edit_file.hpp"
#include "tests/support/encode_images.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

class JoinScenesTest : public ::testing::Test {
protected:
    // A red triangle; and a textured one with a sphere and a light, each of whose names and indices differ from those of the first file.
    void SetUp() override
    {
        GltfBuilder table;
        table.addNode({{"mesh", table.addTriangleMesh()}, {"name", "table"}, {"translation", {100, 0, 0}}});
        table.append("materials", {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
        table.document["meshes"][0]["primitives"][0]["material"] = 0;
        writeText(folder_ / "table.gltf", table.toGltf());

        GltfBuilder vase;
        const std::size_t uvs = vase.addAccessor(toBytes<float>({0, 0, 1, 0, 0, 1}), kFloat, "VEC2", 3);
        vase.addNode({{"mesh", vase.addTriangleMesh()}, {"name", "vase"}});
        vase.addNode({{"extras", {{"sphere", {{"radius", 0.5}, {"material", 1}}}}}, {"translation", {0, 2, 0}}});
        vase.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 3, 0}}});
        const Bytes texels = encodePng(2, 1, {200, 10, 20, 30, 140, 50});
        writeText(folder_ / "image.png", std::string(texels.begin(), texels.end()));
        vase.append("images", {{"uri", "image.png"}});
        vase.append("textures", {{"source", 0}});
        vase.append("materials", {{"name", "glaze"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        vase.append("materials", {{"name", "bead"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0, 1, 0, 1}}}}});
        json& primitive = vase.document["meshes"][0]["primitives"][0];
        primitive["material"] = 0;
        primitive["attributes"]["TEXCOORD_0"] = uvs;
        vase.document["extensionsUsed"] = {"KHR_lights_punctual"};
        vase.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", json::object()}, {"intensity", 3.0}}};
        writeText(folder_ / "vase.gltf", vase.toGltf());
    }
    LoadOptions with(const std::string& name, const glm::dmat4& matrix = glm::dmat4(1.0)) const
    {
        LoadOptions options;
        options.additions = {{folder_.path() / name, matrix}};
        return options;
    }
    std::string table() const { return (folder_ / "table.gltf").string(); }

    ScratchFolder folder_;
};

TEST_F(JoinScenesTest, ShapesAndLightsStandWhereTheMatrixSays)
{
    const glm::dmat4 matrix =
        glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(101, 2, 3)), 0.5 * 3.14159265358979323846, glm::dvec3(0, 0, 1)),
                   glm::dvec3(2.0));
    const Scene scene = loadGltf(table(), with("vase.gltf", matrix));
    ASSERT_EQ(scene.instances.size(), 2U);
    ASSERT_EQ(scene.spheres.size(), 1U);
    ASSERT_EQ(scene.lights.size(), 1U);
    EXPECT_EQ(scene.instances[0].worldFromMesh[3], glm::dvec4(100, 0, 0, 1));
    EXPECT_EQ(scene.instances[1].worldFromMesh, matrix);
    const Mesh& mesh = scene.meshes[scene.instances[1].mesh];
    EXPECT_EQ(scene.materials[mesh.material].name, "glaze");
    EXPECT_EQ(scene.materials[scene.spheres[0].material].name, "bead");
    EXPECT_EQ(scene.nodeNames[scene.instances[1].node], "vase");
    EXPECT_EQ(scene.images.at(scene.materials[mesh.material].textures[kSlotBaseColor]->image).width, 2U);
    // A quarter turn takes +y to -x.
    const auto worldOf = [&](const glm::vec3& point) { return glm::dvec3(point) + scene.origin; };
    EXPECT_LT(glm::length(worldOf(scene.spheres[0].center) - glm::dvec3(101 - 4, 2, 3)), 1e-5);
    EXPECT_EQ(scene.spheres[0].radius, 1.0F);
    EXPECT_LT(glm::length(worldOf(scene.lights[0].position) - glm::dvec3(101 - 6, 2, 3)), 1e-5);
    EXPECT_LT(glm::length(scene.lights[0].direction - glm::vec3(0, 0, -1)), 1e-6F);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3.0F)) << "whatever the scale";
    EXPECT_EQ(std::ranges::count(scene.files, folder_ / "image.png"), 1) << "pictures must not be written over it";
}

// Films of a scene from two files are those of one file with the same nodes.
TEST_F(JoinScenesTest, IsTheSceneOfOneFileWithBoth)
{
    GltfBuilder both, left, right;
    const auto addCard = [](GltfBuilder& builder, const std::vector<double>& color, const std::vector<double>& at) {
        const std::size_t mesh = builder.addTriangleMesh();
        builder.document["meshes"][mesh]["primitives"][0]["material"] =
            builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", color}}}});
        builder.addNode({{"mesh", mesh}, {"translation", at}});
    };
    addCard(left, {1, 0, 0, 1}, {0, 0, 0});
    addCard(right, {0, 1, 0, 1}, {0, 0, 0});
    addCard(both, {1, 0, 0, 1}, {0, 0, 0});
    addCard(both, {0, 1, 0, 1}, {1, 2, 3});
    writeText(folder_ / "left.gltf", left.toGltf());
    writeText(folder_ / "right.gltf", right.toGltf());
    writeText(folder_ / "both.gltf", both.toGltf());
    LoadOptions options = with("right.gltf", glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3)));
    Scene joined = loadGltf(folder_ / "left.gltf", options);
    Scene whole = loadGltf(folder_ / "both.gltf");
    EXPECT_EQ(makePrimitives(joined).triangles.size(), 2U);
    whole.origin = joined.origin;  // the first file's alone says where it is
    const auto printOf = [](const Scene& scene) {
        const Primitives primitives = makePrimitives(scene);
        return fingerprint(flattenScene(scene, primitives, buildSceneBvh(primitives)));
    };
    EXPECT_EQ(printOf(joined), printOf(whole));
}

TEST_F(JoinScenesTest, FramedCamerasSeeTheFirstFile)
{
    const Camera alone = loadGltf(table()).cameras.front();
    const Camera joined = loadGltf(table(), with("vase.gltf")).cameras.front();
    EXPECT_EQ(joined.position, alone.position);
    EXPECT_EQ(frameTurntable(loadGltf(table(), with("vase.gltf")), 1.0F, 4)[1].from, frameTurntable(loadGltf(table()), 1.0F, 4)[1].from);
}

// The lamp of an added file lights the scene: no studio.
TEST_F(JoinScenesTest, AFileOfLightsAloneIsAdded)
{
    GltfBuilder lights;
    lights.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    lights.document["extensionsUsed"] = {"KHR_lights_punctual"};
    lights.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 1e5}}};
    writeText(folder_ / "lights.gltf", lights.toGltf());
    ASSERT_TRUE(loadGltf(table()).environment);
    const Scene scene = loadGltf(table(), with("lights.gltf"));
    EXPECT_EQ(scene.lights.size(), 1U);
    EXPECT_FALSE(scene.environment);
}

TEST_F(JoinScenesTest, EditsNameTheirFile)
{
    LoadOptions options = with("vase.gltf");
    options.edits = {{"vase.gltf#/materials/bead/pbrMetallicRoughness/baseColorFactor", "[0, 0, 1, 1]"},
                     {"/materials/red/pbrMetallicRoughness/baseColorFactor", "[1, 1, 0, 1]"}};
    const Scene scene = loadGltf(table(), options);
    EXPECT_EQ(scene.materials[0].baseColor, glm::vec3(1, 1, 0));
    EXPECT_EQ(scene.materials[scene.spheres[0].material].baseColor, glm::vec3(0, 0, 1));
    options.edits = {{"lamp.gltf#/materials/0/alphaCutoff", "1"}};
    expectRefusal<InputError>([&] { loadGltf(table(), options); }, MessageId::Malformed,
                              {.place = "lamp.gltf#/materials/0/alphaCutoff", .expected = "\"vase.gltf\" and a #"});
    options.edits = {{"vase.gltf#/materials/9/alphaCutoff", "1"}};
    expectRefusal<InputError>([&] { loadGltf(table(), options); }, MessageId::DanglingIndex,
                              {.file = "vase.gltf", .place = "/materials/9/alphaCutoff", .value = "/materials"});
}

// Neither file, if one refuses.
TEST_F(JoinScenesTest, ARefusedEditChangesNothing)
{
    SceneFile file(table(), with("vase.gltf"));
    const glm::vec3 before = file.sceneAt(std::nullopt).materials[0].baseColor;
    expectRefusal<InputError>(
        [&] {
            edit(file,
                 {{"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0, 0, 1, 1]"}, {"vase.gltf#/materials/9/alphaCutoff", "1"}});
        },
        MessageId::DanglingIndex, {.file = "vase.gltf", .place = "/materials/9/alphaCutoff"});
    EXPECT_EQ(file.sceneAt(std::nullopt).materials[0].baseColor, before);
}

// Meshes stay the same array while the files' do.
TEST_F(JoinScenesTest, AnEditKeepsTheMeshes)
{
    SceneFile file(table(), with("vase.gltf"));
    const Scene before = file.sceneAt(std::nullopt);
    edit(file, {{"/materials/0/pbrMetallicRoughness/roughnessFactor", "0.5"}, {"vase.gltf#/nodes/vase/translation", "[0, 1, 0]"}});
    const Scene after = file.sceneAt(std::nullopt);
    EXPECT_TRUE(after.meshes.isSameAs(before.meshes));
    EXPECT_EQ(after.materials[0].roughness, 0.5F);
    EXPECT_EQ(after.instances[1].worldFromMesh[3], glm::dvec4(0, 1, 0, 1));
    edit(file, {{"vase.gltf#/materials/glaze/extensions/KHR_materials_anisotropy/anisotropyStrength", "0.5"}});
    EXPECT_FALSE(file.sceneAt(std::nullopt).meshes.isSameAs(before.meshes)) << "they need tangents";
}

TEST_F(JoinScenesTest, RefusesWhatAFileCannotBe)
{
    expectRefusal<InputError>([&] { loadGltf(table(), with("none.gltf")); }, MessageId::FileMissing, {.file = "none.gltf"});
    expectRefusal<InputError>([&] { loadGltf(table(), with("vase.gltf", glm::scale(glm::dmat4(1.0), glm::dvec3(1, 2, 1)))); },
                              MessageId::Unsupported, {.file = "vase.gltf", .expected = "uniform scale"});
    for (const double away : {1e19, 1e300}) {
        for (const char* name : {"vase.gltf", "table.gltf"}) {
            expectRefusal<InputError>([&] { loadGltf(table(), with(name, glm::translate(glm::dmat4(1.0), glm::dvec3(away, 0, 0)))); },
                                      MessageId::TooLarge, {.file = name, .expected = "1e18 m"});
        }
    }
}

// Two files of one name in different folders are told apart by their paths.
TEST_F(JoinScenesTest, RefusesAnAmbiguousFile)
{
    std::filesystem::create_directory(folder_ / "other");
    std::filesystem::copy_file(folder_ / "table.gltf", folder_ / "other/table.gltf");
    LoadOptions options;
    options.additions = {{folder_ / "table.gltf", glm::dmat4(1.0)}, {folder_ / "other/table.gltf", glm::dmat4(1.0)}};
    const std::string place = "#/materials/0/pbrMetallicRoughness/baseColorFactor";
    options.edits = {{"table.gltf" + place, "[0, 0, 1, 1]"}};
    expectRefusal<InputError>([&] { loadGltf(table(), options); }, MessageId::AmbiguousName,
                              {.place = "table.gltf" + place, .expected = "other/table.gltf"});
    options.edits = {{(folder_ / "other/table.gltf").string() + place, "[0, 0, 1, 1]"}};
    SceneFile file(table(), options);
    const Scene scene = file.sceneAt(std::nullopt);
    EXPECT_EQ(scene.materials.at(1).baseColor, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.materials.at(2).baseColor, glm::vec3(0, 0, 1));
    EXPECT_EQ(file.pointerToMaterial(2), (folder_ / "other/table.gltf").string() + "#/materials/0");
}

// The default material goes with the sphere that is hidden, and the numbers of the added materials change.
TEST_F(JoinScenesTest, MaterialsStayThoseOfTheirMeshes)
{
    GltfBuilder builder;
    builder.append("materials", {{"name", "red"}});
    const std::size_t mesh = builder.addTriangleMesh();
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    builder.addNode({{"extras", {{"sphere", {{"radius", 0.5}}}}}});
    writeText(folder_ / "ball.gltf", builder.toGltf());
    SceneFile file(folder_ / "ball.gltf", with("vase.gltf"));
    for (const char* visible : {"true", "false", "true"}) {
        edit(file, {{"/nodes/1/extensions/KHR_node_visibility/visible", visible}});
        const Scene scene = file.sceneAt(std::nullopt);
        EXPECT_EQ(scene.materials.at(scene.meshes[scene.instances.at(1).mesh].material).name, "glaze") << visible;
    }
}

TEST(ParseAddition, TakesAFileAndWhereItStands)
{
    const auto matrixOf = [](const Addition& addition) { return addition.worldFromFile; };
    EXPECT_EQ(parseAddition("a.glb").file, "a.glb");
    EXPECT_EQ(matrixOf(parseAddition("a.glb")), glm::dmat4(1.0));
    EXPECT_EQ(parseAddition("me@home/a@2.glb").file, "me@home/a@2.glb");
    EXPECT_EQ(parseAddition("a@2.glb@1,.5,-3").file, "a@2.glb");
    EXPECT_EQ(matrixOf(parseAddition("a@2.glb@1,.5,-3")), glm::translate(glm::dmat4(1.0), glm::dvec3(1, 0.5, -3)));
    const glm::dmat4 matrix = matrixOf(parseAddition("a.glb@2,0,0,0,0,2,0,0,0,0,2,0,1,2,3,1"));
    EXPECT_EQ(matrix, glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(1, 2, 3)), glm::dvec3(2)));
    EXPECT_EQ(parseAddition(describeAddition({"b.glb", matrix})), (Addition{"b.glb", matrix}));
    EXPECT_EQ(matrixOf(parseAddition(OptionValue("a.glb", *Json::parse("[1, 2, 3]")))), matrixOf(parseAddition("a.glb@1,2,3")));
    for (const char* text : {"a.glb@1,2", "a.glb@1,2,x", "@1,2,3", "a.glb@1,0,0,0,0,1,0,0,0,0,0,0,0,0,0,1",
                             "a.glb@1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2", "a.glb@1,2,1e999"}) {
        EXPECT_THROW(parseAddition(text), UsageError) << text;
    }
    EXPECT_THROW(parseAddition(OptionValue("a.glb", *Json::parse("[1, 2]"))), UsageError);
}

}  // namespace
}  // namespace glim::test
