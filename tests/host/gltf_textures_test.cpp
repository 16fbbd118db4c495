// Where a glTF file keeps its images, which texture coordinates they use, and lights made of images.
#include "host/error.hpp"
#include "tests/support/encode_images.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim::test {
namespace {

using nlohmann::json;
using Texels = std::vector<std::uint8_t>;

const Texels kRed{200, 10, 20, 255};

Bytes redPng() { return encodePng(1, 1, {200, 10, 20}); }

// A triangle with six sets of texture coordinates, of which set i is i everywhere.
GltfBuilder triangleOfSets()
{
    GltfBuilder builder;
    const std::size_t mesh = builder.addTriangleMesh();
    json& primitive = builder.document["meshes"][mesh]["primitives"][0];
    for (int set = 0; set < 6; ++set) {
        const std::vector<float> uv(6, static_cast<float>(set));
        primitive["attributes"]["TEXCOORD_" + std::to_string(set)] = builder.addAccessor(toBytes(uv), kFloat, "VEC2", 3);
    }
    primitive["material"] = 0;
    builder.addNode({{"mesh", mesh}});
    return builder;
}

// Its base colour is `image`.
GltfBuilder texturedTriangle(const json& image)
{
    GltfBuilder builder = triangleOfSets();
    builder.append("images", image);
    builder.append("textures", {{"source", 0}});
    builder.append("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    return builder;
}

std::string base64Uri(const std::string& type, const Bytes& bytes)
{
    GltfBuilder builder;
    builder.addAov(bytes);
    const std::string uri = json::parse(builder.toGltf())["buffers"][0]["uri"];
    return "data:" + type + uri.substr(uri.find(';'));
}

std::string asText(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(GltfTextures, ImagesInDataUrisOfAnyType)
{
    const Bytes webp = encodeWebp(1, 1, {200, 10, 20, 255});
    EXPECT_EQ(load(texturedTriangle({{"uri", base64Uri("image/png", redPng())}})).images.at(0).pixels->rgba8, kRed);
    EXPECT_EQ(load(texturedTriangle({{"uri", base64Uri("image/webp", webp)}})).images.at(0).pixels->rgba8, kRed);
    EXPECT_EQ(load(texturedTriangle({{"uri", base64Uri("image/png;charset=x", redPng())}})).images.at(0).pixels->rgba8, kRed);
    // What the file says of the type does not matter.
    EXPECT_EQ(load(texturedTriangle({{"uri", base64Uri("image/jpeg", redPng())}, {"mimeType", "image/jpeg"}})).images.at(0).pixels->rgba8,
              kRed);
    expectRefused(texturedTriangle({{"uri", "data:image/png,abc"}}), MessageId::UnknownFormat, {.place = "images[0]"});
    expectRefused(texturedTriangle({{"uri", "data:image/png;base64,iVB*"}}), MessageId::Malformed,
                  {.place = "images[0].uri", .value = "42"});
    expectRefused(texturedTriangle({{"uri", "data:image/png;base64"}}), MessageId::Malformed,
                  {.place = "images[0].uri", .expected = "comma"});
}

// A KTX2 of one texel.
Bytes redKtx2()
{
    Bytes file{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
    // R8G8B8A8_UNORM; the descriptor at 104, the level at 148
    for (const std::uint32_t number : {37, 1, 1, 1, 0, 0, 1, 1, 0, 104, 44, 0, 0, 0, 0, 0, 0, 148, 0, 4, 0, 4, 0, 44, 0, 2 + (40 << 16)}) {
        for (int shift = 0; shift < 32; shift += 8) {
            file.push_back(static_cast<unsigned char>(number >> shift));
        }
    }
    file.resize(148);
    file.insert(file.end(), kRed.begin(), kRed.end());
    return file;
}

// What an extension offers goes before the texture's own source.
TEST(GltfTextures, ExtensionsOfferImages)
{
    const std::string blue = base64Uri("image/png", encodePng(1, 1, {0, 0, 255})), broken = "data:image/png;base64,AAEC";
    const std::vector<std::pair<const char*, std::string>> extensions{
        {"KHR_texture_basisu", base64Uri("image/ktx2", redKtx2())}, {"EXT_texture_webp", base64Uri("image/webp", encodeWebp(1, 1, kRed))}};
    for (const auto& [extension, uri] : extensions) {
        SCOPED_TRACE(extension);
        GltfBuilder builder = texturedTriangle({{"uri", blue}});
        builder.append("images", {{"uri", uri}});
        builder.document["textures"][0]["extensions"][extension] = {{"source", 1}};
        EXPECT_EQ(load(builder).images.at(0).pixels->rgba8, kRed);
        builder.document["extensionsRequired"] = builder.document["extensionsUsed"] = {extension};
        builder.document["textures"][0].erase("source");
        EXPECT_EQ(load(builder).images.at(0).pixels->rgba8, kRed) << "it is the only one";
        builder.document["images"][1]["uri"] = broken;
        expectRefused(builder, MessageId::UnknownFormat, {.place = "images[1]"});
    }
    // Of kinds that are not read the texture's own image is drawn, or none: the file is refused by its image's name, or drawn grey.
    for (const std::string extension : {"EXT_texture_avif", "MSFT_texture_dds"}) {
        SCOPED_TRACE(extension);
        GltfBuilder builder = texturedTriangle({{"uri", blue}});
        builder.append("images", {{"uri", "data:image/other;base64,AAAAHGZ0eXBhdmlm"}});
        builder.document["textures"][0]["extensions"][extension] = {{"source", 1}};
        builder.document["extensionsUsed"] = {extension};
        EXPECT_EQ(load(builder).images.at(0).pixels->rgba8, (Bytes{0, 0, 255, 255}));
        builder.document["extensionsRequired"] = {extension};
        builder.document["textures"][0].erase("source");
        expectRefused(builder, MessageId::UnknownFormat, {.place = "images[1]", .value = "AVIF", .expected = "WebP"});
        LoadOptions options;
        options.missingTextures = MissingTextures::Grey;
        EXPECT_EQ(load(builder, options).images.at(0).pixels->rgba8, (Bytes{128, 128, 128, 255}));
        builder.document["textures"][0]["extensions"][extension] = {{"source", 7}};
        expectRefused(builder, MessageId::DanglingIndex, {.value = "7"});
    }
}

TEST(GltfTextures, DataUrisOfText)
{
    std::string text = "data:image/png,";
    for (const unsigned char byte : redPng()) {
        char code[4];
        std::snprintf(code, sizeof code, "%%%02X", byte);
        text += std::isalnum(byte) != 0 ? std::string(1, static_cast<char>(byte)) : code;
    }
    EXPECT_EQ(load(texturedTriangle({{"uri", text}})).images.at(0).pixels->rgba8, kRed);
}

TEST(GltfTextures, BadBase64IsCalledSo)
{
    const std::string uri = base64Uri("image/png", redPng());
    for (const std::string& bad : {uri + "=====", uri.substr(0, 40) + "=" + uri.substr(40), std::string("data:image/png;base64,AAAAA")}) {
        SCOPED_TRACE(bad);
        expectRefused(texturedTriangle({{"uri", bad}}), MessageId::Malformed, {.place = "images[0].uri", .expected = "base64"});
    }
    const std::string bare = uri.substr(0, uri.find_last_not_of('=') + 1);
    EXPECT_EQ(load(texturedTriangle({{"uri", bare}})).images.at(0).pixels->rgba8, kRed);
}

TEST(GltfTextures, ImagesInBufferViews)
{
    GltfBuilder builder = texturedTriangle({{"mimeType", "image/png"}});
    builder.document["images"][0]["bufferView"] = builder.addAov(redPng());
    const std::string path = writeTemporary("image_in_view.glb", builder.toGlb());
    EXPECT_EQ(loadGltf(path).images.at(0).pixels->rgba8, kRed);
}

TEST(GltfTextures, ImagesInFilesBesideAndBelow)
{
    const ScratchFolder folder;
    std::filesystem::create_directories(folder.path() / "maps" / "of wood");
    writeText(folder.path() / "my file.png", asText(redPng()));
    for (const char* name : {"a+b.png", "c:d.png", "50%25.png"}) {
        writeText(folder.path() / "maps" / "of wood" / name, asText(redPng()));
    }
    writeText(folder.path() / "e\\f.png", asText(redPng()));
    for (const std::string uri :
         {"my%20file.png", "my file.png", "maps/of%20wood/a+b.png", "./maps/of wood/a%2Bb.png", "maps/of wood/c:d.png",
          "maps/of wood/50%25.png", "maps/of wood/50%2525.png", "maps\\of wood\\a+b.png", "maps\\of%20wood\\c%3Ad.png", "e\\f.png"}) {
        writeText(folder / "scene.glb", texturedTriangle({{"uri", uri}}).toGlb());
        const Scene scene = loadGltf(folder / "scene.glb");
        EXPECT_EQ(scene.images.at(0).pixels->rgba8, kRed) << uri;
        ASSERT_EQ(scene.files.size(), 2U) << "a preview watches it";
        EXPECT_TRUE(std::filesystem::exists(scene.files[1])) << scene.files[1];
    }
}

TEST(GltfTextures, AJpegWithoutItsEndIsDrawnAndSaidSo)
{
    Bytes jpeg = encodeJpeg(8, 8, Bytes(64, 90), JpegColors::Grey);
    jpeg.resize(jpeg.size() - 2);
    const Scene scene = load(texturedTriangle({{"uri", base64Uri("image/jpeg", jpeg)}, {"name", "wood"}}));
    EXPECT_NEAR(scene.images.at(0).pixels->rgba8.at(0), 90, 1);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::UnterminatedJpeg).place, "images[0] (\"wood\")");
}

TEST(GltfTextures, BrokenOnesAreNamedOrGrey)
{
    const std::string path =
        writeTemporary("broken_image.gltf", texturedTriangle({{"uri", "data:image/png;base64,AAEC"}, {"name", "wood"}}).toGltf());
    expectRefusal<InputError>([&] { loadGltf(path); }, MessageId::UnknownFormat, {.file = path, .place = "images[0] (\"wood\")"});
    LoadOptions options;
    options.missingTextures = MissingTextures::Grey;
    const Scene scene = loadGltf(path, options);
    EXPECT_EQ(scene.images.at(0).pixels->rgba8, (Texels{128, 128, 128, 255}));
    EXPECT_EQ(findWarning(scene.warnings, MessageId::GreyImage).place, "images[0] (\"wood\")");
    expectRefused(texturedTriangle({{"uri", "lost.png"}}), MessageId::FileMissing, {.place = "images[0]", .value = "lost.png"});
}

// An image that is used for colours and for numbers is averaged both ways, if it is scaled down at all.
TEST(GltfTextures, LargeImagesAreScaledDownByTheirUse)
{
    GltfBuilder builder = texturedTriangle({{"uri", base64Uri("image/png", encodePng(2, 1, {0, 0, 0, 255, 255, 255}))}});
    builder.document["materials"][0]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
    builder.document["materials"][0]["emissiveTexture"] = {{"index", 0}};
    EXPECT_EQ(load(builder).images.size(), 1U);
    LoadOptions options;
    options.maxTexture = 1;
    const Scene scene = load(builder, options);
    ASSERT_EQ(scene.images.size(), 2U);
    const Material& material = scene.materials[0];
    EXPECT_EQ(material.textures[kSlotBaseColor]->image, material.textures[kSlotEmissive]->image);
    EXPECT_EQ(scene.images[material.textures[kSlotBaseColor]->image].pixels->rgba8, (Texels{188, 188, 188, 255}));
    EXPECT_EQ(scene.images[material.textures[kSlotMetallicRoughness]->image].pixels->rgba8, (Texels{128, 128, 128, 255}));
}

// Two sets of any number, each with its texture.
TEST(GltfTextures, AnyTwoSetsOfTextureCoordinates)
{
    const auto loadSets = [](int color, int emission, int normal) {
        GltfBuilder builder = texturedTriangle({{"uri", base64Uri("image/png", redPng())}});
        json& material = builder.document["materials"][0];
        material["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = color;
        material["emissiveTexture"] = {{"index", 0}, {"texCoord", emission}};
        material["occlusionTexture"] = {{"index", 0}, {"texCoord", 5}};  // nobody reads it
        if (normal >= 0) {
            material["normalTexture"] = {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"texCoord", normal}}}}}};
        }
        return load(builder);
    };
    const auto coordinateOf = [](const Scene& scene, const std::optional<Texture>& texture) {
        return (texture->uvSet == 0 ? scene.meshes[0].uv0 : scene.meshes[0].uv1).at(0).x;
    };
    for (const auto& [color, emission] : {std::pair(0, 0), {0, 1}, {1, 0}, {2, 2}, {0, 3}, {4, 1}, {5, 2}}) {
        const Scene scene = loadSets(color, emission, -1);
        EXPECT_EQ(coordinateOf(scene, scene.materials[0].textures[kSlotBaseColor]), static_cast<float>(color));
        EXPECT_EQ(coordinateOf(scene, scene.materials[0].textures[kSlotEmissive]), static_cast<float>(emission));
        EXPECT_FALSE(hasWarning(scene.warnings, MessageId::TooManyUvSets));
    }
    const Scene scene = loadSets(1, 2, 4);
    EXPECT_EQ(coordinateOf(scene, scene.materials[0].textures[kSlotEmissive]), 2.0F);
    EXPECT_EQ(coordinateOf(scene, scene.materials[0].textures[kSlotNormal]), 1.0F);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::TooManyUvSets).place, "materials[0]");
}

// Six faces, whose left halves are of one value and whose right halves of another.
GltfBuilder litByImages(const std::vector<std::pair<int, int>>& halves, bool jpeg = false)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    json faces = json::array();
    for (const auto& [left, right] : halves) {
        Bytes values;
        for (int i = 0; i < 16 * 16; ++i) {
            values.push_back(static_cast<unsigned char>(i % 16 < 8 ? left : right));
        }
        const Bytes file = jpeg ? encodeJpeg(16, 16, values, JpegColors::Grey) : encodePng(16, 16, values, {PNG_COLOR_TYPE_GRAY});
        faces.push_back(builder.append("images", {{"uri", base64Uri("image/png", file)}}));
    }
    builder.document["extensions"]["EXT_lights_image_based"]["lights"] = {
        {{"intensity", 3}, {"specularImages", {faces}}, {"specularImageSize", 16}, {"irradianceCoefficients", json::array()}}};
    builder.document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
    return builder;
}

float linear(int value) { return static_cast<float>(std::pow((value / 255.0 + 0.055) / 1.055, 2.4)); }

// Of the direction (x, y, z): lib/lat_long.glsl.
float radianceTowards(const RadianceMap& map, double x, double y, double z)
{
    constexpr double kPi = 3.14159265358979323846;
    const double u = 0.5 + std::atan2(x, -z) / (2.0 * kPi), v = std::acos(y / std::sqrt(x * x + y * y + z * z)) / kPi;
    const auto column = std::min(static_cast<std::uint32_t>(u * map.width), map.width - 1);
    return map.texels[std::min(static_cast<std::uint32_t>(v * map.height), map.height - 1) * map.width + column].x;
}

const std::vector<std::pair<int, int>> kFaces{{40, 60}, {80, 100}, {120, 140}, {160, 180}, {200, 210}, {220, 230}};

// Seen from inside, each face is where its axis points, and its left half is to the left.
TEST(GltfTextures, FacesOfACubeLightTheScene)
{
    const Scene scene = load(litByImages(kFaces));
    ASSERT_TRUE(scene.environment && scene.environment->map);
    EXPECT_EQ(scene.environment->radiance, glm::vec3(3.0F));
    const RadianceMap& map = *scene.environment->map;
    EXPECT_EQ(map.width, 64U);
    EXPECT_EQ(map.height, 32U);
    const double s = 0.5;
    const std::pair<glm::dvec3, int> expected[] = {{{1, 0, -s}, 40}, {{1, 0, s}, 60},   {{-1, 0, s}, 80},   {{-1, 0, -s}, 100},
                                                   {{s, 1, 0}, 120}, {{-s, 1, 0}, 140}, {{s, -1, 0}, 160},  {{-s, -1, 0}, 180},
                                                   {{s, 0, 1}, 200}, {{-s, 0, 1}, 210}, {{-s, 0, -1}, 220}, {{s, 0, -1}, 230}};
    for (const auto& [w, value] : expected) {
        EXPECT_NEAR(radianceTowards(map, w.x, w.y, w.z), linear(value), 1e-4F) << w.x << " " << w.y << " " << w.z;
    }
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::ExtensionIgnored));
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::StudioLight));
    const Scene jpegs = load(litByImages(kFaces, true));
    EXPECT_NEAR(radianceTowards(*jpegs.environment->map, 1, 0, -s), linear(40), 0.01F);
    LoadOptions dark;
    dark.environment = BuiltInEnvironment::None;
    EXPECT_FALSE(load(litByImages(kFaces), dark).environment);
}

// A quarter turn to the left about +y takes what was at -z to -x.
TEST(GltfTextures, LightsOfImagesAreTurned)
{
    GltfBuilder builder = litByImages(kFaces);
    const double half = std::sqrt(0.5);
    builder.document["extensions"]["EXT_lights_image_based"]["lights"][0]["rotation"] = {0, half, 0, half};
    const RadianceMap map = *load(builder).environment->map;
    EXPECT_NEAR(radianceTowards(map, -1, 0, 0.5), linear(220), 1e-4F);
    EXPECT_NEAR(radianceTowards(map, -1, 0, -0.5), linear(230), 1e-4F);
}

// A PNG with alpha holds what colours are divided by.
TEST(GltfTextures, FacesWithAlphaAreDividedByIt)
{
    GltfBuilder builder = litByImages(kFaces);
    Bytes values;
    for (int i = 0; i < 16 * 16; ++i) {
        values.insert(values.end(), {200, 100, 50, 51});
    }
    builder.document["images"][4]["uri"] = base64Uri("image/png", encodePng(16, 16, values, {PNG_COLOR_TYPE_RGBA}));
    const Scene scene = load(builder);
    EXPECT_NEAR(radianceTowards(*scene.environment->map, 0, 0, 1), 5.0F * linear(200), 1e-4F);
}

TEST(GltfTextures, BrokenFacesAreNamed)
{
    const std::string place = "extensions.EXT_lights_image_based.lights[0]";
    GltfBuilder broken = litByImages(kFaces);
    broken.document["images"][2]["uri"] = "data:image/png;base64,AAEC";
    expectRefused(broken, MessageId::UnknownFormat, {.place = "images[2]"});
    GltfBuilder five = litByImages({kFaces.begin(), kFaces.begin() + 5});
    expectRefused(five, MessageId::Mismatch, {.place = place + ".specularImages[0]"});
    GltfBuilder oblong = litByImages(kFaces);
    oblong.document["images"][1]["uri"] = base64Uri("image/png", encodePng(2, 1, {0, 0, 0, 255, 255, 255}));
    expectRefused(oblong, MessageId::Mismatch, {.place = place + ".specularImages[0][1]", .value = "2x1"});
    GltfBuilder small = litByImages(kFaces);
    small.document["images"][5]["uri"] = base64Uri("image/png", redPng());
    expectRefused(small, MessageId::Mismatch, {.place = place + ".specularImages[0][5]", .value = "1", .expected = "16"});
    GltfBuilder wrong = litByImages(kFaces);
    wrong.document["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 1;
    expectRefused(wrong, MessageId::DanglingIndex, {.place = "scenes[0].extensions.EXT_lights_image_based.light", .value = "1"});
    LoadOptions other;
    other.environment = glm::vec3(1.0F);
    EXPECT_TRUE(load(broken, other).environment) << "nobody reads the faces";
}

TEST(GltfTextures, RequiredExtensionsAreRefusedIfContentMayBeMissing)
{
    const auto require = [](const char* extension) {
        GltfBuilder builder;
        builder.addNode({{"mesh", builder.addTriangleMesh()}});
        builder.document["extensionsRequired"] = {extension};
        builder.document["extensionsUsed"] = {extension};
        return builder;
    };
    for (const char* extension : {"KHR_gaussian_splatting_compression_spz", "VENDOR_unknown"}) {
        expectRefused(require(extension), MessageId::Unsupported, {.place = "extensionsRequired", .value = extension});
    }
    for (const char* extension :
         {"KHR_materials_unlit", "KHR_node_visibility", "KHR_mesh_quantization", "KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
        EXPECT_FALSE(hasWarning(load(require(extension)).warnings, MessageId::ExtensionIgnored)) << extension << " is supported";
    }
    for (const char* extension : {"KHR_animation_pointer", "KHR_xmp", "KHR_xmp_json_ld", "KHR_node_hoverability", "KHR_node_selectability",
                                  "KHR_interactivity", "EXT_mesh_features", "KHR_audio_emitter", "KHR_physics_rigid_bodies", "MSFT_lod"}) {
        EXPECT_FALSE(hasWarning(load(require(extension)).warnings, MessageId::ExtensionIgnored))
            << extension << " changes no still picture";
    }
    for (const char* extension : {"EXT_lights_ies", "KHR_lights_area"}) {
        EXPECT_EQ(findWarning(load(require(extension)).warnings, MessageId::ExtensionIgnored).place, extension);
    }
}

TEST(GltfTextures, RequiredExtensionsOfMaterialsAreSaidToBeIgnored)
{
    GltfBuilder builder = texturedTriangle({{"uri", base64Uri("image/png", redPng())}});
    builder.document["extensionsRequired"] = {"KHR_materials_to_come"};
    builder.document["materials"][0]["extensions"]["KHR_materials_to_come"] = {{"glow", 1}};
    expectMessage(findWarning(load(builder).warnings, MessageId::ExtensionIgnored), MessageId::ExtensionIgnored,
                  {.place = "materials[0]", .value = "KHR_materials_to_come"});
}

TEST(GltfTextures, ScatteringWithoutSolidsIsSaidToBeIgnored)
{
    GltfBuilder builder = texturedTriangle({{"uri", base64Uri("image/png", redPng())}});
    builder.document["extensionsRequired"] = {"KHR_materials_volume_scatter"};
    json& extension = builder.document["materials"][0]["extensions"]["KHR_materials_volume_scatter"];
    extension = {{"multiscatterColor", {0.5, 0.25, 1}}, {"scatterAnisotropy", 0.5}};
    expectMessage(findWarning(load(builder).warnings, MessageId::ExtensionIgnored), MessageId::ExtensionIgnored,
                  {.place = "materials[0]", .value = "KHR_materials_volume_scatter"});
    extension["scatterAnisotropy"] = 2;
    expectRefused(
        builder, MessageId::OutOfRange,
        {.place = "materials[0].extensions.KHR_materials_volume_scatter.scatterAnisotropy", .value = "2", .expected = "from -1 to 1"});
}

TEST(GltfTextures, TexturesWithinVolumesAreSaidToBeIgnored)
{
    GltfBuilder builder = texturedTriangle({{"uri", base64Uri("image/png", redPng())}});
    json& extensions = builder.document["materials"][0]["extensions"];
    extensions["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    extensions["KHR_materials_volume"] = {{"thicknessFactor", 1}};
    extensions["KHR_materials_scatter"] = {{"multiscatterColorTexture", {{"index", 0}}}};
    expectMessage(findWarning(load(builder).warnings, MessageId::VolumeTextureIgnored), MessageId::VolumeTextureIgnored,
                  {.place = "materials[0]"});
    extensions["KHR_materials_volume"]["thicknessFactor"] = 0;
    const Material thin = load(builder).materials[0];
    EXPECT_TRUE(thin.textures[kSlotDiffuseTransmissionColor]);
    EXPECT_FALSE(thin.textures[kSlotDiffuseTransmission]);
}

TEST(GltfTextures, InvisibleNodesAndWhatHangsBelowAreLeftOut)
{
    GltfBuilder builder;
    const std::size_t mesh = builder.addTriangleMesh();
    builder.addNode({{"mesh", mesh}});
    const std::size_t child = builder.append("nodes", {{"mesh", mesh}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
    builder.addNode(
        {{"name", "ghost"}, {"mesh", mesh}, {"children", {child}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    builder.document["extensionsRequired"] = {"KHR_node_visibility"};
    const Scene scene = load(builder);
    EXPECT_EQ(scene.instances.size(), 1U);
    EXPECT_EQ(findWarning(scene.warnings, MessageId::InvisibleNode).place, "nodes[2] (\"ghost\")");
}

TEST(GltfTextures, OfInvisibleNodesCamerasAreKeptAndLightsAreNot)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}});
    const std::size_t child =
        builder.append("nodes", {{"camera", 0}, {"translation", {0, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    builder.addNode({{"children", {child}}, {"translation", {0, 0, 1}}});
    EXPECT_EQ(load(builder).lights.size(), 1U);
    builder.document["nodes"].back()["extensions"]["KHR_node_visibility"]["visible"] = false;
    const Scene scene = load(builder);
    EXPECT_EQ(scene.lights.size(), 0U);
    EXPECT_FALSE(hasWarning(scene.warnings, MessageId::FramedCamera));
    EXPECT_EQ(scene.cameras.size(), 1U);
}

}  // namespace
}  // namespace glim::test
