// A scene file at one time after another: what is read once, and what is made again.
#include "host/error.hpp"
#include "host/flatten/build_scene_bvh.hpp"
#include "host/render/prepare_scene.hpp"
#include "tests/support/edit_file.hpp"
#include "tests/support/encode_images.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace glim::test {
namespace {

using nlohmann::json;

class SceneFileTest : public ::testing::Test {
protected:
    // A textured triangle under an environment map of the file. Its colour changes between 0 and 1 s, its size between 1 and 2 s.
    void SetUp() override
    {
        GltfBuilder builder;
        const std::size_t uvs = builder.addAccessor(toBytes<float>({0, 0, 1, 0, 0, 1}), kFloat, "VEC2", 3);
        builder.addNode({{"mesh", builder.addTriangleMesh()}});
        json& primitive = builder.document["meshes"][0]["primitives"][0];
        primitive["material"] = 0;
        primitive["attributes"]["TEXCOORD_0"] = uvs;
        const Bytes texels = encodePng(2, 1, {200, 10, 20, 30, 140, 50});
        writeText(folder_ / "image.png", std::string(texels.begin(), texels.end()));
        builder.append("images", {{"uri", "image.png"}});
        builder.append("textures", {{"source", 0}});
        builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        const std::size_t first = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
        const std::size_t second = builder.addAccessor(toBytes<float>({1, 2}), kFloat, "SCALAR", 2);
        const std::size_t colors = builder.addAccessor(toBytes<float>({1, 1, 1, 1, 0.5F, 0.25F, 0, 1}), kFloat, "VEC4", 2);
        const json pointer = {{"pointer", "/materials/0/pbrMetallicRoughness/baseColorFactor"}};
        builder.append(
            "animations",
            {{"samplers", {{{"input", first}, {"output", colors}}, {{"input", second}, {"output", builder.addVec3({1, 1, 1, 3, 3, 3})}}}},
             {"channels",
              {{{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", pointer}}}}}},
               {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}}}}});
        builder.document["extensionsUsed"] = {"KHR_animation_pointer"};
        writeText(folder_ / "scene.gltf", builder.toGltf());
    }
    LoadOptions studio() const
    {
        LoadOptions options;
        options.environment = BuiltInEnvironment::Studio;
        return options;
    }

    ScratchFolder folder_;
};

TEST_F(SceneFileTest, IsReadOnce)
{
    SceneFile file(folder_ / "scene.gltf", studio());
    const Scene before = file.sceneAt(0.0);
    std::filesystem::remove(folder_ / "image.png");
    std::filesystem::remove(folder_ / "scene.gltf");
    const Scene after = file.sceneAt(1.0);
    EXPECT_EQ(after.images.at(0).pixels, before.images.at(0).pixels);
    EXPECT_EQ(after.environment->map, before.environment->map);
    EXPECT_EQ(after.files, before.files) << "pictures must not be written over them";
    EXPECT_EQ(before.materials.at(0).baseColor, glm::vec3(1.0F));
    EXPECT_EQ(after.materials.at(0).baseColor, glm::vec3(0.5F, 0.25F, 0.0F));
    EXPECT_EQ(file.sceneAt(std::nullopt).materials.at(0).baseColor, glm::vec3(1.0F)) << "the rest pose";
}

// Each scene of a sequence is the one that a fresh start gives.
TEST_F(SceneFileTest, KeepsWhatDoesNotMove)
{
    SceneFile file(folder_ / "scene.gltf", studio());
    PreparedScene prepared;
    const void* nodes = nullptr;
    FlatScene before;
    for (const double seconds : {0.0, 0.5, 1.5, 1.0}) {
        updateScene(prepared, file, seconds, SplitRule::Sah);
        LoadOptions options = studio();
        options.at = seconds;
        const PreparedScene fresh = prepareScene(folder_ / "scene.gltf", options);
        EXPECT_EQ(fingerprint(prepared.flat), fingerprint(fresh.flat)) << seconds;
        EXPECT_EQ(prepared.flat.nodes, fresh.flat.nodes) << seconds;
        EXPECT_EQ(prepared.flat.environmentMap->cells, fresh.flat.environmentMap->cells) << seconds;
        EXPECT_EQ(prepared.flat.features, fresh.flat.features) << seconds;
        EXPECT_EQ(prepared.flat.images->texels, fresh.flat.images->texels) << seconds;
        // What is kept is moved or shared, not made again.
        EXPECT_EQ(prepared.bvh.nodes.data() == nodes, seconds == 0.5) << seconds;
        EXPECT_EQ(prepared.flat.environmentMap == before.environmentMap, seconds != 0.0) << seconds;
        EXPECT_EQ(prepared.flat.images == before.images, seconds != 0.0) << seconds;
        nodes = prepared.bvh.nodes.data();
        before = prepared.flat;
    }
}

// What is packed is kept by image, not by place.
TEST_F(SceneFileTest, ImagesOfAnotherFileAreItsOwn)
{
    SceneFile file(folder_ / "scene.gltf", studio());
    PreparedScene prepared;
    updateScene(prepared, file, 0.0, SplitRule::Sah);
    const Bytes texels = encodePng(2, 1, {1, 2, 3, 4, 5, 6});
    writeText(folder_ / "image.png", std::string(texels.begin(), texels.end()));
    SceneFile other(folder_ / "scene.gltf", studio());
    const std::vector<std::uint32_t> before = prepared.flat.images->texels;
    updateScene(prepared, other, 0.0, SplitRule::Sah);
    const PreparedScene fresh = prepareScene(folder_ / "scene.gltf", studio());
    EXPECT_EQ(prepared.flat.images->texels, fresh.flat.images->texels);
    EXPECT_EQ(fingerprint(prepared.flat), fingerprint(fresh.flat));
    EXPECT_NE(prepared.flat.images->texels, before);
}

// An edit names another file, or has it in itself; what it leaves alone is not decoded again.
TEST_F(SceneFileTest, AnEditReplacesAnImage)
{
    const Bytes texels = encodePng(2, 1, {1, 2, 3, 4, 5, 6});
    writeText(folder_ / "other.png", std::string(texels.begin(), texels.end()));
    const std::string embedded =  // grey 9
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGPgBAAACwAKwyvukgAAAABJRU5ErkJggg==";
    SceneFile file(folder_ / "scene.gltf");
    const Scene before = file.sceneAt(std::nullopt);
    edit(file, {{"/images/0/uri", "\"other.png\""}});
    const Scene other = file.sceneAt(std::nullopt);
    EXPECT_EQ(other.images.at(0).pixels->rgba8, (std::vector<std::uint8_t>{1, 2, 3, 255, 4, 5, 6, 255}));
    EXPECT_EQ(other.files.back(), folder_ / "other.png");
    edit(file, {{"/images/0/uri", "\"other.png\""}, {"/materials/0/alphaCutoff", "0.25"}});
    EXPECT_EQ(file.sceneAt(std::nullopt).images.at(0).pixels, other.images.at(0).pixels);
    edit(file, {{"/images/0/uri", json(embedded).dump()}});
    EXPECT_EQ(file.sceneAt(1.0).images.at(0).pixels->rgba8, (std::vector<std::uint8_t>{9, 9, 9, 255}));
    edit(file, {});
    EXPECT_EQ(file.sceneAt(std::nullopt).images.at(0).pixels->rgba8, before.images.at(0).pixels->rgba8);
}

TEST_F(SceneFileTest, AnEditReplacesAnImageOfABuffer)
{
    GltfBuilder builder = oneTriangle();
    const Bytes texels = encodePng(1, 1, {9, 8, 7});
    builder.append("images", {{"bufferView", builder.addAov(texels)}, {"mimeType", "image/png"}});
    builder.append("textures", {{"source", 0}});
    builder.append("materials", {{"emissiveTexture", {{"index", 0}}}});
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    const std::size_t uvs = builder.addAccessor(toBytes<float>({0, 0, 1, 0, 0, 1}), kFloat, "VEC2", 3);
    builder.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs;
    writeText(folder_ / "buffer.gltf", builder.toGltf());
    SceneFile file(folder_ / "buffer.gltf");
    const auto red = [&file] { return file.sceneAt(std::nullopt).images.at(0).pixels->rgba8.at(0); };
    EXPECT_EQ(red(), 9);
    edit(file, {{"/images/0/uri", "\"image.png\""}});
    EXPECT_EQ(red(), 200);
    edit(file, {});
    EXPECT_EQ(red(), 9);
}

TEST_F(SceneFileTest, AConfinedEditStaysInTheFolder)
{
    LoadOptions options;
    options.confined = true;
    SceneFile file(folder_ / "scene.gltf", options);
    file.sceneAt(std::nullopt);
    const std::vector<Edit> outside{{"/images/0/uri", "\"../image.png\""}};
    expectRefusal<InputError>([&] { edit(file, outside); }, MessageId::OutsideFolder, {.place = "images[0]", .value = "../image.png"});
    EXPECT_EQ(file.sceneAt(std::nullopt).images.at(0).pixels->rgba8.at(0), 200);
    SceneFile free(folder_ / "scene.gltf");
    edit(free, outside);
    expectRefusal<InputError>([&] { free.sceneAt(std::nullopt); }, MessageId::FileMissing);
}

// Four fans of eight triangles, a lamp and a pane of rough glass, below a light.
GltfBuilder fans()
{
    GltfBuilder builder;
    std::vector<float> corners{0.0F, 0.0F, 0.0F};
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 9; ++i) {
        corners.insert(corners.end(), {1.0F, 0.125F * static_cast<float>(i), 0.0F});
        indices.insert(indices.end(), {0U, i, i + 1});
    }
    indices.erase(indices.begin(), indices.begin() + 3);
    const std::size_t mesh =
        builder.addMesh({{"attributes", {{"POSITION", builder.addVec3(corners)}}}, {"indices", builder.addIndices(indices)}});
    const std::size_t lamp = builder.addTriangleMesh(), pane = builder.addTriangleMesh();
    builder.append("materials", {{"alphaMode", "MASK"}});
    builder.append("materials", {{"emissiveFactor", {1, 1, 1}}});
    builder.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
                                 {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
    builder.document["meshes"][mesh]["primitives"][0]["material"] = 0;
    builder.document["meshes"][lamp]["primitives"][0]["material"] = 1;
    builder.document["meshes"][pane]["primitives"][0]["material"] = 2;
    for (int i = 0; i < 4; ++i) {
        builder.addNode({{"mesh", mesh}, {"translation", {2 * i, 0, 0}}});
    }
    builder.addNode({{"mesh", lamp}, {"translation", {0, 3, 0}}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, -5, 0}}});
    builder.addNode({{"mesh", pane}, {"translation", {0, 0, 2}}});
    builder.document["extensionsUsed"] = {"KHR_lights_punctual"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    return builder;
}

// Whatever was edited before, the scene is the one that a fresh start gives, and what an edit does not touch is the same array.
TEST_F(SceneFileTest, AnEditTouchesWhatItChanges)
{
    struct Case {
        Edit edit;
        bool keepsMeshes, keepsRecords, keepsNodes;
    };
    const std::string path = writeTemporary("fans.gltf", fans().toGltf());
    SceneFile file(path);
    PreparedScene prepared;
    updateScene(prepared, file, std::nullopt, SplitRule::Sah);
    for (const Case& c :
         {Case{{"/materials/0/pbrMetallicRoughness/baseColorFactor", "[0.5, 0.25, 0, 1]"}, true, true, true},
          {{"/materials/1/emissiveFactor", "[0.5, 0.5, 0.5]"}, true, true, true},
          {{"/materials/1/alphaCutoff", "0.25"}, true, true, true},  // of an opaque material
          {{"/extensions/KHR_lights_punctual/lights/0/intensity", "7"}, true, true, true},
          {{"/nodes/5/translation", "[0, -6, 0]"}, true, true, true},
          {{"/extensions/KHR_lights_punctual/lights/0/intensity", "0"}, true, false, true},  // the lamp is another light of the list
          {{"/materials/1/emissiveFactor", "[0, 0, 0]"}, true, false, false},
          {{"/materials/0/emissiveFactor", "[1, 0, 0]"}, true, false, false},
          {{"/materials/0/doubleSided", "true"}, true, false, false},
          {{"/materials/2/pbrMetallicRoughness/roughnessFactor", "0"}, true, false, false},  // rays pass it straight
          {{"/materials/0/alphaCutoff", "2"}, true, false, false},
          {{"/nodes/1/translation", "[2, 1, 0]"}, true, false, false},
          {{"/materials/0/extensions/KHR_materials_anisotropy/anisotropyStrength", "0.5"}, false, false, false}}) {
        for (const std::vector<Edit>& edits : {std::vector<Edit>{c.edit}, {}}) {
            const FlatScene before = prepared.flat;
            const SharedVector<Mesh> meshes = prepared.scene.meshes;
            edit(file, edits);
            updateScene(prepared, file, std::nullopt, SplitRule::Sah);
            LoadOptions options;
            options.edits = edits;
            const PreparedScene fresh = prepareScene(path, options);
            const std::string what = c.edit.pointer + (edits.empty() ? " undone" : "");
            EXPECT_EQ(fingerprint(prepared.flat), fingerprint(fresh.flat)) << what;
            EXPECT_EQ(prepared.flat.features, fresh.flat.features) << what;
            EXPECT_EQ(prepared.flat.primitiveRefs.size(), fresh.flat.primitiveRefs.size()) << what;
            EXPECT_EQ(prepared.scene.meshes.isSameAs(meshes), c.keepsMeshes) << what;
            EXPECT_EQ(prepared.flat.primitiveRefs.isSameAs(before.primitiveRefs), c.keepsRecords) << what;
            EXPECT_EQ(prepared.flat.nodes.isSameAs(before.nodes), c.keepsNodes) << what;
        }
    }
}

// Where one instance of a shared mesh moves, the shapes stay the same arrays.
TEST_F(SceneFileTest, ASharedMeshMovesAlone)
{
    GltfBuilder moved = fans();
    const Scene before = load(moved);
    moved.document["nodes"][2]["translation"] = {4, 1, 0};
    Scene after = load(moved);
    after.meshes = before.meshes;
    after.origin = before.origin;
    Primitives primitives = makePrimitives(before, 0);
    ASSERT_EQ(primitives.placements.size(), 4U);
    const WideBvh bvh = buildSceneBvh(primitives);
    const FlatScene flat = flattenScene(before, primitives, bvh);
    ASSERT_EQ(compareSurfaces(before, primitives, after), Same::AllButPlacements);
    placeSharedMeshes(after, primitives);
    const WideBvh movedBvh = moveInstances(bvh, primitives, SplitRule::Sah);
    const FlatScene flatMoved = flattenScene(after, primitives, movedBvh, flat, Same::AllButPlacements);
    const Primitives freshPrimitives = makePrimitives(after, 0);
    const FlatScene fresh = flattenScene(after, freshPrimitives, buildSceneBvh(freshPrimitives));
    EXPECT_EQ(fingerprint(flatMoved), fingerprint(fresh));
    EXPECT_NE(fingerprint(flatMoved), fingerprint(flat));
    EXPECT_EQ(flatMoved.features, fresh.features);
    EXPECT_EQ(flatMoved.instances, fresh.instances);
    EXPECT_TRUE(flatMoved.primitiveRefs.isSameAs(flat.primitiveRefs));
    EXPECT_TRUE(flatMoved.triangles.isSameAs(flat.triangles));
    // A flattened instance that moves is another shape.
    Scene lamp = after;
    lamp.instances[4].worldFromMesh[3].y += 1.0;
    EXPECT_EQ(compareSurfaces(after, primitives, lamp), Same::Nothing);
}

// A pointer that the file does not have changes nothing.
TEST_F(SceneFileTest, ARefusedEditLeavesTheSceneAsItWas)
{
    const std::string path = writeTemporary("fans.gltf", fans().toGltf());
    SceneFile file(path);
    const std::vector<Edit> edits{{"/materials/0/alphaCutoff", "0.75"}};
    edit(file, edits);
    ASSERT_EQ(file.sceneAt(std::nullopt).materials[0].alphaCutoff, 0.75F);
    EXPECT_THROW(edit(file, {{"/materials/0/alphaCutoff", "0.25"}, {"/materials/9/alphaCutoff", "0.25"}}), InputError);
    EXPECT_EQ(file.sceneAt(std::nullopt).materials[0].alphaCutoff, 0.75F);
}

// Nothing is left to hit, and nothing was there before: the tree is a root.
TEST_F(SceneFileTest, ASceneWithoutAnyPrimitiveHasATree)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    builder.append("materials", {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}});
    writeText(folder_ / "clear.gltf", builder.toGltf());
    const PreparedScene prepared = prepareScene(folder_ / "clear.gltf", studio());
    EXPECT_EQ(prepared.primitives.count(), 0U);
    EXPECT_EQ(prepared.flat.nodes.size(), kNodeTexels);
}

}  // namespace
}  // namespace glim::test
