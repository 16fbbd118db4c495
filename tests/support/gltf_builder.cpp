#include "tests/support/gltf_builder.hpp"

#include "host/error.hpp"
#include "host/flatten/primitives.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace glim::test {
namespace {

using nlohmann::json;

std::string toBase64(const Bytes& bytes)
{
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? digits[group >> (18U - 6U * k) & 63U] : '=';
        }
    }
    return text;
}

std::string u32(std::size_t value)
{
    std::string bytes;
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes += static_cast<char>(value >> shift & 255U);
    }
    return bytes;
}

}  // namespace

GltfBuilder::GltfBuilder()
    : document{{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", json::array({{{"nodes", json::array()}}})}}
{}

std::size_t GltfBuilder::append(const std::string& collection, const json& entry)
{
    document[collection].push_back(entry);
    return document[collection].size() - 1;
}

std::size_t GltfBuilder::addAov(const Bytes& bytes)
{
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    const std::size_t offset = bytes_.size();
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
}

std::size_t GltfBuilder::addAccessor(const Bytes& bytes, int componentType, const std::string& type, std::size_t count)
{
    return append("accessors", {{"bufferView", addAov(bytes)}, {"componentType", componentType}, {"type", type}, {"count", count}});
}

std::size_t GltfBuilder::addVec3(const std::vector<float>& values)
{
    return addAccessor(toBytes(values), kFloat, "VEC3", values.size() / 3);
}

std::size_t GltfBuilder::addIndices(const std::vector<std::uint32_t>& values)
{
    return addAccessor(toBytes(values), kUnsignedInt, "SCALAR", values.size());
}

std::size_t GltfBuilder::addMesh(const json& primitive) { return append("meshes", {{"primitives", json::array({primitive})}}); }

std::size_t GltfBuilder::addNode(const json& node)
{
    const std::size_t index = append("nodes", node);
    document["scenes"][0]["nodes"].push_back(index);
    return index;
}

std::size_t GltfBuilder::addTriangleMesh() { return addMesh({{"attributes", {{"POSITION", addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0})}}}}); }

GltfBuilder oneTriangle(json node)
{
    GltfBuilder builder;
    node["mesh"] = builder.addTriangleMesh();
    builder.addNode(node);
    return builder;
}

std::string GltfBuilder::toGltf() const
{
    json copy = document;
    if (!bytes_.empty()) {
        copy["buffers"] =
            json::array({{{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + toBase64(bytes_)}}});
        copy["buffers"].insert(copy["buffers"].end(), otherBuffers.begin(), otherBuffers.end());
    }
    return copy.dump();
}

std::string GltfBuilder::toGlb() const
{
    json copy = document;
    copy["buffers"] = json::array({{{"byteLength", bytes_.size()}}});
    copy["buffers"].insert(copy["buffers"].end(), otherBuffers.begin(), otherBuffers.end());
    std::string text = copy.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string binary(bytes_.begin(), bytes_.end());
    binary.resize((binary.size() + 3) / 4 * 4);
    return "glTF" + u32(2) + u32(12 + 8 + text.size() + 8 + binary.size()) + u32(text.size()) + "JSON" + text + u32(binary.size()) +
           std::string("BIN\0", 4) + binary;
}

GltfBuilder posedTriangle()
{
    GltfBuilder builder;
    const std::size_t positions = builder.addVec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::size_t joints = builder.addAccessor({0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kUnsignedByte, "VEC4", 3);
    const std::size_t weights = builder.addAccessor(toBytes<float>({0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), kFloat, "VEC4", 3);
    const std::size_t mesh = builder.addMesh({{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
                                              {"targets", {{{"POSITION", positions}}}}});
    builder.addNode({{"mesh", mesh}, {"skin", 0}, {"weights", {0.5}}});
    builder.addNode({{"translation", {1, 2, 3}}});
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    builder.append("skins", {{"joints", {0, 1}}, {"inverseBindMatrices", builder.addAccessor(toBytes(bind), kFloat, "MAT4", 2)}});
    const std::size_t times = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
    const std::size_t turns = builder.addAccessor(toBytes<float>({0, 0, 0, 1, 0, 1, 0, 0}), kFloat, "VEC4", 2);
    const json pointer = {{"KHR_animation_pointer", {{"pointer", "/nodes/0/weights/0"}}}};
    builder.append("animations", {{"samplers", {{{"input", times}, {"output", turns}}, {{"input", times}, {"output", times}}}},
                                  {"channels",
                                   {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}},
                                    {{"sampler", 1}, {"target", {{"path", "pointer"}, {"extensions", pointer}}}}}}});
    return builder;
}

GltfBuilder variedTriangle()
{
    GltfBuilder builder;
    builder.append("materials", {{"name", "clay"}});
    builder.append("materials", {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}});
    builder.document["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "day"}}, {{"name", "night"}}};
    const std::size_t mesh = builder.addTriangleMesh();
    json& primitive = builder.document["meshes"][mesh]["primitives"][0];
    primitive["material"] = 0;
    primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {1}}}};
    builder.addNode({{"mesh", mesh}});
    builder.addNode({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"translation", {0, 5, 0}}});
    const std::size_t cloud =
        builder.addMesh({{"attributes", {{"POSITION", builder.addVec3({0, 0, 1, 0, 1, 1, 0.5F, 0.5F, 1})}}}, {"mode", 0}});
    builder.addNode({{"mesh", cloud}});
    builder.document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_variants"};
    builder.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    const std::size_t times = builder.addAccessor(toBytes<float>({0, 1}), kFloat, "SCALAR", 2);
    builder.append("animations", {{"samplers", {{{"input", times}, {"output", builder.addVec3({0, 0, 0, 2, 3, 0})}}}},
                                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
    return builder;
}

std::string writeTemporary(const std::string& name, const std::string& content)
{
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    const std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / (std::string("glim_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::create_directories(folder);
    std::ofstream(folder / name, std::ios::binary) << content;
    return (folder / name).string();
}

Scene loadText(const std::string& content, const LoadOptions& options) { return loadGltf(writeTemporary("scene.gltf", content), options); }

Scene load(const GltfBuilder& builder, const LoadOptions& options) { return loadText(builder.toGltf(), options); }

bool hasWarning(const std::vector<Message>& warnings, MessageId id, const std::string& place)
{
    return std::ranges::any_of(warnings, [&](const Message& m) { return m.id == id && m.place.find(place) != std::string::npos; });
}

Message findWarning(const std::vector<Message>& warnings, MessageId id)
{
    EXPECT_EQ(std::ranges::count(warnings, id, &Message::id), 1) << toText(id) << ' ' << ::testing::PrintToString(warnings);
    const auto found = std::ranges::find(warnings, id, &Message::id);
    return found == warnings.end() ? Message(id, {}) : *found;
}

glm::vec3 vertex(const Scene& scene, std::size_t triangle, int corner)
{
    return makePrimitives(scene).triangles.at(triangle).vertices[corner] + glm::vec3(scene.origin);
}

glm::vec3 normal(const Scene& scene, std::size_t triangle, int corner)
{
    const Primitives primitives = makePrimitives(scene);
    return primitives.vertexNormals.at(primitives.vertexIndices.at(triangle)[corner]);
}

glm::dvec3 placedVertex(const Scene& scene, std::size_t index, std::size_t instance)
{
    const MeshInstance& placed = scene.instances.at(instance);
    return glm::dvec3(placed.worldFromMesh * glm::dvec4(scene.meshes.at(placed.mesh).positions.at(index), 1.0));
}

void expectRefused(const GltfBuilder& builder, MessageId id, const Parts& parts, const LoadOptions& options)
{
    expectRefusal<InputError>([&] { loadGltf(writeTemporary("scene.gltf", builder.toGltf()), options); }, id, parts);
}

}  // namespace glim::test
