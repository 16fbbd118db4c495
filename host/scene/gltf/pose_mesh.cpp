#include "host/scene/gltf/pose_mesh.hpp"

#include "host/message.hpp"
#include "host/scene/deform_mesh.hpp"
#include "host/scene/gltf/gltf_schema.hpp"
#include "host/scene/gltf/place_nodes.hpp"
#include "host/scene/gltf/read_accessor.hpp"
#include "host/text.hpp"

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// How far a vertex's weights may add up to something else than 1, and how far a weight may be below 0: both are rounded in files.
constexpr double kWeightRounding = 1e-3;

std::string skinLabel(const GltfFile& file, std::size_t skin) { return label("skins", skin, file.skins[skin].name); }

std::vector<glm::dmat4> readBindMatrices(const GltfFile& file, std::size_t index)
{
    const GltfSkin& skin = file.skins[index];
    if (!skin.inverseBindMatrices) {
        return std::vector<glm::dmat4>(skin.joints.size(), glm::dmat4(1.0));
    }
    const std::string use = "inverseBindMatrices of " + skinLabel(file, index);
    std::vector<glm::dmat4> matrices = readMatrices(file, *skin.inverseBindMatrices, use);
    if (matrices.size() < skin.joints.size()) {
        refuse(
            file, MessageId::Mismatch,
            {part::place(skinLabel(file, index)), " has ", part::value(std::to_string(matrices.size())), " inverseBindMatrices; expected ",
             part::expected("one for each of its " + std::to_string(skin.joints.size()) + " joints")});
    }
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
        const glm::dvec4 row = glm::transpose(matrices[i])[3];
        if (!(glm::length(row - glm::dvec4(0, 0, 0, 1)) <= kAffineRounding)) {
            refuse(file, MessageId::OutOfRange,
                   {part::place(use), " hold the last row ",
                    part::value(toText(row.x) + " " + toText(row.y) + " " + toText(row.z) + " " + toText(row.w)), " in element ",
                    std::to_string(i), "; expected ", part::expected("0 0 0 1")});
        }
    }
    return matrices;
}

std::size_t countSets(const GltfFile& file, const tinygltf::Primitive& primitive, const std::string& place)
{
    std::size_t sets = 0;
    for (;; ++sets) {
        const std::string joints = "JOINTS_" + std::to_string(sets), weights = "WEIGHTS_" + std::to_string(sets);
        const bool hasJoints = primitive.attributes.count(joints) > 0, hasWeights = primitive.attributes.count(weights) > 0;
        if (hasJoints != hasWeights) {
            refuse(file, MessageId::Requires,
                   {part::place(place), " has ", part::value(hasJoints ? joints : weights), " without ", (hasJoints ? weights : joints),
                    "; expected ", part::expected("both")});
        }
        if (!hasJoints) {
            break;
        }
    }
    if (sets == 0) {
        refuse(file, MessageId::Missing,
               {part::place(place), " has no ", part::value("JOINTS_0"), ", though a node gives it a skin; expected ",
                part::expected("joints and weights")});
    }
    return sets;
}

void checkInfluence(const GltfFile& file, const GltfSkin& skin, double joint, double weight, const std::string& where)
{
    if (!(weight >= 0.0 && std::isfinite(weight))) {
        refuse(
            file, MessageId::OutOfRange,
            {part::place(where), " has a joint of weight ", part::value(toText(weight)), "; expected ", part::expected("weights from 0")});
    }
    if (weight > 0.0 && !(joint >= 0.0 && joint < static_cast<double>(skin.joints.size()) && joint == std::floor(joint))) {
        refuse(file, MessageId::DanglingIndex,
               {part::place(where), " follows joint ", part::value(toText(joint)), "; expected ",
                part::expected("one below " + std::to_string(skin.joints.size()))});
    }
}

// Makes the weights of a vertex add up to 1. A vertex without any follows its first joint. Returns whether it had to.
bool normalizeWeights(Influences& influences, std::size_t vertex)
{
    const auto begin = influences.weights.begin() + static_cast<std::ptrdiff_t>(vertex * influences.perVertex);
    const auto end = begin + static_cast<std::ptrdiff_t>(influences.perVertex);
    double sum = 0.0;
    std::for_each(begin, end, [&sum](double weight) { sum += weight; });
    if (std::abs(sum - 1.0) <= kWeightRounding) {
        return false;
    }
    if (sum == 0.0) {
        *begin = sum = 1.0;
    }
    std::for_each(begin, end, [sum](double& weight) { weight /= sum; });
    return true;
}

Influences readInfluences(const GltfFile& file, const tinygltf::Primitive& primitive, const GltfSkin& skin, std::size_t vertexCount,
                          const std::string& place, Warnings& warnings)
{
    const std::size_t sets = countSets(file, primitive, place);
    Influences influences;
    influences.perVertex = 4 * sets;
    influences.joints.resize(vertexCount * influences.perVertex);
    influences.weights.resize(vertexCount * influences.perVertex);
    bool negative = false;
    for (std::size_t set = 0; set < sets; ++set) {
        const std::string number = std::to_string(set);
        const auto joints = readAttribute<glm::dvec4>(file, primitive.attributes, "JOINTS_" + number, "joints", vertexCount, place);
        auto weights = readAttribute<glm::dvec4>(file, primitive.attributes, "WEIGHTS_" + number, "weights", vertexCount, place);
        for (std::size_t i = 0; i < vertexCount; ++i) {
            for (int c = 0; c < 4; ++c) {
                if (weights[i][c] < 0.0 && weights[i][c] >= -kWeightRounding) {
                    weights[i][c] = 0.0;
                    negative = true;
                }
                checkInfluence(file, skin, joints[i][c], weights[i][c], "vertex " + std::to_string(i) + " of " + place);
                const std::size_t at = i * influences.perVertex + 4 * set + static_cast<std::size_t>(c);
                influences.joints[at] = weights[i][c] > 0.0 ? static_cast<std::uint32_t>(joints[i][c]) : 0U;
                influences.weights[at] = weights[i][c];
            }
        }
    }
    bool normalized = false;
    if (negative) {
        warnings.add(MessageId::WeightsClamped, "weights of joints just below 0 count as 0", place);
    }
    for (std::size_t i = 0; i < vertexCount; ++i) {
        normalized = normalizeWeights(influences, i) || normalized;
    }
    if (normalized) {
        warnings.add(MessageId::WeightsNormalized, "weights of joints that do not add up to 1 are normalised", place);
    }
    return influences;
}

// Those of weight 0 are not read. Some primitives of the mesh may lack the targets of others.
std::vector<MorphTarget> readMorphTargets(const GltfFile& file, const tinygltf::Mesh& mesh, std::size_t index,
                                          const std::vector<double>& weights, std::size_t vertexCount, const std::string& place,
                                          Warnings& warnings)
{
    const tinygltf::Primitive& primitive = mesh.primitives[index];
    const std::size_t count = primitive.targets.size();
    if (count != weights.size() && !(count < weights.size() && countMorphTargets(mesh) == weights.size())) {
        refuse(file, MessageId::Mismatch,
               {part::place(place), " has ", part::value(counted(count, "morph target")), " and ", counted(weights.size(), "weight"),
                "; expected ", part::expected("as many of both")});
    }
    if (count < weights.size()) {
        warnings.add(MessageId::MissingMorphTarget,
                     "primitives without morph targets stay as they are, though others of their mesh have some", place);
    }
    std::vector<MorphTarget> targets;
    for (std::size_t i = 0; i < count; ++i) {
        if (weights[i] == 0.0) {
            continue;
        }
        const std::string targetPlace = place + ".targets[" + std::to_string(i) + "]";
        const auto read = [&](const char* attribute, const char* plural) {
            return readAttribute<glm::dvec3>(file, primitive.targets[i], attribute, plural, vertexCount, targetPlace);
        };
        targets.push_back({weights[i], read("POSITION", "positions"), read("NORMAL", "normals"), read("TANGENT", "tangents")});
        for (const auto& [attribute, accessor] : primitive.targets[i]) {
            if (attribute != "POSITION" && attribute != "NORMAL" && attribute != "TANGENT") {
                warnings.add(MessageId::MorphAttributeIgnored, "morph targets move positions, normals and tangents only",
                             shortened(attribute) + " of " + targetPlace);
            }
        }
    }
    return targets;
}

}  // namespace

std::size_t countMorphTargets(const tinygltf::Mesh& mesh)
{
    std::size_t count = 0;
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
        count = std::max(count, primitive.targets.size());
    }
    return count;
}

std::vector<double> readMorphWeights(const GltfFile& file, std::size_t node)
{
    const tinygltf::Node& source = file.model.nodes[node];
    std::vector<double> weights = source.weights;
    if (weights.empty() && source.mesh >= 0) {
        weights = file.model.meshes[static_cast<std::size_t>(source.mesh)].weights;
    }
    return std::ranges::all_of(weights, [](double weight) { return weight == 0.0; }) ? std::vector<double>() : weights;
}

std::vector<glm::dmat4> placeJoints(const GltfFile& file, std::size_t skin)
{
    std::vector<glm::dmat4> matrices = readBindMatrices(file, skin);
    const std::vector<glm::dmat4> worldFromJoint = worldFromNodes(file, file.skins[skin].joints);
    for (std::size_t i = 0; i < worldFromJoint.size(); ++i) {
        matrices[i] = worldFromJoint[i] * matrices[i];
    }
    return matrices;
}

void poseMesh(const GltfFile& file, const tinygltf::Mesh& source, std::size_t primitive, const MeshPose& pose, const std::string& place,
              Mesh& mesh, Warnings& warnings)
{
    const std::size_t vertexCount = mesh.positions.size();
    if (!pose.weights.empty()) {
        morphMesh(mesh, readMorphTargets(file, source, primitive, pose.weights, vertexCount, place, warnings));
    }
    if (pose.skin) {
        const Influences influences =
            readInfluences(file, source.primitives[primitive], file.skins[*pose.skin], vertexCount, place, warnings);
        skinMesh(mesh, influences, pose.worldFromBind);
    }
}

}  // namespace glim
