#include "host/scene/gltf/read_geometry.hpp"

#include "host/scene/gltf/read_accessor.hpp"

#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <optional>

namespace glim {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kAttributes[] = {"TRANSLATION", "ROTATION", "SCALE"};

std::optional<std::size_t> findAttribute(const GltfFile& file, std::size_t node, const char* attribute)
{
    const auto extension = file.model.nodes[node].extensions.find(kInstancing);
    if (extension == file.model.nodes[node].extensions.end() || !extension->second.Has("attributes") ||
        !extension->second.Get("attributes").Has(attribute)) {
        return std::nullopt;
    }
    return static_cast<std::size_t>(extension->second.Get("attributes").Get(attribute).GetNumberAsInt());
}

// Empty without the attribute.
template <class Value>
std::vector<Value> readAttribute(const GltfFile& file, std::size_t node, const char* attribute, std::uint64_t count)
{
    const std::optional<std::size_t> accessor = findAttribute(file, node, attribute);
    if (!accessor) {
        return {};
    }
    const std::string place = std::string(attribute) + " of " + kInstancing + " of " + nodeLabel(file, node);
    if (Value::length() == 4 && file.model.accessors[*accessor].type != TINYGLTF_TYPE_VEC4) {
        refuse(file, MessageId::WrongType, {part::place(place), " has another type; expected ", part::expected("VEC4")});
    }
    std::vector<Value> values = readVectors<Value>(file, *accessor, place);
    if (values.size() != count) {
        refuse(file, MessageId::Mismatch,
               {part::place(place), " has ", part::value(std::to_string(values.size())), " elements; expected ",
                part::expected("as many as the other attributes, " + std::to_string(count))});
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int c = 0; c < Value::length(); ++c) {
            if (!std::isfinite(values[i][c])) {
                refuse(file, MessageId::OutOfRange,
                       {part::place(place), " holds ", part::value(toText(static_cast<double>(values[i][c]))), " in element ",
                        std::to_string(i), "; expected ", part::expected("finite numbers")});
            }
        }
    }
    return values;
}

}  // namespace

std::uint64_t countInstances(const GltfFile& file, std::size_t node)
{
    for (const char* attribute : kAttributes) {
        if (const std::optional<std::size_t> accessor = findAttribute(file, node, attribute)) {
            return file.model.accessors[*accessor].count;
        }
    }
    return 1;
}

std::uint64_t countUnbackedInstances(const GltfFile& file, std::size_t node)
{
    std::uint64_t count = 0;
    for (const char* attribute : kAttributes) {
        if (const std::optional<std::size_t> accessor = findAttribute(file, node, attribute)) {
            count = countUnbacked(file, *accessor);
            if (count == 0) {
                return 0;
            }
        }
    }
    return count;
}

std::vector<glm::dmat4> readInstanceTransforms(const GltfFile& file, std::size_t node)
{
    const std::uint64_t count = countInstances(file, node);
    const auto translations = readAttribute<glm::dvec3>(file, node, "TRANSLATION", count);
    const auto rotations = readAttribute<glm::vec4>(file, node, "ROTATION", count);
    const auto scales = readAttribute<glm::dvec3>(file, node, "SCALE", count);
    std::vector<glm::dmat4> transforms;
    transforms.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        glm::dmat4 transform(1.0);
        if (!rotations.empty()) {
            const glm::dvec4 q(rotations[i]);
            if (!(glm::dot(q, q) > 0.0)) {
                refuse(file, MessageId::Degenerate,
                       {part::place(std::string("ROTATION of ") + kInstancing + " of " + nodeLabel(file, node)), " is ", part::value("0"),
                        " in element ", std::to_string(i), "; expected ", part::expected("unit quaternions")});
            }
            transform = glm::dmat4(glm::mat3_cast(glm::normalize(glm::dquat(q.w, q.x, q.y, q.z))));
        }
        for (int c = 0; c < 3; ++c) {
            transform[c] *= scales.empty() ? 1.0 : scales[i][c];
            transform[3][c] = translations.empty() ? 0.0 : translations[i][c];
        }
        transforms.push_back(transform);
    }
    return transforms;
}

}  // namespace glim
