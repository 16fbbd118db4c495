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

void expectRefusal(const GltfBuilder& builder, const std::string& sentence)
{
    const std::string message = refusal(builder, litByTheSky());
    EXPECT_NE(message.find(": " + sentence), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

constexpr const char* kMeshopt = "EXT_meshopt_compression";

// Views 5 to 8 are of the attributes, 9 of the indices.
void expectMeshoptRefusal(std::size_t view, const json& changes, const std::string& sentence, const std::string& indexMode = "INDICES")
{
    GltfBuilder builder = build(makeHills(6), meshopt(indexMode));
    builder.document["bufferViews"][view]["extensions"][kMeshopt].update(changes);
    expectRefusal(builder, "bufferViews[" + std::to_string(view) + "].extensions." + kMeshopt + sentence);
}

TEST(GltfCompressionRefused, MeshoptThatBreaksARule)
{
    expectMeshoptRefusal(5, {{"mode", "POINTS"}}, ".mode is \"POINTS\"; expected one of ATTRIBUTES, TRIANGLES, INDICES");
    expectMeshoptRefusal(5, {{"filter", "COLOR"}}, ".filter is \"COLOR\"; expected one of NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL");
    expectMeshoptRefusal(9, {{"filter", "EXPONENTIAL"}}, ".filter is \"EXPONENTIAL\"; expected NONE in mode INDICES");
    expectMeshoptRefusal(5, {{"filter", "OCTAHEDRAL"}}, ".byteStride is 12; expected 4 or 8 for the filter OCTAHEDRAL");
    expectMeshoptRefusal(5, {{"filter", "QUATERNION"}}, ".byteStride is 12; expected 8 for the filter QUATERNION");
    expectMeshoptRefusal(5, {{"byteStride", 10}}, ".byteStride is 10; expected a multiple of 4 in mode ATTRIBUTES");
    expectMeshoptRefusal(5, {{"byteStride", 260}}, ".byteStride is 260; expected a whole number from 1 to 256");
    expectMeshoptRefusal(9, {{"byteStride", 1}}, ".byteStride is 1; expected 2 or 4 in mode INDICES");
    expectMeshoptRefusal(9, {{"count", 149}}, ".count is 149; expected a multiple of 3 in mode TRIANGLES", "TRIANGLES");
    expectMeshoptRefusal(5, {{"count", 35}}, " has 35 elements of 12 bytes; expected as many bytes as the 432 of its bufferView");
    expectMeshoptRefusal(5, {{"buffer", 2}}, ".buffer is 2; expected an index into buffers, which has 2 entries");
}

TEST(GltfCompressionRefused, MeshoptWithoutItsBytes)
{
    expectMeshoptRefusal(5, {{"byteOffset", 1'000'000}}, " ends at byte 1000");
    expectMeshoptRefusal(5, {{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 99}},
                         " ends at byte 99; expected at most the 0 of buffers[1]");
    expectMeshoptRefusal(5, {{"byteLength", 40}},
                         " holds 40 bytes that are damaged or of an unknown version; expected 36 elements in mode ATTRIBUTES");
    expectMeshoptRefusal(9, {{"mode", "TRIANGLES"}}, " holds ");
    GltfBuilder plain = build(makeHills(6), meshopt("INDICES"));
    plain.document["bufferViews"][5].erase("extensions");
    expectRefusal(plain, "bufferViews[5] ends at byte 432; expected at most the 0 of buffers[1]");
}

TEST(GltfCompressionRefused, ClaimsOfMoreMemoryThanTheStreamCanFill)
{
    GltfBuilder builder = build(makeHills(6), meshopt("INDICES"));
    json& view = builder.document["bufferViews"][5];
    view["byteLength"] = 1'200'000'000'000;
    view["extensions"][kMeshopt]["count"] = 100'000'000'000;
    expectRefusal(builder, std::string("bufferViews[5].extensions.") + kMeshopt + " claims 1200000000000 bytes; expected at most ");

    // A mesh of bitstream 2.2, sequential, no flags, 715,827,882 faces as a varint of seven bits a byte, least bits first.
    GltfBuilder claims;
    json primitive = addDraco(claims, makeHills(6), {});
    const Bytes stream{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0, 0xAA, 0xD5, 0xAA, 0xD5, 0x02, 3, 1};
    primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = claims.addAov(stream);
    claims.document["accessors"][4]["count"] = 2'147'483'646;
    claims.addNode({{"mesh", claims.addMesh(primitive)}});
    expectRefusal(claims, "bufferViews[1] (KHR_draco_mesh_compression of meshes[0].primitives[0]) claims 2147483646 indices in 18 bytes");
}

// Changes the member of the document that `pointer` names.
void expectDracoRefusal(const std::string& pointer, const json& value, const std::string& sentence)
{
    GltfBuilder builder = build(makeHills(6), draco({}));
    builder.document[json::json_pointer(pointer)] = value;
    expectRefusal(builder, sentence);
}

TEST(GltfCompressionRefused, DracoThatBreaksARule)
{
    const std::string primitive = "/meshes/0/primitives/0", extension = primitive + "/extensions/KHR_draco_mesh_compression";
    const std::string place = "bufferViews[0] (KHR_draco_mesh_compression of meshes[0].primitives[0])";
    expectDracoRefusal(extension + "/bufferView", 7,
                       "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression.bufferView is 7; expected an index into");
    expectDracoRefusal(primitive + "/mode", 5, place + " belongs to a primitive that is no indexed triangle list; expected one");
    expectDracoRefusal("/bufferViews/0/byteLength", 10,
                       place + " does not begin with the header of a Draco mesh of bitstream 2.2; expected one");
    expectDracoRefusal("/bufferViews/0/byteLength", 300, place + " is damaged (");
    expectDracoRefusal("/bufferViews/0/byteLength", 100'000, "bufferViews[0] ends at byte 100000; expected at most the ");
    expectDracoRefusal("/accessors/4/count", 153, place + " holds 50 triangles; expected a third of the 153 indices of its accessor");
    expectDracoRefusal("/accessors/1/count", 35, place + " holds 36 vertices; expected the 35 of accessors[1] (NORMAL)");
    expectDracoRefusal(extension + "/attributes/NORMAL", 5, place + " has no attribute 5; expected the one of accessors[1] (NORMAL)");
    expectDracoRefusal(extension + "/attributes/NORMAL", 7,
                       place + " holds elements of 2 components; expected the VEC3 of accessors[1] (NORMAL)");
    expectDracoRefusal("/accessors/1/componentType", 5124,
                       place + " holds values that do not fit; expected those of componentType 5124 of accessors[1] (NORMAL)");
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
            const std::string message = loadRefusal(path, litByTheSky());
            EXPECT_EQ(message.rfind(path + ": bufferViews[" + std::to_string(stream.view) + "]", 0), 0U)
                << length << " of " << whole << " bytes: " << message;
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
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
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
