// Encodes geometry with the libraries whose decoders the loader uses, and puts it into glTF.
#pragma once

#include "tests/support/gltf_builder.hpp"

#include <functional>

namespace glim::test {

// A triangle list with every attribute that the loader reads, one value for each vertex.
struct Geometry {
    std::vector<float> positions, normals, uvs;  // 3, 3 and 2 numbers for each vertex
    std::vector<std::uint8_t> colors;            // 4
    std::vector<std::uint32_t> indices;

    std::size_t vertexCount() const { return positions.size() / 3; }
};

// A bumpy height field over [-1, 1]^2 of side^2 vertices.
Geometry makeHills(std::uint32_t side);

nlohmann::json addPlain(GltfBuilder& builder, const Geometry& geometry);  // returns the primitive

// Streams of EXT_meshopt_compression.
Bytes encodeAttributes(const Bytes& values, std::size_t stride);
Bytes encodeTriangles(const std::vector<std::uint32_t>& indices);
Bytes encodeIndices(const std::vector<std::uint32_t>& indices);

struct MeshoptView {
    std::string extension = "EXT_meshopt_compression";
    std::string mode = "ATTRIBUTES", filter = "NONE";
    std::size_t stride = 0, count = 0;
};

// Adds the stream, and a view of a fallback buffer without bytes that the stream stands for. Returns the view.
std::size_t addMeshoptView(GltfBuilder& builder, const Bytes& stream, const MeshoptView& view);
nlohmann::json addMeshopt(GltfBuilder& builder, const Geometry& geometry, const std::string& indexMode);

struct DracoOptions {
    bool edgebreaker = true;
    int quantizationBits = 0;  // 0: values are kept as they are
    bool metadata = false;
    int speed = 5;  // 0 to 10; below 4 texture coordinates are predicted from positions
};

// Unique ids of the attributes are those of kDracoAttributes.
Bytes encodeDraco(const Geometry& geometry, const DracoOptions& options);
inline const nlohmann::json kDracoAttributes{{"POSITION", 9}, {"NORMAL", 4}, {"TEXCOORD_0", 7}, {"COLOR_0", 2}};

nlohmann::json addDraco(GltfBuilder& builder, const Geometry& geometry, const DracoOptions& options);

// One way of writing geometry; a file of one node that has it.
using AddGeometry = std::function<nlohmann::json(GltfBuilder&, const Geometry&)>;
GltfBuilder build(const Geometry& geometry, const AddGeometry& add);

AddGeometry meshopt(const std::string& indexMode);
AddGeometry draco(const DracoOptions& options);

// Spares making the studio.
LoadOptions litByTheSky();

}  // namespace glim::test
