#include "host/scene/gltf/read_geometry.hpp"

#include "host/image/srgb.hpp"
#include "host/scene/gltf/read_accessor.hpp"
#include "host/scene/gltf/read_material.hpp"

#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

namespace glim {
namespace {

std::vector<glm::dvec3> readPositions(const GltfFile& file, std::size_t accessor, const std::string& place)
{
    const std::string use = "POSITION of " + place;
    std::vector<glm::dvec3> positions = readVectors<glm::dvec3>(file, accessor, use);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            if (!std::isfinite(positions[i][c])) {
                refuse(file, MessageId::OutOfRange,
                       {part::place("accessors[" + std::to_string(accessor) + "] (" + use + ")"), " holds ",
                        part::value(toText(positions[i][c])), " in element ", std::to_string(i), "; expected ",
                        part::expected("finite numbers")});
            }
        }
    }
    return positions;
}

std::vector<std::uint32_t> readVertexOrder(const GltfFile& file, const tinygltf::Primitive& primitive, std::size_t vertexCount,
                                           const std::string& place)
{
    if (primitive.indices < 0) {
        std::vector<std::uint32_t> order(vertexCount);
        std::iota(order.begin(), order.end(), 0U);
        return order;
    }
    const auto accessor = static_cast<std::size_t>(primitive.indices);
    std::vector<std::uint32_t> order = readIndices(file, accessor, "indices of " + place);
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (order[i] >= vertexCount) {
            refuse(file, MessageId::DanglingIndex,
                   {part::place("accessors[" + std::to_string(accessor) + "] (indices of " + place + ")"), " holds ",
                    part::value(std::to_string(order[i])), " in element ", std::to_string(i), "; expected ",
                    part::expected("indices below " + std::to_string(vertexCount))});
        }
    }
    return order;
}

// glTF 2.0, section 3.7.2.1: triangle i of a strip is (i, i + 1 + i % 2, i + 2 - i % 2), of a fan (i + 1, i + 2, 0).
std::vector<std::uint32_t> listTriangles(const std::vector<std::uint32_t>& order, int mode)
{
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        return order;
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * order.size());
    for (std::size_t i = 0; i + 2 < order.size(); ++i) {
        const std::size_t odd = i % 2;
        if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            indices.insert(indices.end(), {order[i], order[i + 1 + odd], order[i + 2 - odd]});
        } else {
            indices.insert(indices.end(), {order[i + 1], order[i + 2], order[0]});
        }
    }
    return indices;
}

void checkVertexCount(const GltfFile& file, std::size_t count, int mode, const std::string& place)
{
    if (mode == TINYGLTF_MODE_TRIANGLES && count % 3 != 0) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place), " has ", part::value(std::to_string(count)), " vertices for triangles; expected ",
                part::expected("a multiple of 3")});
    }
    if (count < 3) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place), " has ", part::value(std::to_string(count)), " vertices for a strip or fan; expected ",
                part::expected("at least 3")});
    }
}

// KHR_materials_variants: the mapping that lists the variant, else the primitive's own.
int getMaterial(const GltfFile& file, const tinygltf::Primitive& primitive)
{
    const auto extension = primitive.extensions.find("KHR_materials_variants");
    if (!file.variant || extension == primitive.extensions.end() || !extension->second.Has("mappings")) {
        return primitive.material;
    }
    const tinygltf::Value& mappings = extension->second.Get("mappings");
    for (std::size_t i = 0; i < mappings.ArrayLen(); ++i) {
        const tinygltf::Value& mapping = mappings.Get(static_cast<int>(i));
        const tinygltf::Value variants = mapping.Has("variants") ? mapping.Get("variants") : tinygltf::Value();
        for (std::size_t j = 0; variants.IsArray() && j < variants.ArrayLen(); ++j) {
            if (static_cast<std::size_t>(variants.Get(static_cast<int>(j)).GetNumberAsInt()) == *file.variant) {
                return mapping.Get("material").GetNumberAsInt();
            }
        }
    }
    return primitive.material;
}

std::array<std::uint32_t, 2> uvSetsOf(const GltfFile& file, int material)
{
    Warnings unheard;
    return readMaterial(file, material, unheard).uvSets;
}

std::vector<glm::vec2> readUvs(const GltfFile& file, const tinygltf::Primitive& primitive, std::uint32_t set, std::size_t vertexCount,
                               const std::string& place)
{
    const std::string attribute = "TEXCOORD_" + std::to_string(set);
    return readAttribute<glm::vec2>(file, primitive.attributes, attribute, "texture coordinates of set " + std::to_string(set), vertexCount,
                                    place);
}

Mesh readTriangles(const GltfFile& file, const tinygltf::Primitive& primitive, int material, const std::string& place)
{
    Mesh mesh;
    mesh.positions = readPositions(file, static_cast<std::size_t>(primitive.attributes.at("POSITION")), place);
    const std::size_t count = mesh.positions.size();
    mesh.normals = readAttribute<glm::dvec3>(file, primitive.attributes, "NORMAL", "normals", count, place);
    mesh.tangents = readAttribute<glm::vec4>(file, primitive.attributes, "TANGENT", "tangents", count, place);
    mesh.uv0 = readUvs(file, primitive, uvSetsOf(file, material)[0], count, place);
    mesh.uv1 = readUvs(file, primitive, uvSetsOf(file, material)[1], count, place);
    mesh.colors = readAttribute<glm::vec4>(file, primitive.attributes, "COLOR_0", "vertex colours", count, place);
    const std::vector<std::uint32_t> order = readVertexOrder(file, primitive, count, place);
    checkVertexCount(file, order.size(), primitive.mode, place);
    mesh.indices = listTriangles(order, primitive.mode);
    return mesh;
}

constexpr const char* kSplatting = "KHR_gaussian_splatting";

// The colours of splats as they are seen from everywhere: the first spherical harmonic, of the extension's colour space.
std::vector<glm::vec4> readSplatColors(const GltfFile& file, const tinygltf::Primitive& primitive, std::size_t count,
                                       const std::string& place)
{
    constexpr float kHarmonic = 0.28209479F;  // 1 / (2 sqrt(pi))
    const tinygltf::Value& splatting = primitive.extensions.at(kSplatting);
    const bool isLinear = splatting.Has("colorSpace") && splatting.Get("colorSpace").IsString() &&
                          splatting.Get("colorSpace").Get<std::string>() == "lin_rec709_display";
    std::vector<glm::vec4> colors;
    for (const glm::dvec3& coefficient : readAttribute<glm::dvec3>(
             file, primitive.attributes, std::string(kSplatting) + ":SH_DEGREE_0_COEF_0", "colours of splats", count, place)) {
        glm::vec4 color(1.0F);
        for (int c = 0; c < 3; ++c) {
            const float seen = 0.5F + kHarmonic * static_cast<float>(coefficient[c]);
            color[c] = isLinear ? seen : static_cast<float>(linearFromSrgb(static_cast<double>(seen)));
        }
        colors.push_back(color);
    }
    return colors;
}

std::vector<glm::uvec2> listLines(const GltfFile& file, const std::vector<std::uint32_t>& order, int mode, const std::string& place)
{
    const bool isPairs = mode == TINYGLTF_MODE_LINE;
    if (order.size() < 2 || (isPairs && order.size() % 2 != 0)) {
        refuse(file, MessageId::OutOfRange,
               {part::place(place), " has ", part::value(std::to_string(order.size())), " vertices for lines; expected ",
                part::expected(isPairs ? "a multiple of 2" : "at least 2")});
    }
    std::vector<glm::uvec2> lines;
    for (std::size_t i = 0; i + 1 < order.size(); i += isPairs ? 2 : 1) {
        lines.emplace_back(order[i], order[i + 1]);
    }
    if (mode == TINYGLTF_MODE_LINE_LOOP) {
        lines.emplace_back(order.back(), order.front());
    }
    return lines;
}

// extras.radius, else 0.
double readPointRadius(const tinygltf::Primitive& primitive, const std::string& place, Warnings& warnings)
{
    if (!primitive.extras.IsObject() || !primitive.extras.Has("radius")) {
        return 0.0;
    }
    const tinygltf::Value& radius = primitive.extras.Get("radius");
    if (radius.IsNumber() && radius.GetNumberAsDouble() > 0.0 && std::isfinite(radius.GetNumberAsDouble())) {
        return radius.GetNumberAsDouble();
    }
    warnings.add(MessageId::ExtrasIgnored, "radii of points or lines that are no number above 0 are ignored", place + ".extras.radius");
    return 0.0;
}

// A cloud. `indices` still choose from its points, as they are posed first.
Mesh readCloud(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& place, Warnings& warnings)
{
    Mesh mesh;
    mesh.isCloud = true;
    mesh.positions = readPositions(file, static_cast<std::size_t>(primitive.attributes.at("POSITION")), place);
    const std::size_t count = mesh.positions.size();
    mesh.colors = readAttribute<glm::vec4>(file, primitive.attributes, "COLOR_0", "vertex colours", count, place);
    mesh.pointRadius = readPointRadius(primitive, place, warnings);
    if (primitive.mode != TINYGLTF_MODE_POINTS) {
        mesh.lines = listLines(file, readVertexOrder(file, primitive, count, place), primitive.mode, place);
    } else if (primitive.indices >= 0) {
        mesh.indices = readVertexOrder(file, primitive, count, place);
    }
    if (primitive.extensions.count(kSplatting) > 0) {
        warnings.add(MessageId::SplatsAsPoints, "splats (KHR_gaussian_splatting) are drawn as opaque points", place);
        mesh.colors = mesh.colors.empty() ? readSplatColors(file, primitive, count, place) : mesh.colors;
    }
    return mesh;
}

template <class Value>
void choose(std::vector<Value>& values, const std::vector<std::uint32_t>& indices)
{
    std::vector<Value> chosen;
    if (!values.empty()) {
        chosen.reserve(indices.size());
        for (const std::uint32_t index : indices) {
            chosen.push_back(values[index]);
        }
    }
    values = std::move(chosen);
}

void choosePoints(Mesh& cloud)
{
    const std::vector<std::uint32_t> indices = std::exchange(cloud.indices, {});
    if (!indices.empty()) {
        choose(cloud.positions, indices);
        choose(cloud.colors, indices);
    }
}

std::optional<Mesh> readPrimitive(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& place, Warnings& warnings)
{
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
        warnings.add(MessageId::MeshWithoutPosition, "meshes without POSITION are left out", place);
        return std::nullopt;
    }
    const auto isEmpty = [&file](int accessor) {
        return accessor >= 0 && file.model.accessors[static_cast<std::size_t>(accessor)].count == 0;
    };
    if (isEmpty(position->second) || isEmpty(primitive.indices)) {
        warnings.add(MessageId::EmptyMesh, "meshes without vertices are left out", place);
        return std::nullopt;
    }
    const int material = getMaterial(file, primitive);
    Mesh mesh = primitive.mode < TINYGLTF_MODE_TRIANGLES ? readCloud(file, primitive, place, warnings)
                                                         : readTriangles(file, primitive, material, place);
    mesh.material = static_cast<std::uint32_t>(material < 0 ? static_cast<int>(file.model.materials.size()) : material);
    return mesh;
}

}  // namespace

std::vector<Mesh> readMeshes(const GltfFile& file, std::size_t mesh, const MeshPose& pose, Warnings& warnings)
{
    const tinygltf::Mesh& source = file.model.meshes[mesh];
    std::vector<Mesh> meshes;
    for (std::size_t i = 0; i < source.primitives.size(); ++i) {
        const std::string place = label("meshes", mesh, source.name) + ".primitives[" + std::to_string(i) + "]";
        if (std::optional<Mesh> read = readPrimitive(file, source.primitives[i], place, warnings)) {
            poseMesh(file, source, i, pose, place, *read, warnings);
            if (read->isCloud) {
                choosePoints(*read);
            }
            read->name = source.primitives.size() == 1 ? source.name : source.name + "." + std::to_string(i);
            read->fileMesh = static_cast<std::uint32_t>(mesh);
            meshes.push_back(std::move(*read));
        }
    }
    return meshes;
}

}  // namespace glim
