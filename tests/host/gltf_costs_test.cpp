// What files cost that claim more than they hold, or have very many parts: memory and work follow their bytes.
#include "tests/support/compress_geometry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace glim::test {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U, kHole = std::uint64_t{1} << 32U;

std::uint64_t statusBytes(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind(name + ":", 0) == 0) {
            return std::stoull(line.substr(name.size() + 1)) * 1024;
        }
    }
    ADD_FAILURE() << "/proc/self/status has no " << name;
    return 0;
}

// The most memory that `work` takes beyond what the process has.
std::uint64_t peakOf(const std::function<void()>& work)
{
    std::ofstream("/proc/self/clear_refs") << 5;  // the peak begins anew
    const std::uint64_t before = statusBytes("VmRSS");
    work();
    return std::max(statusBytes("VmHWM"), before) - before;
}

double threadSeconds()
{
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Of loading it, in the least of three runs.
double secondsOf(const GltfBuilder& builder)
{
    const std::string path = writeTemporary("scene.gltf", builder.toGltf());
    double least = 1e9;
    for (int run = 0; run < 3; ++run) {
        const double begin = threadSeconds();
        loadGltf(path, litByTheSky());
        least = std::min(least, threadSeconds() - begin);
    }
    return least;
}

std::string littleEndian(std::uint64_t value)
{
    std::string bytes;
    for (int byte = 0; byte < 4; ++byte) {
        bytes += static_cast<char>(value >> 8U * byte & 255U);
    }
    return bytes;
}

// Gives the file a hole at its end, which reads as zeros and takes no room.
std::string withHole(const std::string& path, std::uint64_t size = kHole)
{
    std::filesystem::resize_file(path, size);
    return path;
}

class GltfHoles : public ::testing::Test {
protected:
    // A .glb of 4 GiB: all that comes after `text` and `more` is a hole.
    static std::string binary(std::uint64_t jsonSize, const std::string& text, const std::string& more)
    {
        constexpr std::uint64_t kSize = kHole - 256;
        return withHole(
            writeTemporary("scene.glb", "glTF" + littleEndian(2) + littleEndian(kSize) + littleEndian(jsonSize) + "JSON" + text + more),
            kSize);
    }

    static GltfBuilder triangle()
    {
        GltfBuilder builder;
        builder.addNode({{"mesh", builder.addTriangleMesh()}});
        return builder;
    }

    static void expectRefusedLightly(const std::string& path, MessageId id, const Parts& parts)
    {
        EXPECT_LT(peakOf([&] { expectRefusal<InputError>([&] { loadGltf(path, litByTheSky()); }, id, parts); }), 64 * kMiB);
    }
};

TEST_F(GltfHoles, BehindABinaryChunkAreNotRead)
{
    GltfBuilder builder = triangle();
    builder.document["buffers"][0] = {{"byteLength", kHole - 4096}};
    std::string text = builder.document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string points(builder.bytes().begin(), builder.bytes().end());
    const std::string path = binary(text.size(), text, littleEndian(kHole - 256 - 28 - text.size()) + std::string("BIN\0", 4) + points);
    EXPECT_LT(peakOf([&] { EXPECT_EQ(loadGltf(path, litByTheSky()).meshes.at(0).positions.size(), 3U); }), 64 * kMiB);
}

TEST_F(GltfHoles, InJsonEndIt)
{
    expectRefusedLightly(binary(kHole - 256 - 20, "", ""), MessageId::Missing, {.file = ".glb"});
    expectRefusedLightly(binary(kHole - 256 - 20, "{", ""), MessageId::Malformed, {.file = ".glb", .value = "2"});
    expectRefusedLightly(withHole(writeTemporary("scene.gltf", "{")), MessageId::Malformed, {.file = "scene.gltf", .value = "2"});
    const std::string path = withHole(writeTemporary("padded.gltf", triangle().toGltf()));
    EXPECT_LT(peakOf([&] { EXPECT_EQ(loadGltf(path, litByTheSky()).meshes.size(), 1U); }), 64 * kMiB);
}

TEST_F(GltfHoles, OfBuffersAndImagesAreNotRead)
{
    GltfBuilder builder = triangle();
    const std::string points(builder.bytes().begin(), builder.bytes().end());
    withHole(writeTemporary("long.bin", points));
    json document = builder.document;
    document["buffers"][0] = {{"byteLength", kHole}, {"uri", "long.bin"}};
    const std::string path = writeTemporary("scene.gltf", document.dump());
    EXPECT_LT(peakOf([&] { EXPECT_EQ(loadGltf(path, litByTheSky()).meshes.at(0).positions.size(), 3U); }), 64 * kMiB);
    document["buffers"][0]["byteLength"] = kHole + 1;
    expectRefusedLightly(writeTemporary("longer.gltf", document.dump()), MessageId::FileDamaged,
                         {.place = "buffers[0]", .value = "4294967296", .expected = "4294967297"});

    const std::size_t uvs = builder.addAccessor(toBytes(std::vector<float>(6)), kFloat, "VEC2", 3);
    builder.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uvs;
    builder.document["meshes"][0]["primitives"][0]["material"] = 0;
    builder.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    builder.document["textures"] = {{{"source", 0}}};
    builder.document["images"] = {{{"uri", "image.png"}}};
    withHole(writeTemporary("image.png", ""));
    expectRefusedLightly(writeTemporary("textured.gltf", builder.toGltf()), MessageId::UnknownFormat,
                         {.place = "images[0] (\"image.png\")"});
}

TEST(GltfCosts, ElementsWithoutBytes)
{
    GltfBuilder builder;
    const std::size_t zeros = builder.append("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4'194'303}});
    json instanced = {{"mesh", builder.addTriangleMesh()}};
    instanced["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", zeros}, {"SCALE", zeros}};
    builder.addNode(instanced);
    EXPECT_LT(peakOf([&] { expectRefused(builder, MessageId::TooLarge, {.value = "67108848"}); }), 64 * kMiB);

    GltfBuilder repeated = build(makeHills(3), addPlain);
    const std::size_t again = repeated.append("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4'194'303}});
    for (int i = 0; i < 40; ++i) {
        repeated.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", again}}}});
    }
    EXPECT_LT(peakOf([&] { expectRefused(repeated, MessageId::TooLarge, {.value = "167772120"}); }), 64 * kMiB);
}

// Targets of zeros, as exporters of sparse ones leave them out, count with the vertices that they move.
TEST(GltfCosts, ZerosOfMorphTargetsAreFree)
{
    constexpr std::size_t kSide = 200;
    GltfBuilder builder = build(makeHills(kSide), addPlain);
    const std::size_t zeros = builder.append("accessors", {{"componentType", kFloat}, {"type", "VEC3"}, {"count", kSide * kSide}});
    builder.document["meshes"][0]["primitives"][0]["targets"] = json(std::size_t{150}, json{{"POSITION", zeros}, {"NORMAL", zeros}});
    EXPECT_EQ(load(builder, litByTheSky()).morphTargets, 150U) << "12,000,000 elements";
}

// Each four bytes of a stream are set to the largest number. One of them counts orientations of texture coordinates: the decoder would make
// room for 2^31 of them, and fill it for seconds.
TEST(GltfCosts, NumbersWithinDracoStreams)
{
    DracoOptions quantized;
    quantized.quantizationBits = 8;
    quantized.speed = 0;
    const GltfBuilder right = build(makeHills(6), draco(quantized));
    const Bytes stream = encodeDraco(makeHills(6), quantized);
    std::size_t refused = 0;
    std::uint64_t peak = 0;  // of one stream at a time: sanitizers keep for a while what is freed
    for (std::size_t at = 11; at + 4 <= stream.size(); ++at) {
        Bytes damaged = stream;
        const std::uint32_t largest = 0x7fffffff;
        std::memcpy(&damaged[at], &largest, sizeof largest);
        GltfBuilder builder = right;
        builder.document["bufferViews"][0] = {{"buffer", 1}, {"byteLength", damaged.size()}};
        builder.otherBuffers.push_back({{"byteLength", damaged.size()}, {"uri", "damaged.bin"}});
        writeTemporary("damaged.bin", std::string(damaged.begin(), damaged.end()));
        peak = std::max(peak, peakOf([&] {
                            try {
                                load(builder, litByTheSky());
                            } catch (const std::exception&) {
                                ++refused;
                            }
                        }));
    }
    EXPECT_GT(refused, stream.size() / 4);
    EXPECT_LT(peak, 64 * kMiB);
}

// A file lists how long its animations are. Each animation has its own accessor of times, but all of them name the same bytes, which are
// read once.
TEST(GltfCosts, TimesThatManyAnimationsName)
{
    const auto animated = [](std::size_t keys, int animations) {
        GltfBuilder builder = build(makeHills(3), addPlain);
        std::vector<float> times(keys);
        for (std::size_t i = 0; i < keys; ++i) {
            times[i] = static_cast<float>(i);
        }
        const std::size_t output = builder.addVec3(std::vector<float>(3 * keys));
        for (int i = 0; i < animations; ++i) {
            const std::size_t input = i == 0 ? builder.addAccessor(toBytes(times), kFloat, "SCALAR", keys)
                                             : builder.append("accessors", builder.document["accessors"].back());
            builder.append("animations", {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
                                          {"samplers", {{{"input", input}, {"output", output}}}}});
        }
        return builder;
    };
    EXPECT_EQ(load(animated(50, 300), litByTheSky()).animations.at(299).duration, 49.0);
    EXPECT_LT(secondsOf(animated(500'000, 300)), 8.0 * secondsOf(animated(500'000, 1)));
}

// A grid without extent: many triangles from few bytes.
Geometry makeNothing(std::uint32_t side)
{
    Geometry nothing;
    nothing.indices = makeHills(side).indices;
    nothing.positions.resize(std::size_t{3} * side * side);
    nothing.uvs.resize(std::size_t{2} * side * side);
    nothing.colors.resize(std::size_t{4} * side * side);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        nothing.normals.insert(nothing.normals.end(), {0.0F, 0.0F, 1.0F});
    }
    return nothing;
}

TEST(GltfCosts, StreamsThatManyPartsName)
{
    DracoOptions quantized;
    quantized.quantizationBits = 8;
    GltfBuilder primitives = build(makeNothing(64), draco(quantized));
    ASSERT_LT(primitives.bytes().size(), 2800U) << "for 40,198 elements; 300 times as many are more than 8,388,608 and 16 a byte";
    const json primitive = primitives.document["meshes"][0]["primitives"][0];
    primitives.document["meshes"][0]["primitives"] = json(std::size_t{300}, primitive);
    expectRefused(primitives, MessageId::TooLarge, {.value = "40198", .expected = "left for a file of this size"});

    GltfBuilder views = build(makeHills(3), addPlain);
    const MeshoptView zeros{"EXT_meshopt_compression", "ATTRIBUTES", "NONE", 16, 65536};
    const Bytes stream = encodeAttributes(Bytes(zeros.stride * zeros.count), zeros.stride);
    const std::size_t view = addMeshoptView(views, stream, zeros);
    const std::size_t many = (64 * kMiB + 64 * views.toGltf().size()) / (zeros.stride * zeros.count);
    for (std::size_t i = 0; i < 2 * many; ++i) {
        views.document["bufferViews"].push_back(views.document["bufferViews"][view]);
    }
    expectRefused(views, MessageId::TooLarge,
                  {.value = std::to_string(zeros.stride * zeros.count), .expected = "left for a file of this size"});
}

// Of version 1: two bits of its control bytes say that 256 bytes are those of the element before.
Bytes sameElements(std::size_t count, std::size_t stride)
{
    Bytes stream{0xa1};
    stream.insert(stream.end(), (count + 255) / 256 * stride / 4, 0xaa);
    stream.insert(stream.end(), std::max<std::size_t>(24, stride + stride / 4), 0);
    return stream;
}

// An accessor of so many vertices at one place, from a thousandth of their bytes.
std::size_t addSame(GltfBuilder& builder, std::size_t count)
{
    const MeshoptView same{"KHR_meshopt_compression", "ATTRIBUTES", "NONE", 12, count};
    const std::size_t view = addMeshoptView(builder, sameElements(same.count, same.stride), same);
    return builder.append("accessors", {{"bufferView", view}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", count}});
}

// Millions of vertices at one place, from 66 KB.
TEST(GltfCosts, StreamsThatStandForAThousandTimesTheirBytes)
{
    const auto bomb = [](std::uint64_t bytes) {
        GltfBuilder builder = build(makeHills(3), addPlain);
        builder.document["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", addSame(builder, bytes / 12)}}}});
        return builder;
    };
    const GltfBuilder most = bomb(64 * kMiB);
    EXPECT_LT(peakOf([&] { EXPECT_EQ(load(most, litByTheSky()).meshes.size(), 2U); }), 512 * kMiB);
    const GltfBuilder more = bomb(81 * kMiB);
    EXPECT_LT(peakOf([&] { expectRefused(more, MessageId::TooLarge, {.value = "84934656", .expected = "left for a file of this size"}); }),
              64 * kMiB);
}

// 87,381 vertices at one place, in as many instances, from 2 KB: 2.5e9 triangles, each without an area. The contract of fuzzing is a
// second.
TEST(GltfCosts, InstancesOfFlatMeshes)
{
    GltfBuilder builder;
    const std::size_t positions = addSame(builder, kMiB / 12);
    json node = {{"mesh", builder.addMesh({{"attributes", {{"POSITION", positions}}}})}};
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = positions;
    builder.addNode(node);
    const double begin = threadSeconds();
    expectRefused(builder, MessageId::Empty, {}, litByTheSky());
    EXPECT_LT(threadSeconds() - begin, 4.0) << "seconds, which sanitizers allow";
}

// What is compressed is read again by each that names it, and costs a file nothing.
class GltfRepeats : public ::testing::Test {
protected:
    static constexpr std::size_t kVertices = 1'000'000, kMany = 2000;

    // Loading so many of these elements at once would take gigabytes and seconds. Decoding them once takes 12 MB.
    static void expectRefusedAtOnce(const GltfBuilder& builder, const Parts& parts)
    {
        EXPECT_LT(builder.toGlb().size(), 300'000U);
        LoadOptions options = litByTheSky();
        options.at = builder.document.contains("animations") ? std::optional(0.0) : std::nullopt;
        const double begin = threadSeconds();
        EXPECT_LT(peakOf([&] { expectRefused(builder, MessageId::TooLarge, parts, options); }), 64 * kMiB);
        EXPECT_LT(threadSeconds() - begin, 1.0);
    }

    GltfBuilder builder = build(makeHills(3), addPlain);
    const std::size_t same = addSame(builder, kVertices);
};

TEST_F(GltfRepeats, OfPrimitives)
{
    builder.document["meshes"][0]["primitives"] = json(kMany, json{{"attributes", {{"POSITION", same}}}});
    expectRefusedAtOnce(builder, {.value = "2000000000", .expected = "in a file of this size"});
}

TEST_F(GltfRepeats, OfMorphTargets)
{
    builder.document["meshes"][0]["primitives"][0]["targets"] = json(kMany, json{{"POSITION", same}});
    builder.document["meshes"][0]["weights"] = std::vector<double>(kMany, 0.5);
    expectRefusedAtOnce(builder, {.value = "2000000000", .expected = "in a file of this size"});
    json& primitive = builder.document["meshes"][0]["primitives"][0];
    primitive["targets"][0] = {{"POSITION", primitive["attributes"]["POSITION"]}};
    builder.document["meshes"][0]["weights"] = std::vector<double>(kMany, 0.0);
    builder.document["meshes"][0]["weights"][0] = 0.5;
    EXPECT_EQ(load(builder, litByTheSky()).morphTargets, kMany) << "those of weight 0 are not read";
}

TEST_F(GltfRepeats, OfMeshesByTheirPoses)
{
    builder.document["meshes"][0]["primitives"] = {{{"attributes", {{"POSITION", same}}}, {"targets", {{{"POSITION", same}}}}}};
    for (std::size_t i = 1; i <= kMany; ++i) {
        builder.addNode({{"mesh", 0}, {"weights", {i}}});
    }
    expectRefusedAtOnce(builder, {.value = "4001000000", .expected = "in a file of this size"});
}

TEST_F(GltfRepeats, OfInstances)
{
    for (std::size_t i = 0; i < kMany; ++i) {
        builder.addNode({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"SCALE", same}}}}}}}});
    }
    expectRefusedAtOnce(builder, {.value = "32000000000", .expected = "in a file of this size"});
}

TEST_F(GltfRepeats, OfKeys)
{
    json channels, samplers;
    builder.document["accessors"].push_back({{"bufferView", builder.document["accessors"][same]["bufferView"]},
                                             {"componentType", kFloat},
                                             {"type", "SCALAR"},
                                             {"count", kVertices}});
    for (std::size_t i = 0; i < kMany; ++i) {
        builder.append("nodes", json::object());
        channels.push_back({{"sampler", i}, {"target", {{"node", i}, {"path", "translation"}}}});
        samplers.push_back({{"input", same + 1}, {"output", same}});
    }
    builder.append("animations", {{"channels", channels}, {"samplers", samplers}});
    expectRefusedAtOnce(builder, {.place = "animations[0].channels", .value = "4000000000", .expected = "in a file of this size"});
}

TEST_F(GltfRepeats, OfSkins)
{
    builder.document["accessors"].push_back({{"bufferView", builder.document["accessors"][same]["bufferView"]},
                                             {"componentType", kFloat},
                                             {"type", "MAT4"},
                                             {"count", kVertices / 6}});
    builder.document["meshes"][0]["primitives"][0]["attributes"].update({{"JOINTS_0", 3}, {"WEIGHTS_0", 3}});
    for (std::size_t i = 0; i < kMany; ++i) {
        builder.append("skins", {{"joints", {0}}, {"inverseBindMatrices", same + 1}});
        builder.addNode({{"mesh", 0}, {"skin", i}});
    }
    expectRefusedAtOnce(builder, {.value = "1333328000", .expected = "in a file of this size"});
}

// One attribute of a stream by many names.
TEST_F(GltfRepeats, OfDracoAttributes)
{
    DracoOptions quantized;
    quantized.quantizationBits = 8;
    GltfBuilder named = build(makeNothing(256), draco(quantized));
    json& primitive = named.document["meshes"][0]["primitives"][0];
    for (std::size_t i = 0; i < kMany; ++i) {
        primitive["attributes"]["_" + std::to_string(i)] = primitive["attributes"]["POSITION"];
        primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"]["_" + std::to_string(i)] = kDracoAttributes["POSITION"];
    }
    expectRefusedAtOnce(named, {.value = "131724294", .expected = "left for a file of this size"});
}

// The limit is that of the file's own bytes: what 66 KB stand for does not raise it.
TEST_F(GltfRepeats, BesideWhatIsDecompressed)
{
    addSame(builder, 4 * kVertices);
    builder.document["meshes"][0]["primitives"] = json(std::size_t{20}, json{{"attributes", {{"POSITION", same}}}});
    const std::uint64_t most = (std::uint64_t{1} << 23U) + 16 * (builder.bytes().size() + builder.document.dump().size());
    EXPECT_LT(most, 11'000'000U);
    expectRefused(builder, MessageId::TooLarge, {.value = "20000000"}, litByTheSky());
}

// A crowd that shares a compressed mesh, each in a pose of its own.
TEST_F(GltfRepeats, OfACrowdAreDrawn)
{
    constexpr std::size_t kCrowd = 140, kSide = 80;
    GltfBuilder crowd = build(makeHills(kSide), meshopt("TRIANGLES"));
    json& primitive = crowd.document["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", primitive["attributes"]["POSITION"]}}};
    for (std::size_t i = 1; i < kCrowd; ++i) {
        crowd.addNode({{"mesh", 0}, {"weights", {i}}});
    }
    EXPECT_EQ(load(crowd, litByTheSky()).meshes.size(), kCrowd);
}

// The rules for a material are ten times as many as those for a node. A material that has nothing costs little for that.
TEST(GltfCosts, EmptyMaterials)
{
    const auto materials = [](std::size_t count) {
        GltfBuilder builder = build(makeHills(3), addPlain);
        for (std::size_t i = 0; i < count; ++i) {
            builder.document["materials"].push_back(json::object());
        }
        return builder;
    };
    EXPECT_LT(secondsOf(materials(40'000)), 8.0 * secondsOf(materials(10'000)));
}

TEST(GltfCosts, ChainsOfNodes)
{
    const auto chain = [](std::size_t length) {
        GltfBuilder builder = build(makeHills(3), addPlain);
        builder.document["scenes"][0]["nodes"] = {1};
        for (std::size_t i = 1; i <= length; ++i) {
            builder.document["nodes"].push_back({{"children", {i == length ? 0 : i + 1}}, {"translation", {1e-9, 0, 0}}});
        }
        return builder;
    };
    EXPECT_LT(secondsOf(chain(40'000)), 8.0 * secondsOf(chain(10'000)));
}

}  // namespace
}  // namespace glim::test
