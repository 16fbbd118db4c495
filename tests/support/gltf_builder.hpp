// glTF files put together in a test, byte by byte.
#pragma once

#include "host/scene/load_gltf.hpp"
#include "tests/support/expect_message.hpp"

#include <nlohmann/json.hpp>

#include <cstring>
#include <string>
#include <vector>

namespace glim::test {

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;

using Bytes = std::vector<unsigned char>;

template <typename Value>
Bytes toBytes(const std::vector<Value>& values)
{
    Bytes bytes(values.size() * sizeof(Value));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

// A document with one buffer that grows; empty but for asset, scene and scenes.
class GltfBuilder {
public:
    GltfBuilder();

    std::size_t append(const std::string& collection, const nlohmann::json& entry);
    std::size_t addAov(const Bytes& bytes);
    std::size_t addAccessor(const Bytes& bytes, int componentType, const std::string& type, std::size_t count);
    std::size_t addVec3(const std::vector<float>& values);
    std::size_t addIndices(const std::vector<std::uint32_t>& values);
    std::size_t addMesh(const nlohmann::json& primitive);
    // Appends the node and makes it a root of scene 0.
    std::size_t addNode(const nlohmann::json& node);
    // The triangle (0,0,0) (1,0,0) (0,1,0), front towards +Z, in a mesh of its own; returns the mesh.
    std::size_t addTriangleMesh();

    std::string toGltf() const;  // buffer as data URI
    std::string toGlb() const;
    const Bytes& bytes() const { return bytes_; }

    nlohmann::json document;
    nlohmann::json otherBuffers = nlohmann::json::array();  // after the one that grows

private:
    Bytes bytes_;
};

// A node with such a triangle, and what else is given of the node.
GltfBuilder oneTriangle(nlohmann::json node = nlohmann::json::object());

// A triangle with a skin of two joints and a morph target; animation 0 turns a joint and moves the target's weight.
GltfBuilder posedTriangle();
// A triangle that moves for a second and has the variants "day" and "night", three points, and a lamp.
GltfBuilder variedTriangle();

// Writes below the test's own temporary folder; returns the path.
std::string writeTemporary(const std::string& name, const std::string& content);

Scene loadText(const std::string& content, const LoadOptions& options = {});
Scene load(const GltfBuilder& builder, const LoadOptions& options = {});

// Whether there is a warning with this id, whose place has `place` in it.
bool hasWarning(const std::vector<Message>& warnings, MessageId id, const std::string& place = "");
// The one warning with this id; fails if there is none or another.
Message findWarning(const std::vector<Message>& warnings, MessageId id);

// Of a corner of a triangle of the flattened scene, in the world.
glm::vec3 vertex(const Scene& scene, std::size_t triangle, int corner);
glm::vec3 normal(const Scene& scene, std::size_t triangle, int corner);
// Of the mesh of an instance, in the world.
glm::dvec3 placedVertex(const Scene& scene, std::size_t index, std::size_t instance = 0);

// The file `builder` makes is refused so.
void expectRefused(const GltfBuilder& builder, MessageId id, const Parts& parts, const LoadOptions& options = {});

}  // namespace glim::test
