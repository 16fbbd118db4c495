// Every way in which glTF may store the same triangle.
#include "host/flatten/primitives.hpp"
#include "tests/support/gltf_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace glim::test {
namespace {

using nlohmann::json;

Scene loadPositions(GltfBuilder& builder, std::size_t accessor)
{
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", accessor}}}})}});
    return load(builder);
}

template <typename Component>
void expectIntegers(int componentType, bool normalized, double one)
{
    SCOPED_TRACE(componentType);
    const auto low = std::numeric_limits<Component>::min(), high = std::numeric_limits<Component>::max();
    // Padded to a multiple of four bytes, as the specification demands of vertex attributes.
    constexpr std::size_t kStride = (3 * sizeof(Component) + 3) / 4 * 4 / sizeof(Component);
    std::vector<Component> values(3 * kStride);
    values[0] = low;
    values[kStride] = high;
    values[2 * kStride + 1] = 64;
    GltfBuilder builder;
    const std::size_t accessor = builder.addAccessor(toBytes(values), componentType, "VEC3", 3);
    builder.document["bufferViews"][0]["byteStride"] = kStride * sizeof(Component);
    builder.document["accessors"][accessor]["normalized"] = normalized;
    const Scene scene = loadPositions(builder, accessor);
    const auto expected = [&](double value) { return static_cast<float>(normalized ? std::max(value / one, -1.0) : value); };
    const auto width = static_cast<float>(expected(high) - expected(low));
    EXPECT_FLOAT_EQ(vertex(scene, 0, 1).x - vertex(scene, 0, 0).x, width);
    EXPECT_NEAR(vertex(scene, 0, 0).x, expected(low), 1e-6F * width);
    EXPECT_NEAR(vertex(scene, 0, 2).y, expected(64), 1e-6F * width);
}

TEST(GltfAccessor, ReadsEveryIntegerType)
{
    expectIntegers<std::int8_t>(kByte, false, 127);
    expectIntegers<std::uint8_t>(kUnsignedByte, false, 255);
    expectIntegers<std::int16_t>(kShort, false, 32767);
    expectIntegers<std::uint16_t>(kUnsignedShort, false, 65535);
}

TEST(GltfAccessor, NormalisesIntegersAndClampsTheLowest)
{
    expectIntegers<std::int8_t>(kByte, true, 127);
    expectIntegers<std::uint8_t>(kUnsignedByte, true, 255);
    expectIntegers<std::int16_t>(kShort, true, 32767);
    expectIntegers<std::uint16_t>(kUnsignedShort, true, 65535);
}

TEST(GltfAccessor, ReadsInterleavedAttributesWithOffsets)
{
    // Position, then normal, 24 bytes a vertex.
    const std::vector<float> values = {0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0.6F, 0.8F, 0, 3, 0, 0, 0, 5};
    GltfBuilder builder;
    const std::size_t view = builder.addAov(toBytes(values));
    builder.document["bufferViews"][view]["byteStride"] = 24;
    json accessor = {{"bufferView", view}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}};
    const std::size_t positions = builder.append("accessors", accessor);
    accessor["byteOffset"] = 12;
    const std::size_t normals = builder.append("accessors", accessor);
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}})}});
    const Scene scene = load(builder);
    EXPECT_EQ(vertex(scene, 0, 1), glm::vec3(2, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 2), glm::vec3(0, 3, 0));
    EXPECT_EQ(normal(scene, 0, 1), glm::vec3(0, 0.6F, 0.8F));
    EXPECT_EQ(normal(scene, 0, 2), glm::vec3(0, 0, 1)) << "of unit length again";
}

json sparseOf(GltfBuilder& builder, const Bytes& indices, int indexType, const std::vector<float>& values)
{
    return {{"count", values.size() / 3},
            {"indices", {{"bufferView", builder.addAov(indices)}, {"componentType", indexType}}},
            {"values", {{"bufferView", builder.addAov(toBytes(values))}}}};
}

TEST(GltfAccessor, ReplacesSparseElements)
{
    GltfBuilder builder;
    const std::size_t accessor = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.document["accessors"][accessor]["sparse"] =
        sparseOf(builder, toBytes<std::uint16_t>({0, 2}), kUnsignedShort, {-4, 0, 0, 0, 6, 0});
    const Scene scene = loadPositions(builder, accessor);
    EXPECT_EQ(vertex(scene, 0, 0), glm::vec3(-4, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 1), glm::vec3(1, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 2), glm::vec3(0, 6, 0));
}

TEST(GltfAccessor, SparseWithoutBufferViewStartsFromZeros)
{
    GltfBuilder builder;
    json accessor = {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}};
    accessor["sparse"] = sparseOf(builder, toBytes<std::uint8_t>({1, 2}), kUnsignedByte, {5, 0, 0, 0, 6, 0});
    const Scene scene = loadPositions(builder, builder.append("accessors", accessor));
    EXPECT_EQ(vertex(scene, 0, 0), glm::vec3(0, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 1), glm::vec3(5, 0, 0));
    EXPECT_EQ(vertex(scene, 0, 2), glm::vec3(0, 6, 0));
}

TEST(GltfAccessor, SparseIndicesWithoutBufferViewAreReadToo)
{
    GltfBuilder builder;
    json indices = {{"componentType", kUnsignedShort}, {"type", "SCALAR"}, {"count", 3}};
    indices["sparse"] = {{"count", 2},
                         {"indices", {{"bufferView", builder.addAov({1, 2})}, {"componentType", kUnsignedByte}}},
                         {"values", {{"bufferView", builder.addAov(toBytes<std::uint16_t>({2, 1}))}}}};
    const std::size_t accessor = builder.append("accessors", indices);
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}})}});
    EXPECT_EQ(vertex(load(builder), 0, 1), glm::vec3(0, 1, 0));
}

TEST(GltfAccessor, ReadsEveryIndexType)
{
    const std::vector<float> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0, 9, 9, 9};
    const std::pair<int, Bytes> indices[] = {{kUnsignedByte, toBytes<std::uint8_t>({2, 0, 1})},
                                             {kUnsignedShort, toBytes<std::uint16_t>({2, 0, 1})},
                                             {kUnsignedInt, toBytes<std::uint32_t>({2, 0, 1})}};
    for (const auto& [type, bytes] : indices) {
        GltfBuilder builder;
        const std::size_t accessor = builder.addAccessor(bytes, type, "SCALAR", 3);
        const std::size_t positions = builder.addVec3(corners);
        builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}})}});
        const Scene scene = load(builder);
        EXPECT_EQ(vertex(scene, 0, 0), glm::vec3(0, 1, 0)) << type;
        EXPECT_EQ(scene.origin, glm::dvec3(0.5, 0.5, 0.0)) << "the unused vertex must not count";
    }
}

// Normal of a triangle that lies in a plane z = const.
float facing(const Scene& scene, std::size_t triangle)
{
    const Triangle t = makePrimitives(scene).triangles.at(triangle);
    return glm::cross(t.vertices[1] - t.vertices[0], t.vertices[2] - t.vertices[0]).z;
}

TEST(GltfAccessor, StripsAndFansFaceOneWay)
{
    const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    const std::vector<float> fan = {0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 2, 0, 0, 2, 0};
    for (const auto& [mode, positions] : {std::pair{5, strip}, std::pair{6, fan}}) {
        GltfBuilder builder;
        const std::size_t accessor = builder.addVec3(positions);
        builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", accessor}}}, {"mode", mode}})}});
        const Scene scene = load(builder);
        ASSERT_EQ(makePrimitives(scene).triangles.size(), 3U);
        float area = 0.0F;
        for (std::size_t t = 0; t < 3; ++t) {
            EXPECT_GT(facing(scene, t), 0.0F) << "mode " << mode << " triangle " << t;
            area += 0.5F * facing(scene, t);
        }
        EXPECT_FLOAT_EQ(area, mode == 5 ? 1.5F : 3.5F);
    }
}

// A triangle with all attributes that a mesh can have; colours are normalised bytes without alpha, texture coordinates normalised shorts.
json everyAttribute(GltfBuilder& builder)
{
    json attributes = {{"POSITION", builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                       {"NORMAL", builder.addVec3({0, 0, 1, 0, 0, 1, 0, 0, 1})}};
    attributes["TANGENT"] = builder.addAccessor(toBytes<float>({1, 0, 0, 1, 0, 1, 0, -1, 1, 0, 0, 1}), kFloat, "VEC4", 3);
    attributes["TEXCOORD_0"] = builder.addAccessor(toBytes<float>({0, 0, 0.25F, 0, 0, 3}), kFloat, "VEC2", 3);
    attributes["TEXCOORD_1"] = builder.addAccessor(toBytes<std::uint16_t>({0, 0, 65535, 0, 0, 13107}), kUnsignedShort, "VEC2", 3);
    builder.document["accessors"].back()["normalized"] = true;
    const std::size_t view = builder.addAov({255, 0, 0, 0, 0, 255, 0, 0, 0, 0, 51, 0});
    builder.document["bufferViews"][view]["byteStride"] = 4;
    attributes["COLOR_0"] = builder.append(
        "accessors", {{"bufferView", view}, {"componentType", kUnsignedByte}, {"type", "VEC3"}, {"count", 3}, {"normalized", true}});
    return attributes;
}

TEST(GltfAccessor, ReadsEveryAttributeOfAMesh)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addMesh({{"attributes", everyAttribute(builder)}})}});
    const Mesh mesh = load(builder).meshes.at(0);
    EXPECT_EQ(mesh.positions.at(1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(mesh.normals.at(2), glm::dvec3(0, 0, 1));
    EXPECT_EQ(mesh.tangents.at(1), glm::vec4(0, 1, 0, -1));
    EXPECT_EQ(mesh.uv0.at(2), glm::vec2(0, 3));
    EXPECT_EQ(mesh.uv1.at(1), glm::vec2(1, 0));
    EXPECT_FLOAT_EQ(mesh.uv1.at(2).y, 0.2F);
    EXPECT_EQ(mesh.colors.at(0), glm::vec4(1, 0, 0, 1)) << "opaque where there is no alpha";
    EXPECT_FLOAT_EQ(mesh.colors.at(2).b, 0.2F);
}

TEST(GltfAccessor, EveryAttributeHasAValuePerPosition)
{
    const std::pair<const char*, const char*> counts[] = {{"NORMAL", "2 normals"},
                                                          {"TANGENT", "2 tangents"},
                                                          {"TEXCOORD_0", "2 texture coordinates of set 0"},
                                                          {"TEXCOORD_1", "2 texture coordinates of set 1"},
                                                          {"COLOR_0", "2 vertex colours"}};
    for (const auto& [name, count] : counts) {
        GltfBuilder builder;
        const json attributes = everyAttribute(builder);
        builder.document["accessors"][attributes[name].get<std::size_t>()]["count"] = 2;
        builder.addNode({{"mesh", builder.addMesh({{"attributes", attributes}})}});
        expectRefused(builder, MessageId::Mismatch, {.place = "meshes[0].primitives[0]", .value = count, .expected = " 3 "});
    }
}

// All zeros: no triangle of them has a surface.
TEST(GltfAccessor, IndicesMayLackABufferView)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t zeros = builder.append("accessors", {{"componentType", kUnsignedShort}, {"type", "SCALAR"}, {"count", 3}});
    builder.addNode({{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}, {"indices", zeros}})}});
    const Scene scene = load(builder);
    EXPECT_EQ(scene.meshes.at(1).indices, (std::vector<std::uint32_t>{0, 0, 0}));
    EXPECT_EQ(makePrimitives(scene).triangles.size(), 1U);
}

}  // namespace
}  // namespace glim::test
