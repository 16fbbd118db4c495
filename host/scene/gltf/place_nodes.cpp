#include "host/scene/gltf/place_nodes.hpp"

#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <map>

namespace glim {
namespace {

constexpr int kNoParent = -1;

// A matrix counts as singular if its determinant is below this fraction of that of orthogonal columns of the same lengths.
constexpr double kSingular = 1e-12;

std::vector<int> findParents(const GltfFile& file)
{
    const std::vector<tinygltf::Node>& nodes = file.model.nodes;
    std::vector<int> parents(nodes.size(), kNoParent);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) {
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent != kNoParent) {
                refuse(file, MessageId::Duplicate,
                       {part::place(nodeLabel(file, static_cast<std::size_t>(child))),
                        " is a child of nodes[" + std::to_string(parent) + "] and of ", part::value("nodes[" + std::to_string(i) + "]"),
                        "; expected ", part::expected("one parent")});
            }
            parent = static_cast<int>(i);
        }
    }
    return parents;
}

// Each node has one parent at most, so walking upwards finds every cycle.
void checkAcyclic(const GltfFile& file, const std::vector<int>& parents)
{
    std::vector<int> walkThatMet(parents.size(), kNoParent);
    for (std::size_t start = 0; start < parents.size(); ++start) {
        const auto walk = static_cast<int>(start);
        int at = walk;
        while (at != kNoParent && walkThatMet[static_cast<std::size_t>(at)] == kNoParent) {
            walkThatMet[static_cast<std::size_t>(at)] = walk;
            at = parents[static_cast<std::size_t>(at)];
        }
        if (at != kNoParent && walkThatMet[static_cast<std::size_t>(at)] == walk) {
            refuse(file, MessageId::Cycle,
                   {part::place(nodeLabel(file, static_cast<std::size_t>(at))), " is its own ancestor; expected ",
                    part::expected("a hierarchy without cycles")});
        }
    }
}

std::vector<int> findRoots(const GltfFile& file, const LoadOptions& options, const std::vector<int>& parents, Warnings& warnings)
{
    const std::vector<tinygltf::Scene>& scenes = file.model.scenes;
    if (options.scene && *options.scene >= scenes.size()) {
        refuse(file, MessageId::DanglingIndex,
               {part::place("scene"), " ", part::value(std::to_string(*options.scene)), " was asked for; expected ",
                part::expected("one below " + std::to_string(scenes.size()))});
    }
    if (!scenes.empty()) {
        const std::size_t first = file.model.defaultScene < 0 ? 0 : static_cast<std::size_t>(file.model.defaultScene);
        return scenes[options.scene.value_or(first)].nodes;
    }
    std::vector<int> roots;
    for (std::size_t i = 0; i < parents.size(); ++i) {
        if (parents[i] == kNoParent) {
            roots.push_back(static_cast<int>(i));
        }
    }
    warnings.add(MessageId::NoScene, "the file has no scene: all its nodes are drawn");
    return roots;
}

// A root may hang below a node that the scene does not draw: some exporters put all their roots below a node of no scene.
void noteParentsOfRoots(const GltfFile& file, const std::vector<int>& roots, const std::vector<int>& parents, Warnings& warnings)
{
    for (const int root : roots) {
        const auto index = static_cast<std::size_t>(root);
        if (parents[index] != kNoParent) {
            warnings.add(MessageId::ParentTransformIgnored,
                         "roots of the scene are drawn without the transforms of their parents, which the scene does not hold",
                         nodeLabel(file, index));
        }
    }
}

glm::dmat3 readRotation(const GltfFile& file, std::size_t index)
{
    const tinygltf::Node& node = file.model.nodes[index];
    if (node.rotation.empty()) {
        return glm::dmat3(1.0);
    }
    const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(rotation) > 0.0)) {
        refuse(file, MessageId::Degenerate,
               {part::place(nodeLabel(file, index) + ".rotation"), " is ", part::value("0"), "; expected ",
                part::expected("a unit quaternion")});
    }
    return glm::mat3_cast(glm::normalize(rotation));
}

glm::dmat4 parentFromNode(const GltfFile& file, std::size_t index)
{
    const tinygltf::Node& node = file.model.nodes[index];
    if (!node.matrix.empty()) {
        return readMatrix(file, index, node.matrix);
    }
    glm::dmat4 matrix(readRotation(file, index));
    for (int c = 0; c < 3; ++c) {
        matrix[c] *= node.scale.empty() ? 1.0 : node.scale[static_cast<std::size_t>(c)];
        matrix[3][c] = node.translation.empty() ? 0.0 : node.translation[static_cast<std::size_t>(c)];
    }
    return matrix;
}

double computeSpan(const glm::dmat3& linear) { return glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]); }

bool isInvertible(const glm::dmat3& linear) { return std::abs(glm::determinant(linear)) > kSingular * computeSpan(linear); }

// Of a matrix that flattens no axes are known.
glm::dmat3 parentFromAxes(const GltfFile& file, std::size_t index, const glm::dmat3& parentFromNode)
{
    if (isInvertible(parentFromNode)) {
        return parentFromNode;
    }
    return file.model.nodes[index].matrix.empty() ? readRotation(file, index) : glm::dmat3(1.0);
}

glm::dmat3 requireInvertible(const GltfFile& file, std::size_t node, const glm::dmat3& linear)
{
    if (!isInvertible(linear)) {
        refuse(file, MessageId::Degenerate,
               {part::place(nodeLabel(file, node)), " has a singular transform (determinant ",
                part::value(toText(glm::determinant(linear))), "); expected ", part::expected("one that can be inverted")});
    }
    return linear;
}

bool isVisible(const GltfFile& file, std::size_t index)
{
    const auto extension = file.model.nodes[index].extensions.find("KHR_node_visibility");
    const bool known = extension != file.model.nodes[index].extensions.end() && extension->second.Has("visible");
    return !known || extension->second.Get("visible").Get<bool>();
}

}  // namespace

glm::dmat4 readMatrix(const GltfFile& file, std::size_t node, const std::vector<double>& values)
{
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) {
        matrix[i / 4][i % 4] = values[static_cast<std::size_t>(i)];
    }
    if (values[3] != 0.0 || values[7] != 0.0 || values[11] != 0.0 || values[15] != 1.0) {
        refuse(file, MessageId::OutOfRange,
               {part::place(nodeLabel(file, node) + ".matrix"), " has the last row ",
                part::value(toText(values[3]) + " " + toText(values[7]) + " " + toText(values[11]) + " " + toText(values[15])),
                "; expected ", part::expected("0 0 0 1")});
    }
    return matrix;
}

std::vector<PlacedNode> placeNodes(const GltfFile& file, const LoadOptions& options, Warnings& warnings)
{
    const std::vector<int> parents = findParents(file);
    checkAcyclic(file, parents);
    const std::vector<int> roots = findRoots(file, options, parents, warnings);
    noteParentsOfRoots(file, roots, parents, warnings);

    std::vector<PlacedNode> placed, pending;  // no recursion: hierarchies may be deeper than the call stack
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) {
        pending.push_back({static_cast<std::size_t>(*root), glm::dmat4(1.0)});
    }
    std::vector<bool> met(parents.size(), false);
    while (!pending.empty()) {
        PlacedNode node = pending.back();
        pending.pop_back();
        if (met[node.index]) {
            refuse(file, MessageId::Duplicate,
                   {part::place(nodeLabel(file, node.index)), " is met twice in its scene, as a root or below one; expected ",
                    part::expected("it once")});
        }
        met[node.index] = true;
        if (node.visible && !isVisible(file, node.index)) {
            warnings.add(MessageId::InvisibleNode, "invisible nodes are left out", nodeLabel(file, node.index));
            node.visible = false;  // and so is what hangs below it
        }
        const glm::dmat4 own = parentFromNode(file, node.index);
        node.worldFromNode = node.worldFromNode * own;
        node.worldFromAxes = node.worldFromAxes * parentFromAxes(file, node.index, glm::dmat3(own));
        placed.push_back(node);
        const std::vector<int>& children = file.model.nodes[node.index].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            pending.push_back({static_cast<std::size_t>(*child), node.worldFromNode, node.worldFromAxes, node.visible});
        }
    }
    return placed;
}

std::vector<glm::dmat4> worldFromNodes(const GltfFile& file, const std::vector<std::size_t>& nodes)
{
    const std::vector<int> parents = findParents(file);
    std::map<int, glm::dmat4> worlds{{kNoParent, glm::dmat4(1.0)}};
    std::vector<glm::dmat4> result;
    for (const std::size_t node : nodes) {
        std::vector<int> chain;
        for (auto at = static_cast<int>(node); worlds.count(at) == 0; at = parents[static_cast<std::size_t>(at)]) {
            chain.push_back(at);
        }
        for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
            const auto index = static_cast<std::size_t>(*at);
            worlds[*at] = worlds[parents[index]] * parentFromNode(file, index);
        }
        result.push_back(worlds[static_cast<int>(node)]);
    }
    return result;
}

bool isFlattening(const PlacedNode& node)
{
    const glm::dmat3 linear(node.worldFromNode);
    return std::isfinite(computeSpan(linear)) && !isInvertible(linear);
}

glm::dmat3 readLinear(const GltfFile& file, const PlacedNode& node)
{
    return requireInvertible(file, node.index, glm::dmat3(node.worldFromNode));
}

glm::dmat3 readAxes(const GltfFile& file, const PlacedNode& node)
{
    return isFlattening(node) ? requireInvertible(file, node.index, node.worldFromAxes) : readLinear(file, node);
}

}  // namespace glim
