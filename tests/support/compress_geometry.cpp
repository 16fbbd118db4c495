#include "tests/support/compress_geometry.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <cmath>

namespace glim::test {
namespace {

using nlohmann::json;

template <typename Value>
json addAccessor(GltfBuilder& builder, const std::vector<Value>& values, int componentType, const char* type, std::size_t components)
{
    return builder.addAccessor(toBytes(values), componentType, type, values.size() / components);
}

template <typename Value>
int addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, const std::vector<Value>& values, int components,
                 draco::DataType dataType, const char* name)
{
    draco::GeometryAttribute attribute;
    const auto stride = static_cast<std::int64_t>(components * sizeof(Value));
    attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), dataType, dataType == draco::DT_UINT8, stride, 0);
    const auto count = static_cast<std::uint32_t>(values.size() / static_cast<std::size_t>(components));
    const int id = mesh.AddAttribute(attribute, true, count);
    for (std::uint32_t i = 0; i < count; ++i) {
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i * static_cast<std::size_t>(components)]);
    }
    mesh.attribute(id)->set_unique_id(kDracoAttributes[name].get<std::uint32_t>());
    return id;
}

}  // namespace

Geometry makeHills(std::uint32_t side)
{
    Geometry geometry;
    const float step = 2.0F / static_cast<float>(side - 1);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const float x = -1.0F + step * static_cast<float>(i % side), y = -1.0F + step * static_cast<float>(i / side);
        geometry.positions.insert(geometry.positions.end(), {x, y, 0.2F * std::sin(3.0F * x) * std::cos(2.0F * y)});
        const float dx = 0.6F * std::cos(3.0F * x) * std::cos(2.0F * y), dy = -0.4F * std::sin(3.0F * x) * std::sin(2.0F * y);
        const float length = std::sqrt(dx * dx + dy * dy + 1.0F);
        geometry.normals.insert(geometry.normals.end(), {-dx / length, -dy / length, 1.0F / length});
        geometry.uvs.insert(geometry.uvs.end(), {0.5F + 0.5F * x, 0.5F - 0.5F * y});
        geometry.colors.insert(geometry.colors.end(), {static_cast<std::uint8_t>(7 * i), static_cast<std::uint8_t>(13 * i), 200, 255});
    }
    for (std::uint32_t i = 0; i + side < side * side; ++i) {
        if ((i + 1) % side != 0) {
            geometry.indices.insert(geometry.indices.end(), {i, i + 1, i + side, i + side, i + 1, i + side + 1});
        }
    }
    return geometry;
}

json addPlain(GltfBuilder& builder, const Geometry& geometry)
{
    json attributes = {{"POSITION", addAccessor(builder, geometry.positions, kFloat, "VEC3", 3)},
                       {"NORMAL", addAccessor(builder, geometry.normals, kFloat, "VEC3", 3)},
                       {"TEXCOORD_0", addAccessor(builder, geometry.uvs, kFloat, "VEC2", 2)},
                       {"COLOR_0", addAccessor(builder, geometry.colors, kUnsignedByte, "VEC4", 4)}};
    builder.document["accessors"][attributes["COLOR_0"].get<std::size_t>()]["normalized"] = true;
    return {{"attributes", attributes}, {"indices", builder.addIndices(geometry.indices)}};
}

Bytes encodeAttributes(const Bytes& values, std::size_t stride)
{
    Bytes stream(meshopt_encodeVertexBufferBound(values.size() / stride, stride));
    stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), values.data(), values.size() / stride, stride));
    return stream;
}

Bytes encodeTriangles(const std::vector<std::uint32_t>& indices)
{
    Bytes stream(meshopt_encodeIndexBufferBound(indices.size(), indices.size()));
    stream.resize(meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
    return stream;
}

Bytes encodeIndices(const std::vector<std::uint32_t>& indices)
{
    Bytes stream(meshopt_encodeIndexSequenceBound(indices.size(), indices.size()));
    stream.resize(meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), indices.size()));
    return stream;
}

std::size_t addMeshoptView(GltfBuilder& builder, const Bytes& stream, const MeshoptView& view)
{
    const std::size_t added = builder.addAov(stream);
    json& entry = builder.document["bufferViews"][added];
    const json extension = {{"buffer", 0},          {"byteOffset", entry["byteOffset"]}, {"byteLength", stream.size()},
                            {"count", view.count},  {"byteStride", view.stride},         {"mode", view.mode},
                            {"filter", view.filter}};
    entry = {{"buffer", 1}, {"byteLength", view.count * view.stride}, {"extensions", {{view.extension, extension}}}};
    builder.otherBuffers = json::array({{{"byteLength", 1U << 20U}, {"extensions", {{view.extension, {{"fallback", true}}}}}}});
    return added;
}

json addMeshopt(GltfBuilder& builder, const Geometry& geometry, const std::string& indexMode)
{
    json primitive = addPlain(builder, geometry);
    const auto compress = [&](const json& accessor, const Bytes& stream, const MeshoptView& view) {
        builder.document["accessors"][accessor.get<std::size_t>()]["bufferView"] = addMeshoptView(builder, stream, view);
    };
    const std::size_t count = geometry.vertexCount();
    json& attributes = primitive["attributes"];
    compress(attributes["POSITION"], encodeAttributes(toBytes(geometry.positions), 12), {.stride = 12, .count = count});
    compress(attributes["NORMAL"], encodeAttributes(toBytes(geometry.normals), 12), {.stride = 12, .count = count});
    compress(attributes["TEXCOORD_0"], encodeAttributes(toBytes(geometry.uvs), 8), {.stride = 8, .count = count});
    compress(attributes["COLOR_0"], encodeAttributes(toBytes(geometry.colors), 4), {.stride = 4, .count = count});
    compress(primitive["indices"], indexMode == "TRIANGLES" ? encodeTriangles(geometry.indices) : encodeIndices(geometry.indices),
             {.mode = indexMode, .stride = 4, .count = geometry.indices.size()});
    return primitive;
}

Bytes encodeDraco(const Geometry& geometry, const DracoOptions& options)
{
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(geometry.vertexCount()));
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        mesh.AddFace({draco::PointIndex(geometry.indices[i]), draco::PointIndex(geometry.indices[i + 1]),
                      draco::PointIndex(geometry.indices[i + 2])});
    }
    using Attribute = draco::GeometryAttribute;
    const int ids[] = {addAttribute(mesh, Attribute::POSITION, geometry.positions, 3, draco::DT_FLOAT32, "POSITION"),
                       addAttribute(mesh, Attribute::NORMAL, geometry.normals, 3, draco::DT_FLOAT32, "NORMAL"),
                       addAttribute(mesh, Attribute::TEX_COORD, geometry.uvs, 2, draco::DT_FLOAT32, "TEXCOORD_0")};
    addAttribute(mesh, Attribute::COLOR, geometry.colors, 4, draco::DT_UINT8, "COLOR_0");
    if (options.metadata) {
        auto metadata = std::make_unique<draco::GeometryMetadata>();
        metadata->AddEntryString("author", "a test");
        mesh.AddMetadata(std::move(metadata));
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(options.edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING : draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(options.speed, options.speed);
    for (const int id : ids) {
        if (options.quantizationBits > 0) {
            encoder.SetAttributeQuantization(id, options.quantizationBits);
        }
    }
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok()) {
        return {};
    }
    const auto* first = reinterpret_cast<const unsigned char*>(buffer.data());
    return {first, first + buffer.size()};
}

json addDraco(GltfBuilder& builder, const Geometry& geometry, const DracoOptions& options)
{
    const std::size_t view = builder.addAov(encodeDraco(geometry, options));
    const auto add = [&builder](int componentType, const char* type, std::size_t count) {
        return builder.append("accessors", {{"componentType", componentType}, {"type", type}, {"count", count}});
    };
    const std::size_t count = geometry.vertexCount();
    json attributes = {{"POSITION", add(kFloat, "VEC3", count)},
                       {"NORMAL", add(kFloat, "VEC3", count)},
                       {"TEXCOORD_0", add(kFloat, "VEC2", count)},
                       {"COLOR_0", add(kUnsignedByte, "VEC4", count)}};
    builder.document["accessors"][attributes["COLOR_0"].get<std::size_t>()]["normalized"] = true;
    return {{"attributes", attributes},
            {"indices", add(kUnsignedShort, "SCALAR", geometry.indices.size())},
            {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", kDracoAttributes}}}}}};
}

GltfBuilder build(const Geometry& geometry, const AddGeometry& add)
{
    GltfBuilder builder;
    builder.addNode({{"mesh", builder.addMesh(add(builder, geometry))}});
    return builder;
}

AddGeometry meshopt(const std::string& indexMode)
{
    return [indexMode](GltfBuilder& builder, const Geometry& geometry) { return addMeshopt(builder, geometry, indexMode); };
}

AddGeometry draco(const DracoOptions& options)
{
    return [options](GltfBuilder& builder, const Geometry& geometry) { return addDraco(builder, geometry, options); };
}

LoadOptions litByTheSky()
{
    LoadOptions options;
    options.environment = glm::vec3(1.0F);
    return options;
}

}  // namespace glim::test
