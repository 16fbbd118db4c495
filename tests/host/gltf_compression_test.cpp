// Compressed geometry is read as if it were plain.
#include "tests/support/compress_geometry.hpp"
#include "tests/support/named.hpp"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace glim::test {
namespace {

using nlohmann::json;

Mesh loadMesh(const GltfBuilder& builder) { return load(builder, litByTheSky()).meshes.at(0); }

// A triangle as the attributes of its corners, beginning with the least, which keeps its orientation.
using Corner = std::array<double, 12>;
using Face = std::array<Corner, 3>;

std::vector<Face> facesOf(const Mesh& mesh)
{
    std::vector<Face> faces(mesh.indices.size() / 3);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t v = mesh.indices[i];
        const glm::dvec3 p = mesh.positions.at(v), n = mesh.normals.at(v);
        const glm::dvec2 uv(mesh.uv0.at(v));
        const glm::dvec4 color(mesh.colors.at(v));
        faces[i / 3][i % 3] = {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y, color.r, color.g, color.b, color.a};
    }
    for (Face& face : faces) {
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

void expectSameVertices(const Mesh& mesh, const Mesh& expected)
{
    EXPECT_EQ(mesh.positions, expected.positions);
    EXPECT_EQ(mesh.normals, expected.normals);
    EXPECT_EQ(mesh.uv0, expected.uv0);
    EXPECT_EQ(mesh.colors, expected.colors);
}

TEST(GltfCompression, MeshoptKeepsVerticesAndTriangles)
{
    const Geometry hills = makeHills(20);
    const Mesh plain = loadMesh(build(hills, addPlain));
    ASSERT_EQ(plain.positions.size(), 400U);
    const Mesh sequence = loadMesh(build(hills, meshopt("INDICES"))), triangles = loadMesh(build(hills, meshopt("TRIANGLES")));
    expectSameVertices(sequence, plain);
    expectSameVertices(triangles, plain);
    EXPECT_EQ(sequence.indices, plain.indices);
    EXPECT_EQ(facesOf(triangles), facesOf(plain)) << "whose corners may begin elsewhere";
}

TEST(GltfCompression, MeshoptOfTheLaterNameIsTheSame)
{
    GltfBuilder builder = build(makeHills(6), meshopt("INDICES"));
    const Mesh expected = loadMesh(builder);
    for (json* list : {&builder.document["bufferViews"], &builder.otherBuffers}) {
        for (json& entry : *list) {
            if (entry.contains("extensions")) {
                const json extension = entry["extensions"]["EXT_meshopt_compression"];
                entry["extensions"] = {{"KHR_meshopt_compression", extension}};
            }
        }
    }
    builder.document["extensionsRequired"] = {"KHR_meshopt_compression"};
    expectSameVertices(loadMesh(builder), expected);
}

// The views of a fallback that is there hold zeros, so that a reader that takes them draws nothing.
TEST(GltfCompression, FallbacksAreNotRead)
{
    const Geometry hills = makeHills(6);
    const Mesh plain = loadMesh(build(hills, addPlain));
    GltfBuilder builder = build(hills, meshopt("INDICES"));
    for (const char* uri : {"", "nowhere.bin"}) {
        if (*uri != '\0') {
            builder.otherBuffers[0]["uri"] = uri;
        }
        const Scene scene = load(builder, litByTheSky());
        expectSameVertices(scene.meshes.at(0), plain);
        EXPECT_EQ(scene.files.size(), 1U) << "a file that nobody reads is nobody's source";
    }
    writeTemporary("zeros.bin", std::string(1U << 20U, '\0'));
    builder.otherBuffers[0] = {{"byteLength", 1U << 20U}, {"uri", "zeros.bin"}};
    const Scene scene = load(builder, litByTheSky());
    expectSameVertices(scene.meshes.at(0), plain);
    EXPECT_EQ(scene.files.size(), 2U) << "it is not marked as a fallback";
}

struct Filtered {
    const char* filter;
    std::size_t stride;
    int componentType;
    const char* attribute;
    void (*encode)(void*, std::size_t, std::size_t, int, const float*);
    int bits;
    double error;  // of a component
};

class GltfCompressionFilter : public ::testing::TestWithParam<Named<Filtered>> {};

// Four numbers for each vertex: unit vectors with w = 1, or unit quaternions.
std::vector<float> makeFilterInput(const Geometry& geometry, bool quaternions)
{
    std::vector<float> values;
    for (std::size_t i = 0; i < geometry.vertexCount(); ++i) {
        const float* n = &geometry.normals[3 * i];
        const float w = quaternions ? std::sin(static_cast<float>(i)) : 1.0F, scale = quaternions ? std::cos(static_cast<float>(i)) : 1.0F;
        values.insert(values.end(), {n[0] * scale, n[1] * scale, n[2] * scale, w});
    }
    return values;
}

TEST_P(GltfCompressionFilter, DecodesToWhatWasEncoded)
{
    const Filtered& filtered = GetParam().value;
    const Geometry hills = makeHills(12);
    const bool quaternions = std::string(filtered.filter) == "QUATERNION";
    const std::vector<float> input = makeFilterInput(hills, quaternions);
    Bytes encoded(hills.vertexCount() * filtered.stride);
    filtered.encode(encoded.data(), hills.vertexCount(), filtered.stride, filtered.bits, input.data());
    GltfBuilder builder;
    json primitive = addPlain(builder, hills);
    const std::size_t view = addMeshoptView(builder, encodeAttributes(encoded, filtered.stride),
                                            {.filter = filtered.filter, .stride = filtered.stride, .count = hills.vertexCount()});
    builder.document["bufferViews"][view]["byteStride"] = filtered.stride;
    primitive["attributes"]["TANGENT"] = builder.append("accessors", {{"bufferView", view},
                                                                      {"componentType", filtered.componentType},
                                                                      {"normalized", filtered.componentType != kFloat},
                                                                      {"type", "VEC4"},
                                                                      {"count", hills.vertexCount()}});
    builder.addNode({{"mesh", builder.addMesh(primitive)}});
    const std::vector<glm::vec4> read = loadMesh(builder).tangents;
    ASSERT_EQ(read.size(), hills.vertexCount());
    for (std::size_t i = 0; i < read.size(); ++i) {
        const glm::vec4 expected(input[4 * i], input[4 * i + 1], input[4 * i + 2], input[4 * i + 3]);
        // q and -q are the same rotation.
        const float sign = quaternions && glm::dot(read[i], expected) < 0.0F ? -1.0F : 1.0F;
        for (int c = 0; c < 4; ++c) {
            ASSERT_NEAR(sign * read[i][c], expected[c], filtered.error) << "component " << c << " of vertex " << i;
        }
    }
}

// Half a step of the quantization, and for the octahedron what its slope adds; the decoder of 8 bits rounds a second time.
INSTANTIATE_TEST_SUITE_P(
    Filters, GltfCompressionFilter,
    ::testing::Values(Named{"Octahedral8", Filtered{"OCTAHEDRAL", 4, kByte, "NORMAL", meshopt_encodeFilterOct, 8, 2.0 / 127}},
                      Named{"Octahedral16", Filtered{"OCTAHEDRAL", 8, kShort, "NORMAL", meshopt_encodeFilterOct, 16, 2.0 / 32767}},
                      Named{"Quaternion", Filtered{"QUATERNION", 8, kShort, "TANGENT", meshopt_encodeFilterQuat, 16, 2.0 / 32767}},
                      Named{"Exponential", Filtered{"EXPONENTIAL", 16, kFloat, "TANGENT", meshopt_encodeFilterExp, 16, 1.0 / 32768}}),
    nameOfParameter);

TEST(GltfCompression, DracoKeepsTrianglesBitByBitIfNothingIsQuantized)
{
    const Geometry hills = makeHills(20);
    const Mesh plain = loadMesh(build(hills, addPlain));
    const Mesh sequential = loadMesh(build(hills, draco({.edgebreaker = false})));
    expectSameVertices(sequential, plain);
    EXPECT_EQ(sequential.indices, plain.indices);
    const Mesh reordered = loadMesh(build(hills, draco({.metadata = true})));
    EXPECT_NE(reordered.positions, plain.positions) << "a test of nothing";
    EXPECT_EQ(facesOf(reordered), facesOf(plain));
}

TEST(GltfCompression, DracoDiffersByItsQuantizationOnly)
{
    const Geometry hills = makeHills(20);
    const std::vector<Face> plain = facesOf(loadMesh(build(hills, addPlain)));
    for (const bool edgebreaker : {false, true}) {
        const Mesh mesh = loadMesh(build(hills, draco({.edgebreaker = edgebreaker, .quantizationBits = 14})));
        ASSERT_EQ(mesh.positions.size(), hills.vertexCount());
        // Half a step of 14 bits over the largest extent, 2; the normals' octahedron is no finer than that.
        const double step = 2.0 / (1 << 14);
        std::size_t near = 0;
        for (const Face& face : facesOf(mesh)) {
            near += std::count_if(plain.begin(), plain.end(), [&](const Face& other) {
                for (int first = 0; first < 3; ++first) {
                    bool same = true;
                    for (int i = 0; i < 3; ++i) {
                        const Corner &a = face[static_cast<std::size_t>(i)], &b = other[static_cast<std::size_t>((i + first) % 3)];
                        for (std::size_t c = 0; c < a.size(); ++c) {
                            same = same && std::abs(a[c] - b[c]) <= step;
                        }
                    }
                    if (same) {
                        return true;
                    }
                }
                return false;
            });
        }
        EXPECT_EQ(near, plain.size());
    }
}

TEST(GltfCompression, DracoIsReadWhetherRequiredOrNotAndWithPlainAccessorsBesideIt)
{
    const Geometry hills = makeHills(6);
    const std::vector<Face> plain = facesOf(loadMesh(build(hills, addPlain)));
    GltfBuilder builder = build(hills, draco({}));
    builder.document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    EXPECT_EQ(facesOf(loadMesh(builder)), plain);
    EXPECT_EQ(load(builder).warnings, load(build(hills, addPlain)).warnings) << "nothing is said to be ignored";
    builder.document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    EXPECT_EQ(facesOf(loadMesh(builder)), plain);

    // The same accessors serve a primitive that is not compressed.
    GltfBuilder both;
    json uncompressed = addPlain(both, hills), compressed = uncompressed;
    compressed["extensions"] = addDraco(both, hills, {})["extensions"];
    both.document["meshes"] = json::array({{{"primitives", {compressed, uncompressed}}}});
    both.addNode({{"mesh", 0}});
    const Scene scene = load(both, litByTheSky());
    EXPECT_EQ(facesOf(scene.meshes.at(0)), plain);
    EXPECT_EQ(facesOf(scene.meshes.at(1)), plain);
    EXPECT_NE(scene.meshes[0].indices, scene.meshes[1].indices) << "the compressed one was not decoded";
}

TEST(GltfCompression, DracoFollowsTheTypesOfAccessors)
{
    const Geometry hills = makeHills(6);
    GltfBuilder builder = build(hills, draco({.edgebreaker = false}));
    const Mesh before = loadMesh(builder);
    const std::size_t colors = builder.document["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"];
    builder.document["accessors"][colors]["normalized"] = false;
    const Mesh after = loadMesh(builder);
    ASSERT_GT(before.colors.at(1).b, 0.7F);
    EXPECT_EQ(after.colors.at(1), glm::vec4(7, 13, 200, 255));
    builder.document["accessors"][colors]["componentType"] = kFloat;
    EXPECT_EQ(loadMesh(builder).colors, before.colors) << "the stream says that they are normalised";
}

}  // namespace
}  // namespace glim::test
