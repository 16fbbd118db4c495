#include "host/error.hpp"
#include "host/memory.hpp"
#include "host/scene/gltf/decompress.hpp"
#include "host/scene/gltf/read_accessor.hpp"

#include <nlohmann/json.hpp>

#include <draco/compression/decode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <exception>
#include <map>
#include <memory>

namespace glim {
namespace {

using nlohmann::json;

constexpr const char* kExtension = "KHR_draco_mesh_compression";

// No container of a right stream needs more bytes: four components of 4 bytes for each corner, in a vector that has doubled, or the lists
// of a small mesh. Wrong streams ask for 2^31 orientations of texture coordinates, of which a few bytes give any number in some seconds.
constexpr std::uint64_t kBytesPerIndex = 32, kBytesOfSmallMesh = std::uint64_t{1} << 20U;

draco::DecoderBuffer bufferOf(std::span<const unsigned char> bytes)
{
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return buffer;
}

// The number of faces that a mesh of bitstream 2.2 declares before anything is decoded (Draco's bitstream specification, DecodeHeader,
// DecodeMetadata, DecodeSequentialConnectivityData and DecodeEdgebreakerConnectivityData).
std::optional<std::uint32_t> readFaceCount(std::span<const unsigned char> bytes)
{
    draco::DecoderBuffer buffer = bufferOf(bytes);
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok() || header.encoder_type != draco::TRIANGULAR_MESH ||
        DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor) != draco::kDracoMeshBitstreamVersion) {
        return std::nullopt;
    }
    buffer.set_bitstream_version(draco::kDracoMeshBitstreamVersion);
    draco::GeometryMetadata metadata;
    if ((header.flags & METADATA_FLAG_MASK) != 0 && !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata)) {
        return std::nullopt;
    }
    std::uint8_t traversal = 0;
    std::uint32_t vertices = 0, faces = 0;
    const bool edgebreaker = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING;
    if (edgebreaker && !(buffer.Decode(&traversal) && draco::DecodeVarint(&vertices, &buffer))) {
        return std::nullopt;
    }
    return draco::DecodeVarint(&faces, &buffer) ? std::optional(faces) : std::nullopt;
}

// Damage shows in the status, or in what the library asks of its containers.
draco::StatusOr<std::unique_ptr<draco::Mesh>> decodeStream(std::span<const unsigned char> bytes, std::uint64_t indexCount)
{
    try {
        const AllocationLimit limit(kBytesOfSmallMesh + kBytesPerIndex * indexCount);
        draco::DecoderBuffer buffer = bufferOf(bytes);
        return draco::Decoder().DecodeMeshFromBuffer(&buffer);
    } catch (const std::bad_alloc&) {
        return draco::Status(draco::Status::DRACO_ERROR, "it needs more memory than its triangles could fill");
    } catch (const std::exception& error) {
        return draco::Status(draco::Status::DRACO_ERROR, error.what());
    }
}

template <typename Component>
bool appendValues(const draco::PointAttribute& attribute, std::uint32_t points, std::vector<unsigned char>& bytes)
{
    const auto components = static_cast<std::int8_t>(attribute.num_components());
    const std::size_t size = sizeof(Component) * static_cast<std::size_t>(components);
    std::vector<Component> value(static_cast<std::size_t>(components));
    for (std::uint32_t i = 0; i < points; ++i) {
        const draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(i));
        if (index.value() >= attribute.size() || !attribute.ConvertValue<Component>(index, components, value.data())) {
            return false;
        }
        const auto* first = reinterpret_cast<const unsigned char*>(value.data());
        bytes.insert(bytes.end(), first, first + size);
    }
    return true;
}

// Appends one element for each point, packed, in the accessor's type.
bool appendValues(const draco::PointAttribute& attribute, int componentType, std::uint32_t points, std::vector<unsigned char>& bytes)
{
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return appendValues<std::int8_t>(attribute, points, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return appendValues<std::uint8_t>(attribute, points, bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return appendValues<std::int16_t>(attribute, points, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return appendValues<std::uint16_t>(attribute, points, bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return appendValues<std::uint32_t>(attribute, points, bytes);
    case TINYGLTF_COMPONENT_TYPE_FLOAT: return appendValues<float>(attribute, points, bytes);
    default: return false;
    }
}

class PrimitiveDecoder {
public:
    PrimitiveDecoder(const std::string& path, json& document, std::uint64_t ownBytes, Buffers& buffers)
        : path_(path),
          document_(document),
          buffers_(buffers),
          room_(countMostUnbacked(ownBytes))
    {}

    // `place` names the primitive in messages.
    void decode(json& primitive, const std::string& place)
    {
        const json source = primitive["extensions"][kExtension];
        const auto view = source["bufferView"].get<std::size_t>();
        place_ = "bufferViews[" + std::to_string(view) + "] (" + kExtension + " of " + place + ")";
        require(primitive.value("mode", TINYGLTF_MODE_TRIANGLES) == TINYGLTF_MODE_TRIANGLES && primitive.contains("indices"),
                MessageId::WrongType,
                {part::place(place_), " belongs to a primitive that is no ", part::expected("indexed triangle list"), "; expected one"});
        const std::span<const unsigned char> bytes =
            findBytes(path_, buffers_, getRange(document_["bufferViews"][view]), "bufferViews[" + std::to_string(view) + "]");
        takeRoom(primitive, source["attributes"]);
        const std::unique_ptr<draco::Mesh> mesh = decodeMesh(bytes, countElements(primitive["indices"]));

        std::vector<unsigned char> decoded;
        const std::size_t newView = document_["bufferViews"].size();
        primitive["indices"] = appendIndices(*mesh, primitive["indices"], newView, decoded);
        for (auto& [name, accessor] : primitive["attributes"].items()) {
            if (source["attributes"].contains(name)) {
                accessor = appendAttribute(*mesh, name, source["attributes"][name], accessor, newView, decoded);
            }
        }
        document_["bufferViews"].push_back({{"buffer", buffers_.size()}, {"byteLength", decoded.size()}});
        buffers_.push_back(std::move(decoded));
        primitive["extensions"].erase(kExtension);
    }

private:
    void require(bool right, MessageId id, std::initializer_list<MessagePart> words) const
    {
        if (!right) {
            refuse(path_, id, words);
        }
    }

    const json& accessorOf(const json& index) const { return document_["accessors"][index.get<std::size_t>()]; }

    std::uint64_t countElements(const json& index) const { return accessorOf(index)["count"].get<std::uint64_t>(); }

    // Any number of primitives may name the same stream, and any number of attributes of a primitive the same one of its stream.
    void takeRoom(const json& primitive, const json& compressed)
    {
        std::uint64_t elements = countElements(primitive["indices"]);
        for (const auto& [name, accessor] : primitive["attributes"].items()) {
            elements += compressed.contains(name) ? countElements(accessor) : 0;
        }
        require(elements <= room_, MessageId::TooLarge,
                {part::place(place_), " claims ", part::value(std::to_string(elements)), " elements; expected ",
                 part::expected("at most the " + std::to_string(room_) + " that are left for a file of this size")});
        room_ -= elements;
    }

    std::unique_ptr<draco::Mesh> decodeMesh(std::span<const unsigned char> bytes, std::uint64_t indexCount)
    {
        const std::optional<std::uint32_t> faces = readFaceCount(bytes);
        require(faces.has_value(), MessageId::UnknownFormat,
                {part::place(place_), " does not begin with the header of a ", part::expected("Draco mesh of bitstream 2.2"),
                 "; expected one"});
        require(std::uint64_t{3} * *faces == indexCount, MessageId::Mismatch,
                {part::place(place_), " holds ", part::value(std::to_string(*faces)), " triangles; expected ",
                 part::expected("a third of the " + std::to_string(indexCount) + " indices of its accessor")});
        draco::StatusOr<std::unique_ptr<draco::Mesh>> mesh = decodeStream(bytes, indexCount);
        require(mesh.ok(), MessageId::FileDamaged,
                {part::place(place_), " is damaged (", mesh.status().error_msg_string(), "); expected ", part::expected("a Draco mesh")});
        return std::move(mesh).value();
    }

    // Appends a copy of the accessor that reads from here on in the new view.
    std::size_t addAccessor(json accessor, std::size_t view, std::size_t offset)
    {
        accessor["bufferView"] = view;
        accessor["byteOffset"] = offset;
        document_["accessors"].push_back(std::move(accessor));
        return document_["accessors"].size() - 1;
    }

    std::size_t appendIndices(const draco::Mesh& mesh, const json& index, std::size_t view, std::vector<unsigned char>& bytes)
    {
        json accessor = accessorOf(index);
        accessor["componentType"] = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
        for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
            std::uint32_t corners[3];
            std::transform(mesh.face(face).begin(), mesh.face(face).end(), corners, [](draco::PointIndex point) { return point.value(); });
            const auto* first = reinterpret_cast<const unsigned char*>(corners);
            bytes.insert(bytes.end(), first, first + sizeof corners);
        }
        return addAccessor(std::move(accessor), view, 0);
    }

    std::size_t appendAttribute(const draco::Mesh& mesh, const std::string& name, const json& id, const json& index, std::size_t view,
                                std::vector<unsigned char>& bytes)
    {
        const json accessor = accessorOf(index);
        const std::string place = " of accessors[" + std::to_string(index.get<std::size_t>()) + "] (" + name + ")";
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id.get<std::uint32_t>());
        require(attribute != nullptr, MessageId::Missing,
                {part::place(place_), " has no attribute ", part::value(id.dump()), "; expected ", part::expected("the one" + place)});
        const std::map<std::string, int> components{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
        const auto expected = components.find(accessor["type"].get<std::string>());
        require(expected != components.end() && attribute->num_components() == expected->second, MessageId::Mismatch,
                {part::place(place_), " holds elements of ", part::value(std::to_string(attribute->num_components())),
                 " components; expected ", part::expected("the " + accessor["type"].get<std::string>() + place)});
        require(accessor["count"] == mesh.num_points(), MessageId::Mismatch,
                {part::place(place_), " holds ", part::value(std::to_string(mesh.num_points())), " vertices; expected ",
                 part::expected("the " + accessor["count"].dump() + place)});
        const std::size_t offset = bytes.size();
        require(appendValues(*attribute, accessor["componentType"].get<int>(), mesh.num_points(), bytes), MessageId::OutOfRange,
                {part::place(place_), " holds values that do not fit; expected ",
                 part::expected("those of componentType " + accessor["componentType"].dump() + place)});
        return addAccessor(accessor, view, offset);
    }

    const std::string& path_;
    json& document_;
    Buffers& buffers_;
    // Elements that primitives may still claim. The streams have no limit of their own: a flat grid takes one byte for 33 indices, but one
    // for 1500 if its steps are whole steps of its quantization.
    std::uint64_t room_;
    std::string place_;
};

}  // namespace

void decompressPrimitives(const std::string& path, json& document, std::uint64_t ownBytes, Buffers& buffers)
{
    PrimitiveDecoder decoder(path, document, ownBytes, buffers);
    json none = json::array();
    json& meshes = document.contains("meshes") ? document["meshes"] : none;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        json& primitives = meshes[i]["primitives"];
        for (std::size_t j = 0; j < primitives.size(); ++j) {
            if (primitives[j].contains("extensions") && primitives[j]["extensions"].contains(kExtension)) {
                decoder.decode(primitives[j], "meshes[" + std::to_string(i) + "].primitives[" + std::to_string(j) + "]");
            }
        }
    }
}

}  // namespace glim
