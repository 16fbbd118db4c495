// Containers, hierarchy, recentring, and what the loader leaves out.
#include "host/flatten/primitives.hpp"
#include "places.h"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace glim::test {
namespace {

using nlohmann::json;

void expectTheTriangle(const Scene& scene)
{
    ASSERT_EQ(makePrimitives(scene).triangles.size(), 1U);
    EXPECT_EQ(vertex(scene, 0, 0), glm::vec3(0, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 1), glm::vec3(1, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 2), glm::vec3(0, 1, 0));
}

TEST(LoadGltf, ReadsDataUriAndBinaryContainer)
{
    expectTheTriangle(load(oneTriangle()));
    expectTheTriangle(loadGltf(writeTemporary("scene.glb", oneTriangle().toGlb())));
}

TEST(LoadGltf, ReadsExternalBuffersBesideTheFile)
{
    GltfBuilder builder = oneTriangle();
    const Bytes& bytes = builder.bytes();
    // Longer than byteLength is allowed, and names are percent-encoded.
    writeTemporary("a b.bin", std::string(bytes.begin(), bytes.end()) + "more");
    builder.document["buffers"] = json::array({{{"byteLength", bytes.size()}, {"uri", "a%20b.bin"}}});
    expectTheTriangle(loadText(builder.document.dump()));
}

TEST(LoadGltf, RefusesWhatIsNotAFile)
{
    expectRefusal<InputError>([] { loadGltf("/nonexistent/x.gltf"); }, MessageId::FileMissing, {.file = "/nonexistent/x.gltf"});
    expectRefusal<InputError>([] { loadGltf(GLIM_SOURCE_DIR); }, MessageId::WrongType,
                              {.file = GLIM_SOURCE_DIR, .value = "a folder", .expected = ".glb"});
}

// The files are sparse: terabytes that take no room.
TEST(LoadGltf, RefusesAWrongBeginningBeforeReadingOn)
{
    const std::pair<const char*, Parts> cases[] = {{"large.glb", {.file = "large.glb", .expected = "glTF"}},
                                                   {"large.gltf", {.file = "large.gltf", .value = "0", .expected = ".gltf"}}};
    for (const auto& [name, parts] : cases) {
        const std::string path = writeTemporary(name, "");
        std::filesystem::resize_file(path, std::uintmax_t{1} << 40U);
        expectRefusal<InputError>([&] { loadGltf(path); }, MessageId::UnknownFormat, parts);
        std::filesystem::resize_file(path, 0);
    }
}

TEST(LoadGltf, ReadsNoMoreOfABufferThanItNeeds)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    const Bytes& bytes = builder.bytes();
    const std::string buffer = writeTemporary("large.bin", std::string(bytes.begin(), bytes.end()));
    std::filesystem::resize_file(buffer, std::uintmax_t{1} << 40U);
    builder.document["buffers"] = json::array({{{"byteLength", bytes.size()}, {"uri", "large.bin"}}});
    EXPECT_EQ(loadText(builder.document.dump()).instances.size(), 1U);
    std::filesystem::resize_file(buffer, 0);
}

TEST(LoadGltf, OtherFormatsAreNamedWithWhatMakesGltfOfThem)
{
    struct Other {
        const char *name, *start, *format, *remedy;
    };
    const Other others[] = {{"a.obj", "v 0 0 0\n", "OBJ", "tools/to_gltf"},
                            {"a.ply", "ply\nformat ascii 1.0\n", "PLY", "tools/to_gltf"},
                            {"a.dae", "<?xml version=\"1.0\"?><COLLADA", "COLLADA", "tools/to_gltf"},
                            {"a.fbx", "Kaydara FBX Binary  ", "FBX", "Blender"},
                            {"a.usd", "PXR-USDC", "USD", "Blender"},
                            {"a.usdz", "PK\3\4", "USD in a zip archive", "Blender"},
                            {"a.blend", "BLENDER-v405", "a file of Blender", "Blender"},
                            {"a.STL", "\1\1\1\1", "STL", "Blender"},
                            {"a.3ds", "MM", "3DS", "Blender"},
                            {"a.abc", "Ogawa", "Alembic", "Blender"},
                            {"a.step", "ISO-10303-21;", "STEP or IFC", "FreeCAD"},
                            {"a.zip", "PK\3\4", "a zip archive", "unpack"},
                            {"a.max", "\xd0\xcf", "a file of another program", "converters"},
                            // By their first bytes, whatever their names.
                            {"a.gltf", "#usda 1.0", "USD", "Blender"},
                            {"a.glb", "PK\3\4", "a zip archive", "unpack"},
                            {"b.obj", "ply\n", "PLY", "tools/to_gltf"},
                            {"a.txt", "v 0 0 0\n", "118", ".gltf"}};
    for (const Other& other : others) {
        expectRefusal<InputError>([&] { loadGltf(writeTemporary(other.name, other.start)); }, MessageId::UnknownFormat,
                                  {.file = other.name, .value = other.format, .expected = other.remedy});
    }
    EXPECT_EQ(loadGltf(writeTemporary("named.obj", oneTriangle().toGltf())).instances.size(), 1U) << "a name alone is no format";
}

TEST(LoadGltf, LaterVersionsAreReadUnlessTheySayThatTheyCannotBe)
{
    GltfBuilder builder = oneTriangle();
    builder.document["asset"] = {{"version", "2.0"}, {"minVersion", "2.0"}};
    EXPECT_FALSE(hasWarning(load(builder).warnings, MessageId::LaterVersion));
    builder.document["asset"] = {{"version", "2.1"}, {"minVersion", "2.0"}};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.instances.size(), 1U);
    expectMessage(findWarning(scene.warnings, MessageId::LaterVersion), MessageId::LaterVersion,
                  {.place = "asset.version", .value = "2.1"});
    builder.document["asset"]["minVersion"] = "2.1";
    expectRefused(builder, MessageId::UnknownFormat, {.place = "asset", .value = "2.1", .expected = "2.0"});
    builder.document["asset"] = {{"version", "3.0"}};
    expectRefused(builder, MessageId::UnknownFormat, {.place = "asset", .value = "3.0", .expected = "2.0"});
}

TEST(LoadGltf, RefusesDeepJsonBeforeAnyParserRecurses)
{
    const std::string deep = R"({"asset":{"version":"2.0"},"extras":)" + std::string(100000, '[');
    expectRefusal<InputError>([&] { loadText(deep); }, MessageId::TooLarge, {.file = "scene.gltf", .value = "100001"});
}

TEST(LoadGltf, ComposesMatrixAndTrsAlike)
{
    // Scale, then rotate by 90 degrees about Z, then translate.
    const double h = std::sqrt(0.5);
    const json trs = {{"translation", {1, 2, 3}}, {"rotation", {0, 0, h, h}}, {"scale", {2, 3, 4}}};
    const json matrix = {{"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 1, 2, 3, 1}}};
    for (const json& node : {trs, matrix}) {
        const Scene scene = load(oneTriangle(node));
        EXPECT_LT(glm::length(vertex(scene, 0, 0) - glm::vec3(1, 2, 3)), 1e-6F);
        EXPECT_LT(glm::length(vertex(scene, 0, 1) - glm::vec3(1, 4, 3)), 1e-6F);
        EXPECT_LT(glm::length(vertex(scene, 0, 2) - glm::vec3(-2, 2, 3)), 1e-6F);
    }
}

TEST(LoadGltf, QuaternionsTurnCounterClockwiseAboutTheirAxis)
{
    // 120 degrees about (1,1,1) takes x to y to z; given twice as long as a unit quaternion.
    const Scene scene = load(oneTriangle({{"rotation", {1, 1, 1, 1}}}));
    EXPECT_LT(glm::length(vertex(scene, 0, 1) - glm::vec3(0, 1, 0)), 1e-6F);
    EXPECT_LT(glm::length(vertex(scene, 0, 2) - glm::vec3(0, 0, 1)), 1e-6F);
    // 90 degrees about x takes y to z.
    const Scene tipped = load(oneTriangle({{"rotation", {std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}}));
    EXPECT_LT(glm::length(vertex(tipped, 0, 2) - glm::vec3(0, 0, 1)), 1e-6F);
}

TEST(LoadGltf, AppliesParentsAfterChildren)
{
    GltfBuilder builder;
    builder.append("nodes", {{"mesh", builder.addTriangleMesh()}, {"translation", {1, 0, 0}}});
    builder.append("nodes", {{"children", {0}}, {"scale", {10, 10, 10}}});
    builder.addNode({{"children", {1}}, {"translation", {0, 0, 5}}});
    EXPECT_EQ(vertex(load(builder), 0, 1), glm::vec3(20, 0, 5));
}

TEST(LoadGltf, RootsBelowNodesOutsideTheSceneAreDrawnWithoutThem)
{
    GltfBuilder builder = oneTriangle({{"name", "leaf"}, {"translation", {1, 0, 0}}});
    builder.append("nodes", {{"children", {0}}, {"translation", {0, 7, 0}}});
    for (const bool inAnotherScene : {false, true}) {
        if (inAnotherScene) {
            builder.document["scenes"].push_back({{"nodes", {1}}});
        }
        const Scene scene = load(builder);
        EXPECT_EQ(vertex(scene, 0, 0), glm::vec3(1, 0, 0));
        EXPECT_EQ(findWarning(scene.warnings, MessageId::ParentTransformIgnored).place, "nodes[0] (\"leaf\")");
    }
    LoadOptions other;
    other.scene = 1;
    EXPECT_EQ(vertex(load(builder, other), 0, 0), glm::vec3(1, 7, 0));
    EXPECT_FALSE(hasWarning(load(builder, other).warnings, MessageId::ParentTransformIgnored));
    EXPECT_FALSE(hasWarning(load(oneTriangle()).warnings, MessageId::ParentTransformIgnored));
    builder.document["scenes"][0]["nodes"] = {0, 1};
    expectRefused(builder, MessageId::Duplicate, {.place = "nodes[0] (\"leaf\")"});
}

TEST(LoadGltf, ReadsHierarchiesDeeperThanTheCallStack)
{
    GltfBuilder builder;
    builder.append("nodes", {{"mesh", builder.addTriangleMesh()}});
    for (std::size_t i = 0; i < 50000; ++i) {
        builder.append("nodes", {{"children", {i}}});
    }
    builder.document["scenes"][0]["nodes"] = {50000};
    expectTheTriangle(load(builder));
}

TEST(LoadGltf, H44FrontStaysFrontUnderNegativeScale)
{
    for (const json& scale : {json{1, 1, 1}, json{-1, 1, 1}, json{1, 1, -1}, json{-1, -1, 1}, json{-2, -1, -3}}) {
        GltfBuilder builder;
        const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
        const std::size_t normals = builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1});
        const json attributes = {{"POSITION", positions}, {"NORMAL", normals}};
        builder.addNode({{"mesh", builder.addMesh({{"attributes", attributes}})}, {"scale", scale}});
        const Scene scene = load(builder);
        const float front = scale[2].get<float>() > 0.0F ? 1.0F : -1.0F;  // where +Z went
        const Triangle t = makePrimitives(scene).triangles.at(0);
        const glm::vec3 face = glm::cross(t.vertices[1] - t.vertices[0], t.vertices[2] - t.vertices[0]);
        EXPECT_GT(face.z * front, 0.0F) << scale;
        EXPECT_EQ(normal(scene, 0, 0), glm::vec3(0, 0, front)) << scale;
    }
}

TEST(LoadGltf, NormalsFollowTheInverseTranspose)
{
    // On the plane x + y = 1, whose normal (1,1,0) becomes that of x / 2 + y = 1, which is (1,2,0); the normals of the
    // vertices are told apart by their corners, which mirroring exchanges.
    for (const double mirror : {1.0, -1.0}) {
        GltfBuilder builder;
        const std::size_t positions = builder.addVec3({1, 0, 0, 0, 1, 0, 0, 1, 1});
        const std::size_t normals = builder.addVec3({1, 1, 0, 1, 1, 0, 0, 1, 0});
        const json attributes = {{"POSITION", positions}, {"NORMAL", normals}};
        builder.addNode({{"mesh", builder.addMesh({{"attributes", attributes}})}, {"scale", {2, 1, mirror}}});
        const Scene scene = load(builder);
        const glm::vec3 tilted = glm::normalize(glm::vec3(1, 2, 0));
        for (int v = 0; v < 3; ++v) {
            const bool isThird = std::abs(vertex(scene, 0, v).z) > 0.5F;
            const glm::vec3 expected = isThird ? glm::vec3(0, 1, 0) : tilted;
            EXPECT_LT(glm::length(normal(scene, 0, v) - expected), 1e-6F) << v;
        }
    }
}

TEST(LoadGltf, BadNormalsGiveWayToTheFaceNormal)
{
    GltfBuilder builder;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t normals = builder.addVec3({nan, 0, 0, 0, 0, 0, 0, 1, 0});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}})}});
    const Scene scene = load(builder);
    EXPECT_EQ(normal(scene, 0, 0), glm::vec3(0, 0, 1));
    EXPECT_EQ(normal(scene, 0, 1), glm::vec3(0, 0, 1));
    EXPECT_EQ(normal(scene, 0, 2), glm::vec3(0, 1, 0));
    EXPECT_EQ(findWarning(makePrimitives(scene).warnings, MessageId::BadNormal).value, "2 normals");
}

TEST(LoadGltf, H8RecentringLosesNothingFarFromTheOrigin)
{
    const auto place = [](double x, double y, double z) {
        GltfBuilder builder;
        // Coordinates with all 24 bits in use, and a sphere, a light and a camera that go along.
        const std::size_t positions = builder.addVec3({0.1F, 0.7F, 0.3F, 1.9F, 0.1F, 0.2F, 0.3F, 1.7F, 0.1F});
        builder.append("nodes",
                       {{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}})}, {"rotation", {0.1, 0.2, 0.3, 0.9}}});
        builder.append("nodes", {{"translation", {0.5, 0.25, 0.75}}, {"extras", {{"sphere", {{"radius", 0.3}}}}}});
        builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
        builder.append("nodes", {{"translation", {0.5, 0.5, 4}}, {"camera", 0}});
        builder.addNode({{"children", {0, 1, 2}}, {"translation", {x, y, z}}});
        return load(builder);
    };
    const Scene here = place(0, 0, 0);
    for (const double far : {1e4, 1e6, 1e9}) {
        const Scene there = place(far, -far, far);
        const Primitives near = makePrimitives(here), shifted = makePrimitives(there);
        EXPECT_EQ(std::memcmp(near.triangles.data(), shifted.triangles.data(), sizeof(Triangle)), 0) << far;
        EXPECT_EQ(here.spheres.at(0).center, there.spheres.at(0).center) << far;
        EXPECT_EQ(here.cameras.at(0).position, there.cameras.at(0).position) << far;
        EXPECT_EQ(there.origin - here.origin, glm::dvec3(far, -far, far));
    }
}

TEST(LoadGltf, OriginIsTheCentreToTheShareItSays)
{
    const Scene scene = load(oneTriangle({{"translation", {100.3, -7.1, 3.3}}, {"scale", {3, 5, 1}}}));
    const glm::dvec3 center(101.8, -4.6, 3.3);
    EXPECT_LT(glm::length(scene.origin - center), 5.0 * std::sqrt(3.0) / 512.0);
}

TEST(LoadGltf, H44DropsWhatHasNoExtentAndCountsIt)
{
    GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 0, 0, 3, 0, 0});
    const std::size_t indices = builder.addIndices({0, 1, 2, 0, 0, 1, 1, 3, 4});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}})}});
    builder.addNode({{"extras", {{"sphere", {{"radius", 0}}}}}});
    const Scene scene = load(builder);
    const Primitives primitives = makePrimitives(scene);
    EXPECT_EQ(primitives.triangles.size(), 1U);
    EXPECT_TRUE(primitives.spheres.empty());
    EXPECT_EQ(findWarning(primitives.warnings, MessageId::FlatTriangle).value, "2 triangles");
    EXPECT_EQ(findWarning(scene.warnings, MessageId::EmptySphere).value, "1 sphere");
}

TEST(LoadGltf, ChoosesTheScene)
{
    GltfBuilder builder = oneTriangle({{"name", "first"}});
    builder.append("nodes", {{"name", "second"}, {"mesh", 0}});
    builder.append("scenes", {{"nodes", {1}}});
    EXPECT_EQ(load(builder).instances.at(0).name, "first");
    EXPECT_EQ(load(builder, {.scene = 1}).instances.at(0).name, "second");
    builder.document["scene"] = 1;
    EXPECT_EQ(load(builder).instances.at(0).name, "second");
    expectRefused(builder, MessageId::DanglingIndex, {.place = "scene", .value = "2", .expected = "2"}, {.scene = 2});
    builder.document.erase("scene");
    builder.document.erase("scenes");
    EXPECT_EQ(load(builder).instances.size(), 2U);
}

TEST(LoadGltf, PlacesAMeshOncePerNode)
{
    GltfBuilder builder = oneTriangle();
    builder.addNode({{"mesh", 0}, {"translation", {4, 0, 0}}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.meshes.size(), 1U);
    EXPECT_EQ(scene.instances.size(), 2U);
    EXPECT_EQ(makePrimitives(scene).firstTriangles, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(vertex(scene, 1, 0), glm::vec3(4, 0, 0));
}

TEST(LoadGltf, ScalesSpheresUniformly)
{
    const auto radius = [](const json& node) {
        GltfBuilder builder;
        json sphere = node;
        sphere["extras"] = {{"sphere", {{"radius", 2}}}};
        builder.addNode(sphere);
        return load(builder).spheres.at(0).radius;
    };
    EXPECT_EQ(radius(json::object()), 2.0F);
    EXPECT_EQ(radius({{"scale", {3, 3, 3}}, {"rotation", {0.5, 0.5, 0.5, 0.5}}}), 6.0F);
    EXPECT_EQ(radius({{"scale", {-1.5, -1.5, -1.5}}}), 3.0F);
    EXPECT_EQ(radius({{"scale", {-1.5, 1.5, 1.5}}}), 3.0F);
}

// Two texels: red, half transparent, and green.
constexpr const char* kTwoTexels =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP4z8DQwPCf4T8ADn0Dfur2k8AAAAAASUVORK5CYII=";

GltfBuilder texturedTriangle(const json& image)
{
    GltfBuilder builder = oneTriangle();
    builder.append("images", image);
    builder.append("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    builder.append("textures", {{"source", 0}, {"sampler", 0}});
    builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}});
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    return builder;
}

TEST(LoadGltf, DecodesTheImagesThatMaterialsUse)
{
    GltfBuilder builder = texturedTriangle({{"name", "wood"}, {"uri", kTwoTexels}});
    builder.append("images", {{"uri", "nobody reads it.png"}});
    const Scene scene = load(builder);
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].width, 2U);
    EXPECT_EQ(scene.images[0].pixels->rgba8, (std::vector<std::uint8_t>{255, 0, 0, 128, 0, 255, 0, 255}));
    const std::optional<Texture>& texture = scene.materials.at(0).textures[kSlotBaseColor];
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->uvSet, 1U);
    EXPECT_EQ(texture->wrapS, Wrap::Clamp);
    EXPECT_EQ(texture->wrapT, Wrap::Mirrored);
    EXPECT_TRUE(texture->nearest);
}

// Exporters write an image once for each texture.
TEST(LoadGltf, DecodesImagesOfTheSameBytesOnce)
{
    GltfBuilder builder = texturedTriangle({{"name", "wood"}, {"uri", kTwoTexels}});
    builder.append("images", {{"name", "wood again"}, {"uri", kTwoTexels}});
    builder.append("textures", {{"source", 1}});
    builder.document["materials"][0]["emissiveTexture"] = {{"index", 1}};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.materials.at(0).textures[kSlotEmissive].value().image, 0U);
}

TEST(LoadGltf, NamesImagesThatAreMissingOrBroken)
{
    expectRefused(texturedTriangle({{"name", "wood"}, {"uri", "no such file.png"}}), MessageId::FileMissing,
                  {.place = "images[0]", .value = "no such file.png"});
    expectRefused(texturedTriangle({{"name", "wood"}, {"uri", "data:image/png;base64,AAEC"}}), MessageId::UnknownFormat,
                  {.place = "images[0] (\"wood\")"});
    GltfBuilder builder = texturedTriangle({{"uri", "wood.png"}});
    builder.document["textures"][0]["source"] = 9;
    expectRefused(builder, MessageId::DanglingIndex, {.place = "textures[0].source", .value = "9", .expected = "images"});
}

TEST(LoadGltf, SaysWhatItDoesNotKnow)
{
    GltfBuilder builder = oneTriangle();
    builder.document["extensionsUsed"] = {"EXT_mesh_from_tomorrow", "KHR_materials_ior"};
    const Scene scene = load(builder);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::ExtensionIgnored).place, "EXT_mesh_from_tomorrow");
}

}  // namespace
}  // namespace glim::test
