// Files as exporters write them: what is valid is drawn, what rounding has spoilt is mended with one warning a kind, what has no meaning is
// refused.
#include "host/error.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "host/scene/read_camera_file.hpp"
#include "tests/support/encode_images.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::test {
namespace {

using nlohmann::json;

GltfBuilder withMaterial(const json& material)
{
    GltfBuilder builder = oneTriangle();
    builder.append("materials", material);
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    return builder;
}

GltfBuilder withLight(const json& light)
{
    GltfBuilder builder = oneTriangle();
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = json::array({light});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    return builder;
}

GltfBuilder withSpot(double inner, double outer)
{
    return withLight({{"type", "spot"}, {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}});
}

GltfBuilder withCamera(const json& camera)
{
    GltfBuilder builder = oneTriangle();
    builder.append("cameras", camera);
    builder.addNode({{"camera", 0}});
    return builder;
}

GltfBuilder orthographic(double xmag, double ymag)
{
    return withCamera({{"type", "orthographic"}, {"orthographic", {{"xmag", xmag}, {"ymag", ymag}, {"znear", 0}, {"zfar", 10}}}});
}

// Without the studio, which takes longer than the rest.
Scene loadDark(const GltfBuilder& builder)
{
    LoadOptions options;
    options.environment = BuiltInEnvironment::None;
    return load(builder, options);
}

std::string placeOf(const Scene& scene, MessageId id) { return findWarning(scene.warnings, id).place; }

TEST(GltfExporters, MissingColoursAreBlackAndOpaque)
{
    for (const char* type : {"VEC3", "VEC4"}) {
        GltfBuilder builder = oneTriangle();
        const bool opaque = std::string(type) == "VEC3";
        const std::vector<float> value(opaque ? 3 : 4, 0.5F);
        const json sparse = {{"count", 1},
                             {"indices", {{"bufferView", builder.addAov({1})}, {"componentType", kUnsignedByte}}},
                             {"values", {{"bufferView", builder.addAov(toBytes(value))}}}};
        const std::size_t colors =
            builder.append("accessors", {{"componentType", kFloat}, {"type", type}, {"count", 3}, {"sparse", sparse}});
        builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = colors;
        const Scene scene = loadDark(builder);
        EXPECT_EQ(scene.meshes.at(0).colors.at(0), glm::vec4(0, 0, 0, opaque ? 1 : 0)) << type;
        EXPECT_EQ(scene.meshes.at(0).colors.at(1), glm::vec4(0.5F, 0.5F, 0.5F, opaque ? 1.0F : 0.5F)) << type;
        builder.document["accessors"][colors]["sparse"]["count"] = 0;
        EXPECT_EQ(loadDark(builder).meshes.at(0).colors.at(1), glm::vec4(0, 0, 0, opaque ? 1 : 0)) << "nothing is replaced";
    }
}

TEST(GltfExporters, FactorsAreClampedIfTheyAreOffByRounding)
{
    const double justAboveOne = 1.0 + std::ldexp(1.0, -23);
    const json material = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {1.00016, 0.5, 256.0 / 255.0, 1}}, {"metallicFactor", justAboveOne}, {"roughnessFactor", -1e-9}}},
        {"emissiveFactor", {-1e-7, 0, 2}},
        {"extensions", {{"KHR_materials_ior", {{"ior", 0.9999999}}}}}};
    const Scene scene = loadDark(withMaterial(material));
    const Material& read = scene.materials.at(0);
    EXPECT_EQ(read.baseColor, glm::vec3(1.0F, 0.5F, 1.0F));
    EXPECT_EQ(read.metallic, 1.0F);
    EXPECT_EQ(read.roughness, 0.0F);
    EXPECT_EQ(read.emission, glm::vec3(0, 0, 2));
    EXPECT_EQ(read.ior, 1.0F);
    EXPECT_EQ(placeOf(scene, MessageId::NumberClamped),
              "materials[0].pbrMetallicRoughness.baseColorFactor[0] 1.00016, "
              "materials[0].pbrMetallicRoughness.baseColorFactor[2] 1.003921568627451, "
              "materials[0].pbrMetallicRoughness.metallicFactor 1.0000001192092896 and 3 more");
    expectRefused(withMaterial({{"pbrMetallicRoughness", {{"metallicFactor", 1.01}}}}), MessageId::OutOfRange,
                  {.place = "materials[0].pbrMetallicRoughness.metallicFactor", .value = "1.01", .expected = "from 0 to 1"});
    expectRefused(withMaterial({{"extensions", {{"KHR_materials_volume", {{"attenuationDistance", -0.001}}}}}}), MessageId::OutOfRange,
                  {.place = "materials[0].extensions.KHR_materials_volume.attenuationDistance", .value = "-0.001", .expected = "above 0"});
}

TEST(GltfExporters, ZerosThatStandForNoValue)
{
    const Scene lit = loadDark(withLight({{"type", "point"}, {"range", 0}}));
    EXPECT_EQ(lit.lights.at(0).range, 0.0F);
    EXPECT_EQ(placeOf(lit, MessageId::ZeroIgnored), "extensions.KHR_lights_punctual.lights[0].range");
    json camera = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"aspectRatio", 0.0}, {"znear", 0}}}};
    const Scene seen = loadDark(withCamera(camera));
    EXPECT_FALSE(seen.cameras.at(0).aspectRatio);
    EXPECT_EQ(placeOf(seen, MessageId::ZeroIgnored), "cameras[0].perspective.aspectRatio");
    camera["perspective"]["yfov"] = 3.1415927;
    expectRefused(withCamera(camera), MessageId::OutOfRange,
                  {.place = "cameras[0].perspective.yfov", .value = "3.1415927", .expected = "above 0 to 3.14"});
    const Scene glass = loadDark(withMaterial(
        {{"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 0}, {"attenuationColor", {0.5, 0.5, 0.5}}}}}}}));
    EXPECT_EQ(glass.materials.at(0).absorption, glm::vec3(0.0F));
    GltfBuilder strided = oneTriangle();
    strided.document["bufferViews"][0]["byteStride"] = 0;
    EXPECT_EQ(placeOf(loadDark(strided), MessageId::ZeroIgnored), "bufferViews[0].byteStride");
}

TEST(GltfExporters, IndicesMayHaveAStride)
{
    GltfBuilder builder = oneTriangle();
    const std::size_t indices = builder.addAccessor(toBytes<std::uint16_t>({2, 0, 1}), kUnsignedShort, "SCALAR", 3);
    builder.document["bufferViews"].back()["byteStride"] = 2;
    builder.document["meshes"][0]["primitives"][0]["indices"] = indices;
    const Scene scene = loadDark(builder);
    EXPECT_EQ(scene.meshes.at(0).indices, (std::vector<std::uint32_t>{2, 0, 1}));
}

// KHR_lights_punctual: the outer angle may be pi / 2, which a float32 rounds up.
TEST(GltfExporters, ConesThatAreEqualOrRoundedHaveAHardEdge)
{
    const double angle = 0.4636476090008061;
    const auto cone = [](const Scene& scene) { return std::pair(scene.lights.at(0).versineInner, scene.lights.at(0).versineOuter); };
    const auto outerOf = [](double outer) { return static_cast<float>(2.0 * std::pow(std::sin(0.5 * outer), 2.0)); };
    for (const double inner : {angle, std::nextafter(angle, 1.0), angle - 1e-9}) {
        const Scene scene = loadDark(withSpot(inner, angle));
        EXPECT_EQ(cone(scene), std::pair(std::nextafter(outerOf(angle), 0.0F), outerOf(angle))) << inner;
        EXPECT_FALSE(hasWarning(scene.warnings, MessageId::ConeClamped)) << "they are equal as floats";
    }
    const Scene rounded = loadDark(withSpot(1.001 * angle, angle));
    EXPECT_EQ(cone(rounded).first, std::nextafter(outerOf(angle), 0.0F));
    EXPECT_EQ(placeOf(rounded, MessageId::ConeClamped), "lights[0]");
    const Scene wide = loadDark(withSpot(0.0, static_cast<double>(static_cast<float>(std::numbers::pi / 2.0))));
    EXPECT_EQ(cone(wide), std::pair(0.0F, outerOf(std::numbers::pi / 2.0)));
    EXPECT_EQ(placeOf(wide, MessageId::NumberClamped), "extensions.KHR_lights_punctual.lights[0].spot.outerConeAngle 1.5707963705062866");
    expectRefused(withSpot(0.5, 0.25), MessageId::OutOfRange, {.place = "lights[0]", .value = "0.5", .expected = "0.25"});
    expectRefused(withSpot(0.0, 1.6), MessageId::OutOfRange,
                  {.place = "extensions.KHR_lights_punctual.lights[0].spot.outerConeAngle", .value = "1.6", .expected = "above 0"});
}

// glTF 2.0, section 3.10.3.1: the projection divides by xmag and ymag, so that negative ones mirror the picture.
TEST(GltfExporters, OrthographicCamerasMayBeMirrored)
{
    for (const auto& [xmag, ymag] : {std::pair(2.0, 3.0), {-2.0, 3.0}, {2.0, -3.0}, {-2.0, -3.0}, {3.0, 3.0}}) {
        const Scene scene = loadDark(orthographic(xmag, ymag));
        const Camera& camera = scene.cameras.at(0);
        EXPECT_FLOAT_EQ(camera.aspectRatio.value_or(0.0F), static_cast<float>(std::abs(xmag / ymag)));
        const FlatCamera flat = flattenCamera(camera, *camera.aspectRatio);
        EXPECT_FLOAT_EQ(flat.right.x, static_cast<float>(xmag));
        EXPECT_FLOAT_EQ(flat.up.y, static_cast<float>(ymag));
    }
    expectRefused(orthographic(0.0, 1.0), MessageId::OutOfRange, {.place = "cameras[0]", .value = "0"});
}

TEST(GltfExporters, LastRowsOfMatricesAreRounded)
{
    for (const auto& [at, value] : {std::pair(15, 0.9999999), {15, 1.00005}, {3, 1e-17}, {11, -1e-6}}) {
        GltfBuilder builder = oneTriangle();
        json& matrix = builder.document["nodes"][0]["matrix"];
        matrix = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
        matrix[static_cast<std::size_t>(at)] = value;
        const Scene scene = loadDark(builder);
        const glm::dmat4 expected(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 2, 0, 0), glm::dvec4(0, 0, 1, 0), glm::dvec4(5, 6, 7, 1));
        EXPECT_EQ(scene.instances.at(0).worldFromMesh, expected) << value;
        EXPECT_EQ(placeOf(scene, MessageId::MatrixRounded), "nodes[0]");
        matrix[static_cast<std::size_t>(at)] = value < 0.5 ? 0.001 : 0.999;
        expectRefused(builder, MessageId::OutOfRange, {.place = "nodes[0].matrix", .expected = "0 0 0 1"});
    }
}

TEST(GltfExporters, MatricesOfCameraFilesToo)
{
    const auto read = [](double last) {
        const json cameras = json::array({{{"matrix", {1, 0, 0, 0, 0, 1, 0, 1e-17, 0, 0, 1, 0, 5, 6, 7, last}}}});
        return readCameraFile(writeTemporary("cameras.json", cameras.dump())).at(0).pose.value_or(Pose());
    };
    EXPECT_EQ(read(0.9999999).from, glm::dvec3(5, 6, 7));
    EXPECT_EQ(read(0.9999999).at, glm::dvec3(5, 6, 6));
    expectRefusal<InputError>([&] { read(0.999); }, MessageId::Degenerate, {.file = "cameras.json", .place = "[0].matrix"});
}

TEST(GltfExporters, CamerasByOpenCvsAxesLookTheOtherWay)
{
    json camera = {{"matrix", {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 5, 6, 7, 1}}};
    const auto read = [&camera] { return readCameraFile(writeTemporary("cameras.json", json::array({camera}).dump())).at(0).pose.value(); };
    camera["axes"] = "gltf";
    EXPECT_EQ(read().at, glm::dvec3(4, 6, 7));
    EXPECT_EQ(read().up, glm::dvec3(0, 1, 0));
    camera["axes"] = "opencv";
    EXPECT_EQ(read().at, glm::dvec3(6, 6, 7));
    EXPECT_EQ(read().up, glm::dvec3(0, -1, 0));
    camera["axes"] = "blender";
    expectRefusal<InputError>(read, MessageId::UnknownName, {.file = "cameras.json", .place = "[0].axes"});
    camera = {{"axes", "opencv"}};
    expectRefusal<InputError>(read, MessageId::Requires, {.file = "cameras.json", .place = "[0]"});
}

TEST(GltfExporters, MembersThatAreNullCountAsLeftOut)
{
    GltfBuilder builder = withMaterial({{"name", nullptr},
                                        {"normalTexture", nullptr},
                                        {"pbrMetallicRoughness", {{"baseColorFactor", nullptr}, {"metallicFactor", 0.5}}},
                                        {"extensions", nullptr}});
    builder.document["nodes"][0]["extras"] = {{"mine", nullptr}};
    builder.document["animations"] = nullptr;
    const Scene scene = loadDark(builder);
    EXPECT_EQ(scene.materials.at(0).baseColor, glm::vec3(1.0F));
    EXPECT_EQ(scene.materials.at(0).metallic, 0.5F);
    EXPECT_EQ(placeOf(scene, MessageId::NullIgnored), "animations, materials[0].extensions, materials[0].name and 2 more");
    builder.document["accessors"][0]["count"] = nullptr;
    expectRefused(builder, MessageId::Missing, {.place = "accessors[0].count"});
}

TEST(GltfExporters, WholeNumbersMayBeWrittenWithAPoint)
{
    GltfBuilder builder = withMaterial(json::object());
    builder.document["accessors"][0]["count"] = 3.0;
    builder.document["accessors"][0]["componentType"] = 5126.0;
    builder.document["bufferViews"][0]["byteOffset"] = -0.0;
    builder.document["nodes"][0]["mesh"] = 0.0;
    builder.document["scenes"][0]["nodes"][0] = 0.0;
    builder.document["scene"] = 0.0;
    EXPECT_EQ(loadDark(builder).instances.size(), 1U);
    builder.document["nodes"][0]["mesh"] = 0.5;
    expectRefused(builder, MessageId::DanglingIndex, {.place = "nodes[0].mesh", .value = "0.5", .expected = "meshes"});
}

TEST(GltfExporters, NothingMayBeEmptyThatIsRead)
{
    GltfBuilder builder = oneTriangle();
    const std::size_t view = builder.append("bufferViews", {{"buffer", 0}, {"byteLength", 0}});
    const std::size_t empty =
        builder.append("accessors", {{"bufferView", view}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 0}});
    builder.otherBuffers.push_back({{"byteLength", 0}});
    EXPECT_EQ(loadDark(builder).warnings.size(), loadDark(oneTriangle()).warnings.size()) << "nobody reads it";
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", empty}}}})}});
    const Scene scene = loadDark(builder);
    EXPECT_EQ(scene.instances.size(), 1U);
    EXPECT_EQ(placeOf(scene, MessageId::EmptyMesh), "meshes[1].primitives[0]");
    builder.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = empty;
    expectRefused(builder, MessageId::OutOfRange, {.place = "accessors[1] (NORMAL of meshes[0].primitives[0]).count", .value = "0"});
}

TEST(GltfExporters, SamplersOfUnknownFiltersAndWraps)
{
    const auto textureOf = [](const json& sampler) {
        GltfBuilder builder = withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        builder.append("images", {{"bufferView", builder.addAov(encodePng(1, 1, {1, 2, 3}))}});
        builder.append("samplers", sampler);
        builder.append("textures", {{"source", 0}, {"sampler", 0}});
        return loadDark(builder);
    };
    const Scene linear = textureOf({{"magFilter", 9987}, {"wrapS", 33071}});
    EXPECT_FALSE(linear.materials.at(0).textures[kSlotBaseColor]->nearest);
    EXPECT_EQ(linear.materials.at(0).textures[kSlotBaseColor]->wrapS, Wrap::Clamp);
    EXPECT_EQ(placeOf(linear, MessageId::UnknownSampler), "samplers[0].magFilter 9987");
    EXPECT_TRUE(textureOf({{"magFilter", 9984}}).materials.at(0).textures[kSlotBaseColor]->nearest);
    EXPECT_TRUE(textureOf({{"magFilter", 0}, {"minFilter", 9728}}).materials.at(0).textures[kSlotBaseColor]->nearest) << "as without the 0";
    const Scene unknown = textureOf({{"minFilter", -1}, {"wrapT", 10496}});  // GL_CLAMP
    EXPECT_EQ(unknown.materials.at(0).textures[kSlotBaseColor]->wrapT, Wrap::Repeat);
    EXPECT_EQ(placeOf(unknown, MessageId::UnknownSampler), "samplers[0].minFilter -1, samplers[0].wrapT 10496");
    EXPECT_FALSE(hasWarning(textureOf({{"magFilter", 9728}, {"minFilter", 9987}, {"wrapS", 33648}}).warnings, MessageId::UnknownSampler));
}

TEST(GltfExporters, OnePrimitiveMayLackTheTargetsOfAnother)
{
    GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0}), deltas = builder.addVec3({0, 0, 2, 0, 0, 2, 0, 0, 2});
    const json still = {{"attributes", {{"POSITION", positions}}}};
    json moving = still;
    moving["targets"] = json::array({{{"POSITION", deltas}}, {{"POSITION", deltas}}});
    const std::size_t mesh = builder.append("meshes", {{"primitives", {still, moving}}, {"weights", {0.5, 1}}});
    builder.addNode({{"mesh", mesh}});
    const Scene scene = loadDark(builder);
    EXPECT_EQ(scene.meshes.at(0).positions.at(0).z, 0.0);
    EXPECT_EQ(scene.meshes.at(1).positions.at(0).z, 3.0);
    EXPECT_EQ(scene.morphTargets, 2U);
    EXPECT_EQ(placeOf(scene, MessageId::MissingMorphTarget), "meshes[0].primitives[0]");
    builder.document["meshes"][mesh]["weights"] = {0.5, 1, 1};
    expectRefused(builder, MessageId::Mismatch, {.place = "meshes[0].primitives[0]", .value = "0 morph targets"});
}

TEST(GltfExporters, WeightsJustBelowZeroCountAsZero)
{
    GltfBuilder builder = posedTriangle();
    json& attributes = builder.document["meshes"][0]["primitives"][0]["attributes"];
    attributes["WEIGHTS_0"] = builder.addAccessor(toBytes<float>({1, -1e-9F, 0, 0, 1, 0, 0, 0, 1, 0, -5e-4F, 0}), kFloat, "VEC4", 3);
    EXPECT_EQ(placeOf(loadDark(builder), MessageId::WeightsClamped), "meshes[0].primitives[0]");
}

TEST(GltfExporters, OldFilesAreCalledSo)
{
    for (const json& document : {json{{"asset", {{"version", "1.0"}}}, {"nodes", json::object()}}, json{{"asset", {{"version", 1.1}}}},
                                 json{{"accessors", {{"accessor_1", json::object()}}}, {"meshes", json::object()}}}) {
        expectRefusal<InputError>([&] { loadText(document.dump()); }, MessageId::UnknownFormat,
                                  {.file = "scene.gltf", .value = "glTF 1.0", .expected = "glTF 2.0"});
    }
}

TEST(GltfExporters, AUrlIsNoFile)
{
    GltfBuilder builder = oneTriangle();
    builder.otherBuffers.push_back({{"byteLength", 4}, {"uri", "https://example.org/a.bin"}});
    expectRefused(builder, MessageId::Unsupported, {.place = "buffers[1].uri", .value = "https://example.org/a.bin"});
    expectRefusal<InputError>([] { loadGltf("https://example.org/a.glb"); }, MessageId::Unsupported,
                              {.file = "https://example.org/a.glb", .value = "a URL"});
}

}  // namespace
}  // namespace glim::test
