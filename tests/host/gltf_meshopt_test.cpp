// Attributes of KHR_meshopt_compression: files of the current encoder, and damaged streams.
#include "host/scene/gltf/decode_attributes.hpp"
#include "host/scene/gltf/gltf_container.hpp"
#include "host/scene/gltf/gltf_file.hpp"
#include "places.h"
#include "tests/support/compress_geometry.hpp"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <random>
#include <string>

namespace glim::test {
namespace {

using nlohmann::json;

const std::string kFolder = GLIM_SOURCE_DIR "/tests/host/meshopt/";

std::span<const unsigned char> bytesOf(const GltfFile& file, std::size_t view)
{
    const tinygltf::BufferView& entry = file.model.bufferViews[view];
    return std::span(file.buffers[static_cast<std::size_t>(entry.buffer)]).subspan(entry.byteOffset, entry.byteLength);
}

TEST(GltfMeshopt, StreamsDecodeAsTheEncodersOwnDecoderDecodesThem)
{
    const GltfFile file = readGltfFile(kFolder + "streams.glb", true);
    ASSERT_EQ(file.model.bufferViews.size(), 100U) << "each stream is followed by what it stands for";
    for (std::size_t i = 0; i < file.model.bufferViews.size(); i += 2) {
        EXPECT_TRUE(std::ranges::equal(bytesOf(file, i), bytesOf(file, i + 1))) << file.model.bufferViews[i].name;
    }
}

// scenes/alpha.gltf as gltfpack 1.3 writes it, with -cz -ce khr and without. A filter may change a component by one step of 8 bits.
TEST(GltfMeshopt, FilesOfGltfpackAreReadAsIfTheyWerePlain)
{
    const Scene packed = loadGltf(kFolder + "gltfpack.glb", litByTheSky()), plain = loadGltf(kFolder + "gltfpack_plain.glb", litByTheSky());
    ASSERT_EQ(packed.meshes.size(), plain.meshes.size());
    std::size_t colors = 0;
    for (std::size_t i = 0; i < plain.meshes.size(); ++i) {
        const Mesh &mesh = packed.meshes[i], &expected = plain.meshes[i];
        EXPECT_EQ(mesh.indices, expected.indices);
        EXPECT_EQ(mesh.positions, expected.positions);
        EXPECT_EQ(mesh.uv0, expected.uv0);
        ASSERT_EQ(mesh.normals.size(), expected.normals.size());
        for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
            EXPECT_LT(glm::distance(mesh.normals[v], expected.normals[v]), 2.0F / 127.0F);
        }
        ASSERT_EQ(mesh.colors.size(), expected.colors.size());
        for (std::size_t v = 0; v < mesh.colors.size(); ++v) {
            EXPECT_LT(glm::distance(mesh.colors[v], expected.colors[v]), 2.0F / 255.0F);
        }
        colors += mesh.colors.size();
    }
    EXPECT_GT(colors, 0U);
}

// The example of the extension's text: 16 deltas of 4 bits, two of which follow whole.
TEST(GltfMeshopt, DeltasAreThoseOfTheSpecificationsExample)
{
    Bytes stream{0xa0, 2, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5, 0, 0, 0};
    stream.resize(stream.size() + 32);
    Bytes decoded(std::size_t{4} * 16, 1);
    ASSERT_TRUE(decodeAttributes(stream, 4, decoded));
    int value = 0;
    const int deltas[] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};
    for (std::size_t i = 0; i < 16; ++i) {
        value += deltas[i];
        EXPECT_EQ(decoded[4 * i], value & 255) << i;
        EXPECT_EQ(decoded[4 * i + 3], 0) << i;
    }
}

// A stream of streams.glb.
struct Stream {
    Bytes bytes;
    std::size_t stride, count;
};

std::vector<Stream> readStreams()
{
    const std::string path = kFolder + "streams.glb";
    const GltfContainer container = openContainer(path);
    const Bytes binary = readBytes(path, container.binary->size, container.binary->begin);
    const json document = json::parse(container.json);
    std::vector<Stream> streams;
    for (const json& view : document["bufferViews"]) {
        if (view.contains("extensions")) {
            const json& source = view["extensions"]["KHR_meshopt_compression"];
            const auto first = binary.begin() + source["byteOffset"].get<std::ptrdiff_t>();
            streams.push_back({Bytes(first, first + source["byteLength"].get<std::ptrdiff_t>()), source["byteStride"], source["count"]});
        }
    }
    return streams;
}

TEST(GltfMeshopt, ShorterAndLongerStreamsAreRefused)
{
    for (const Stream& stream : readStreams()) {
        Bytes decoded(stream.stride * stream.count), bytes = stream.bytes;
        EXPECT_TRUE(decodeAttributes(bytes, stream.stride, decoded));
        bytes.insert(bytes.begin() + 1, 0);
        EXPECT_FALSE(decodeAttributes(bytes, stream.stride, decoded)) << "one more byte";
        for (bytes = stream.bytes; !bytes.empty();) {
            bytes.pop_back();
            EXPECT_FALSE(decodeAttributes(bytes, stream.stride, decoded)) << bytes.size() << " of " << stream.bytes.size();
        }
    }
}

TEST(GltfMeshopt, UnknownVersionsAndModesAreRefused)
{
    Bytes stream{0xa1, 0xaa}, decoded(4);
    stream.resize(stream.size() + 24);
    EXPECT_TRUE(decodeAttributes(stream, 4, decoded));
    for (const int mode : {0x03, 0x0f, 0x10, 0x21}) {
        stream.back() = static_cast<unsigned char>(mode);
        EXPECT_FALSE(decodeAttributes(stream, 4, decoded)) << mode;
    }
    stream.back() = 0xf2;
    EXPECT_TRUE(decodeAttributes(stream, 4, decoded));
    for (const int header : {0x00, 0xa2, 0xe1}) {
        stream.front() = static_cast<unsigned char>(header);
        EXPECT_FALSE(decodeAttributes(stream, 4, decoded)) << header;
    }
}

// Of version 0, with and without damage.
TEST(GltfMeshopt, AgreesWithTheLibrary)
{
    std::mt19937 random(1);
    int accepted = 0, refused = 0;
    for (int round = 0; round < 4000; ++round) {
        const std::size_t stride = 4 * (1 + random() % (round % 8 == 0 ? 64 : 6)), count = 1 + random() % 600;
        Bytes values(stride * count);
        const unsigned noise = 1U << random() % 9;
        for (std::size_t i = stride; i < values.size(); ++i) {
            values[i] = static_cast<unsigned char>(values[i - stride] + (random() % 4 == 0 ? random() % noise : 0));
        }
        Bytes stream = encodeAttributes(values, stride), decoded(values.size()), expected(values.size());
        for (int edit = 0; edit < round % 4; ++edit) {
            stream[1 + random() % (stream.size() - 1)] = static_cast<unsigned char>(random());
        }
        const bool isRight = meshopt_decodeVertexBuffer(expected.data(), count, stride, stream.data(), stream.size()) == 0;
        ASSERT_EQ(decodeAttributes(stream, stride, decoded), isRight) << round;
        ASSERT_TRUE(!isRight || decoded == expected) << round;
        ++(isRight ? accepted : refused);
    }
    EXPECT_GT(accepted, 1100) << "nothing but what is right was accepted";
    EXPECT_GT(refused, 1000);
}

// Y = 110, Co = 60, Cg = -20 of 8 bits: red 190, green 90, blue 70, and an alpha of 7 bits.
TEST(GltfMeshopt, ColorsAreThoseOfTheSpecification)
{
    Bytes color{110, 60, 236, 128 + 100};
    decodeColors(4, color);
    EXPECT_EQ(color, (Bytes{190, 90, 70, 200}));
    Bytes grey{31, 0, 0, 0, 0, 0, 63, 0};  // of 6 bits: 31/63 of 65535 is 0x7df7
    decodeColors(8, grey);
    EXPECT_EQ(grey, (Bytes{0xf7, 0x7d, 0xf7, 0x7d, 0xf7, 0x7d, 255, 255}));
    Bytes wrong{255, 127, 128, 0, 0, 128, 127, 255, 0, 0, 0, 0};
    decodeColors(4, wrong);
    EXPECT_EQ(wrong, (Bytes{255, 255, 255, 0, 0, 127, 1, 255, 0, 0, 0, 0})) << "what no encoder may write is clamped";
}

}  // namespace
}  // namespace glim::test
