// Compressed geometry that is wrong is refused with one sentence that names its buffer view.
#include "host/error.hpp"
#include "tests/support/compress_geometry.hpp"
#include "tests/support/named.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace glim::test {
namespace {

using nlohmann::json;

constexpr const char* kMeshopt = "EXT_meshopt_compression";

// Views 5 to 8 are of the attributes, 9 of the indices. The place is within the extension of the view.
void expectMeshoptRefusal(std::size_t view, const json& changes, MessageId id, Parts parts, const std::string& indexMode = "INDICES")
{
    GltfBuilder builder = build(makeHills(6), meshopt(indexMode));
    builder.document["bufferViews"][view]["extensions"][kMeshopt].update(changes);
    parts.place = "bufferViews[" + std::to_string(view) + "].extensions." + kMeshopt + parts.place;
    expectRefused(builder, id, parts, litByTheSky());
}

TEST(GltfCompressionRefused, MeshoptThatBreaksARule)
{
    expectMeshoptRefusal(5, {{"mode", "POINTS"}}, MessageId::UnknownName,
                         {.place = ".mode", .value = "\"POINTS\"", .expected = "ATTRIBUTES, TRIANGLES, INDICES"});
    expectMeshoptRefusal(5, {{"filter", "COLOUR"}}, MessageId::UnknownName,
                         {.place = ".filter", .value = "\"COLOUR\"", .expected = "NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL, COLOR"});
    expectMeshoptRefusal(9, {{"filter", "EXPONENTIAL"}}, MessageId::Conflict,
                         {.place = ".filter", .value = "EXPONENTIAL", .expected = "NONE"});
    expectMeshoptRefusal(5, {{"filter", "OCTAHEDRAL"}}, MessageId::OutOfRange,
                         {.place = ".byteStride", .value = "12", .expected = "OCTAHEDRAL"});
    expectMeshoptRefusal(5, {{"filter", "COLOR"}}, MessageId::OutOfRange, {.place = ".byteStride", .value = "12", .expected = "COLOR"});
    expectMeshoptRefusal(5, {{"filter", "QUATERNION"}}, MessageId::OutOfRange,
                         {.place = ".byteStride", .value = "12", .expected = "QUATERNION"});
    expectMeshoptRefusal(5, {{"byteStride", 10}}, MessageId::OutOfRange, {.place = ".byteStride", .value = "10", .expected = "ATTRIBUTES"});
    expectMeshoptRefusal(5, {{"byteStride", 260}}, MessageId::OutOfRange,
                         {.place = ".byteStride", .value = "260", .expected = "from 1 to 256"});
    expectMeshoptRefusal(9, {{"byteStride", 1}}, MessageId::OutOfRange, {.place = ".byteStride", .value = "1", .expected = "INDICES"});
    expectMeshoptRefusal(9, {{"count", 149}}, MessageId::OutOfRange, {.place = ".count", .value = "149", .expected = "3"}, "TRIANGLES");
    expectMeshoptRefusal(5, {{"count", 35}}, MessageId::Mismatch, {.value = "35", .expected = "432"});
    expectMeshoptRefusal(5, {{"buffer", 2}}, MessageId::DanglingIndex, {.place = ".buffer", .value = "2", .expected = "buffers"});
}

TEST(GltfCompressionRefused, MeshoptWithoutItsBytes)
{
    expectMeshoptRefusal(5, {{"byteOffset", 1'000'000}}, MessageId::OutOfRange, {.expected = "buffers[0]"});
    expectMeshoptRefusal(5, {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 99}}, MessageId::OutOfRange,
                         {.value = "99", .expected = "0 of buffers[1]"});
    expectMeshoptRefusal(5, {{"byteLength", 40}}, MessageId::FileDamaged, {.value = "40", .expected = "36"});
    expectMeshoptRefusal(9, {{"mode", "TRIANGLES"}}, MessageId::FileDamaged, {.expected = "TRIANGLES"});
    GltfBuilder plain = build(makeHills(6), meshopt("INDICES"));
    plain.document["bufferViews"][5].erase("extensions");
    expectRefused(plain, MessageId::OutOfRange, {.place = "bufferViews[5]", .value = "432", .expected = "0 of buffers[1]"}, litByTheSky());
}

TEST(GltfCompressionRefused, ClaimsOfMoreMemoryThanTheStreamCanFill)
{
    GltfBuilder builder = build(makeHills(6), meshopt("INDICES"));
    json& view = builder.document["bufferViews"][5];
    view["byteLength"] = 1'200'000'000'000;
    view["extensions"][kMeshopt]["count"] = 100'000'000'000;
    expectRefused(builder, MessageId::TooLarge, {.place = std::string("bufferViews[5].extensions.") + kMeshopt, .value = "1200000000000"},
                  litByTheSky());

    // A mesh of bitstream 2.2, sequential, no flags, 715,827,882 faces as a varint of seven bits a byte, least bits first.
    GltfBuilder claims;
    json primitive = addDraco(claims, makeHills(6), {});
    const Bytes stream{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0, 0xAA, 0xD5, 0xAA, 0xD5, 0x02, 3, 1};
    primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = claims.addAov(stream);
    claims.document["accessors"][4]["count"] = 2'147'483'646;
    claims.addNode({{"mesh", claims.addMesh(primitive)}});
    expectRefused(claims, MessageId::TooLarge,
                  {.place = "bufferViews[1] (KHR_draco_mesh_compression of meshes[0].primitives[0])", .value = "2147483790"},
                  litByTheSky());
}

// Changes the member of the document that `pointer` names.
void expectDracoRefusal(const std::string& pointer, const json& value, MessageId id, const Parts& parts)
{
    GltfBuilder builder = build(makeHills(6), draco({}));
    builder.document[json::json_pointer(pointer)] = value;
    expectRefused(builder, id, parts, litByTheSky());
}

TEST(GltfCompressionRefused, DracoThatBreaksARule)
{
    const std::string primitive = "/meshes/0/primitives/0", extension = primitive + "/extensions/KHR_draco_mesh_compression";
    const std::string place = "bufferViews[0] (KHR_draco_mesh_compression of meshes[0].primitives[0])";
    expectDracoRefusal(extension + "/bufferView", 7, MessageId::DanglingIndex,
                       {.place = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.bufferView", .value = "7"});
    expectDracoRefusal(primitive + "/mode", 5, MessageId::WrongType, {.place = place});
    expectDracoRefusal("/bufferViews/0/byteLength", 10, MessageId::UnknownFormat, {.place = place, .expected = "2.2"});
    expectDracoRefusal("/bufferViews/0/byteLength", 300, MessageId::FileDamaged, {.place = place});
    expectDracoRefusal("/bufferViews/0/byteLength", 100'000, MessageId::OutOfRange, {.place = "bufferViews[0]", .value = "100000"});
    expectDracoRefusal("/accessors/4/count", 153, MessageId::Mismatch, {.place = place, .value = "50", .expected = "153"});
    expectDracoRefusal("/accessors/1/count", 35, MessageId::Mismatch,
                       {.place = place, .value = "36", .expected = "35 of accessors[1] (NORMAL)"});
    expectDracoRefusal(extension + "/attributes/NORMAL", 5, MessageId::Missing,
                       {.place = place, .value = "5", .expected = "accessors[1] (NORMAL)"});
    expectDracoRefusal(extension + "/attributes/NORMAL", 7, MessageId::Mismatch,
                       {.place = place, .value = "2", .expected = "VEC3 of accessors[1] (NORMAL)"});
    expectDracoRefusal("/accessors/1/componentType", 5124, MessageId::OutOfRange,
                       {.place = place, .expected = "5124 of accessors[1] (NORMAL)"});
}

class GltfCompressionDamage : public ::testing::TestWithParam<Named<AddGeometry>> {};

// A stream: its view, and the object that says where its bytes are.
struct Stream {
    std::size_t view;
    json* range;
};

std::vector<Stream> streamsOf(GltfBuilder& builder)
{
    json& views = builder.document["bufferViews"];
    std::vector<Stream> streams;
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].contains("extensions")) {
            streams.push_back({i, &views[i]["extensions"][kMeshopt]});
        }
    }
    return streams.empty() ? std::vector<Stream>{{0, &views[0]}} : streams;
}

TEST_P(GltfCompressionDamage, EveryShorterStreamIsRefused)
{
    GltfBuilder builder = build(makeHills(4), GetParam().value);
    for (const Stream& stream : streamsOf(builder)) {
        const std::size_t whole = (*stream.range)["byteLength"];
        for (std::size_t length = 1; length < whole; ++length) {
            (*stream.range)["byteLength"] = length;
            const std::string path = writeTemporary("short.glb", builder.toGlb());
            SCOPED_TRACE(length);
            try {
                loadGltf(path, litByTheSky());
                ADD_FAILURE() << "loaded, of " << whole << " bytes";
            } catch (const InputError& error) {
                EXPECT_EQ(error.message().file, path);
                EXPECT_TRUE(error.message().place.starts_with("bufferViews[" + std::to_string(stream.view) + "]")) << error.what();
            }
        }
        (*stream.range)["byteLength"] = whole;
    }
}

// A damaged stream gives other vertices, or one sentence.
TEST_P(GltfCompressionDamage, NoByteIsTrusted)
{
    GltfBuilder builder = build(makeHills(4), GetParam().value);
    const std::string glb = builder.toGlb();
    const std::size_t data = glb.find(std::string("BIN\0", 4)) + 4;
    std::mt19937 random(1);
    int loaded = 0, refused = 0;
    for (const Stream& stream : streamsOf(builder)) {
        const std::size_t first = data + stream.range->value("byteOffset", std::size_t{0}), size = (*stream.range)["byteLength"];
        for (int i = 0; i < 250; ++i) {
            std::string damaged = glb;
            for (int edit = 0; edit <= i % 4; ++edit) {
                damaged[first + random() % size] = static_cast<char>(random());
            }
            try {
                loadGltf(writeTemporary("damaged.glb", damaged), litByTheSky());
                ++loaded;
            } catch (const InputError& error) {
                expectMessage(error.message(), error.message().id);
                ++refused;
            }
        }
    }
    EXPECT_GT(loaded, 0) << "nothing but headers was damaged";
    EXPECT_GT(refused, 0) << "nothing was damaged";
}

INSTANTIATE_TEST_SUITE_P(Streams, GltfCompressionDamage,
                         ::testing::Values(Named{"MeshoptTriangles", meshopt("TRIANGLES")}, Named{"MeshoptIndices", meshopt("INDICES")},
                                           Named{"DracoEdgebreaker", draco({.quantizationBits = 12, .metadata = true})},
                                           Named{"DracoSequential", draco({.edgebreaker = false, .quantizationBits = 12})}),
                         nameOfParameter);

}  // namespace
}  // namespace glim::test
