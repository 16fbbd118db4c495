#include "host/flatten/build_scene_bvh.hpp"

#include "host/bvh/collapse_bvh.hpp"
#include "host/bvh/refit_bvh.hpp"
#include "host/flatten/place_instances.hpp"
#include "host/flatten/point_parts.hpp"
#include "host/flatten/split_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace glim {
namespace {

// The tree over pieces is used if its cost is below this fraction of the other's. Of 17 scenes, pieces make rays faster in only one,
// which has .85; the others have .96 and more, and at .96 shadow rays take 1.7 times as long (tests/bench/EXPERIMENTS.md).
constexpr double kWorthwhile = 0.9;

Box computeBox(const Triangle& t)
{
    return {glm::min(t.vertices[0], glm::min(t.vertices[1], t.vertices[2])),
            glm::max(t.vertices[0], glm::max(t.vertices[1], t.vertices[2]))};
}

std::vector<Box> boxesOf(std::span<const Triangle> triangles)
{
    std::vector<Box> boxes;
    boxes.reserve(triangles.size());
    for (const Triangle& triangle : triangles) {
        boxes.push_back(computeBox(triangle));
    }
    return boxes;
}

// By entry: the primitives that are in no part, then the parts.
std::vector<Box> boxesOf(const Primitives& primitives, const PointParts& points)
{
    if (points.empty()) {
        return primitiveBoxes(primitives);
    }
    const std::size_t triangles = primitives.triangles.size();
    std::vector<Box> boxes;
    for (const std::uint32_t id : points.others()) {
        boxes.push_back(id < triangles ? computeBox(primitives.triangles[id]) : computeBox(primitives.spheres[id - triangles]));
    }
    for (std::size_t part = 0; part < points.count(); ++part) {
        boxes.push_back(points.getBox(part));
    }
    return boxes;
}

// `makeBoxes`: of the triangles, then of other entries. Called again where it is needed again, so that no tree is built beside them.
template <class MakeBoxes>
WideBvh buildTree(const std::vector<Triangle>& triangles, SplitRule rule, const MakeBoxes& makeBoxes)
{
    WideBvh bvh = collapseBvh(buildBvh(makeBoxes(), rule));
    Pieces pieces = rule == SplitRule::Sah && !triangles.empty() ? splitTriangles(triangles, makeBoxes()) : Pieces{};
    if (pieces.boxes.empty()) {
        return bvh;
    }
    WideBvh ofPieces = collapseBvh(buildBvh(std::move(pieces.boxes), rule), {.single = pieces.primitives});
    if (!(ofPieces.cost < kWorthwhile * bvh.cost)) {
        return bvh;
    }
    ofPieces.box = bvh.box;  // without the pieces' margin
    return ofPieces;
}

// Trees that follow one another share the stack.
constexpr std::uint32_t kMaxDepthOfTwo = kMaxWideDepth / 2;

WideBvh buildMeshTree(const SharedMesh& mesh, SplitRule rule)
{
    WideBvh tree = buildTree(mesh.triangles, rule, [&] { return boxesOf(mesh.triangles); });
    return tree.depth <= kMaxDepthOfTwo ? tree : collapseBvh(buildBvh(boxesOf(mesh.triangles), SplitRule::Median));
}

// Where a ray enters an instance: at a node of the mesh's tree, for all that is below.
struct Entry {
    std::uint32_t placement;
    std::uint32_t node;
};

std::vector<Box> childBoxes(const WideNode& node)
{
    std::vector<Box> boxes;
    for (const WideChild& child : node.children) {
        if (child.kind != WideChild::Kind::Nothing) {
            boxes.push_back(child.box);
        }
    }
    return boxes;
}

glm::vec3 farthestOf(std::span<const Box> boxes)
{
    glm::vec3 farthest(0.0F);
    for (const Box& box : boxes) {
        farthest = glm::max(farthest, glm::max(glm::abs(box.lo), glm::abs(box.hi)));
    }
    return farthest;
}

// Adds those of instances. `roots`: of the shared meshes' trees.
std::vector<Box> withInstances(std::vector<Box> boxes, const Primitives& primitives, std::span<const WideNode> roots)
{
    const std::size_t firstInstance = boxes.size();
    for (const Placement& placement : primitives.placements) {
        boxes.push_back(placeBoxes(placement, childBoxes(roots[placement.sharedMesh])));
    }
    const glm::vec3 farthest = farthestOf(boxes);
    for (std::size_t i = 0; i < primitives.placements.size(); ++i) {
        const glm::vec3 error = boundRayError(primitives.placements[i], farthest);
        Box& box = boxes[firstInstance + i];
        box = {box.lo - error, box.hi + error};
    }
    return boxes;
}

// Over what is no triangle of a shared mesh. `roots`: of the shared meshes' trees.
WideBvh buildTopTree(const Primitives& primitives, const PointParts& points, std::span<const WideNode> roots, SplitRule rule)
{
    std::vector<Box> boxes = boxesOf(primitives, points);
    Entries entries;
    entries.firstInstance = static_cast<std::uint32_t>(boxes.size());
    if (!points.empty()) {
        entries.single = points.others();
        entries.firstTree = static_cast<std::uint32_t>(points.others().size());
        entries.makeTree = [&](std::uint32_t part) { return points.buildTree(part); };
        entries.inTrees = points.pointCount();
    }
    return collapseBvh(buildBvh(withInstances(std::move(boxes), primitives, roots), rule, std::thread::hardware_concurrency(), 1), entries);
}

bool areSame(const Triangle& a, const Triangle& b)
{
    return a.vertices[0] == b.vertices[0] && a.vertices[1] == b.vertices[1] && a.vertices[2] == b.vertices[2];
}

bool areSame(const PlacedSphere& a, const PlacedSphere& b) { return a.center == b.center && a.radius == b.radius && a.axis == b.axis; }

bool areSame(const Placement& a, const Placement& b)
{
    return a.sharedMesh == b.sharedMesh && a.linear == b.linear && a.translation == b.translation && a.motion == b.motion;
}

bool areSame(const SharedMesh& a, const SharedMesh& b);

template <class Range>
bool areAllSame(const Range& a, const Range& b)
{
    return &a == &b || std::ranges::equal(a, b, [](const auto& x, const auto& y) { return areSame(x, y); });
}

bool areSame(const SharedMesh& a, const SharedMesh& b) { return areAllSame(a.triangles, b.triangles); }

// Puts a mesh's tree behind the others. Its triangles have the ids from `firstId` on.
void append(WideBvh& bvh, const WideBvh& tree, std::uint32_t firstId)
{
    const auto firstNode = static_cast<std::uint32_t>(bvh.nodes.size()), firstEntry = static_cast<std::uint32_t>(bvh.order.size());
    bvh.meshTrees.push_back({tree.box, firstNode, firstEntry, static_cast<std::uint32_t>(tree.order.size()), tree.depth});
    for (WideNode node : tree.nodes) {
        for (WideChild& child : node.children) {
            child.first += child.kind == WideChild::Kind::Inner ? firstNode : child.kind == WideChild::Kind::Leaf ? firstEntry : 0;
        }
        bvh.nodes.push_back(node);
    }
    for (const std::uint32_t triangle : tree.order) {
        bvh.order.push_back(firstId + triangle);
    }
}

// The tree that `append` has put there, but for its cost.
WideBvh extract(const WideBvh& bvh, std::size_t mesh, std::uint32_t firstId)
{
    const MeshTree& place = bvh.meshTrees[mesh];
    const std::size_t endNode = mesh + 1 < bvh.meshTrees.size() ? bvh.meshTrees[mesh + 1].firstNode : bvh.nodes.size();
    WideBvh tree;
    tree.box = place.box;
    tree.depth = place.depth;
    for (WideNode node : std::span(bvh.nodes).subspan(place.firstNode, endNode - place.firstNode)) {
        for (WideChild& child : node.children) {
            child.first -= child.kind == WideChild::Kind::Inner  ? place.firstNode
                           : child.kind == WideChild::Kind::Leaf ? place.firstEntry
                                                                 : 0;
        }
        tree.nodes.push_back(node);
    }
    for (const std::uint32_t triangle : std::span(bvh.order).subspan(place.firstEntry, place.entryCount)) {
        tree.order.push_back(triangle - firstId);
    }
    return tree;
}

// A root without children.
WideBvh makeEmptyTree()
{
    WideBvh tree;
    tree.box = {glm::vec3(0.0F), glm::vec3(0.0F)};
    tree.nodes.resize(1);
    tree.depth = 1;
    return tree;
}

WideBvh buildTwoLevels(const Primitives& primitives, SplitRule rule, const WideBvh& previous, const Primitives& before)
{
    std::vector<WideBvh> trees;
    trees.reserve(primitives.sharedMeshes.size());
    std::vector<WideNode> roots;
    std::uint32_t depth = 0;
    for (std::size_t i = 0; i < primitives.sharedMeshes.size(); ++i) {
        const SharedMesh& mesh = primitives.sharedMeshes[i];
        const bool same = i < previous.meshTrees.size() && areSame(mesh, before.sharedMeshes[i]);
        trees.push_back(same                     ? extract(previous, i, before.sharedMeshes[i].firstId)
                        : mesh.triangles.empty() ? WideBvh{}
                                                 : buildMeshTree(mesh, rule));
        roots.push_back(trees.back().nodes.empty() ? WideNode{} : trees.back().nodes[0]);
        depth = std::max(depth, trees.back().depth);
    }
    WideBvh bvh = buildTopTree(primitives, PointParts(primitives, rule), roots, rule);
    if (bvh.depth > kMaxDepthOfTwo) {
        bvh = buildTopTree(primitives, PointParts(primitives, SplitRule::Median), roots, SplitRule::Median);
    }
    bvh.depth += depth;
    for (std::size_t i = 0; i < trees.size(); ++i) {
        append(bvh, trees[i], primitives.sharedMeshes[i].firstId);
    }
    for (InstanceNode& node : bvh.instances) {
        node.root = bvh.meshTrees[primitives.placements[node.instance].sharedMesh].firstNode;
    }
    return bvh;
}

bool haveSameSurfaces(const Primitives& a, const Primitives& b)
{
    return areAllSame(a.triangles, b.triangles) && areAllSame(a.spheres.all(), b.spheres.all()) &&
           areAllSame(a.sharedMeshes, b.sharedMeshes) && areAllSame(a.placements, b.placements);
}

// Whether a tree over `before` is one over the primitives once it is refitted: it is not over pieces, and only what is flattened and where
// instances are may differ.
bool canRefit(const WideBvh& bvh, const Primitives& before, const Primitives& primitives)
{
    const std::size_t entries = bvh.meshTrees.empty() ? bvh.order.size() : bvh.meshTrees.front().firstEntry;
    const auto sameMesh = [](const Placement& a, const Placement& b) { return a.sharedMesh == b.sharedMesh; };
    return entries == primitives.count() && before.triangles.size() == primitives.triangles.size() &&
           before.spheres.size() == primitives.spheres.size() && areAllSame(before.sharedMeshes, primitives.sharedMeshes) &&
           std::equal(before.placements.begin(), before.placements.end(), primitives.placements.begin(), primitives.placements.end(),
                      sameMesh);
}

std::vector<WideNode> rootsOf(const WideBvh& bvh)
{
    std::vector<WideNode> roots;
    for (const MeshTree& tree : bvh.meshTrees) {
        roots.push_back(tree.entryCount == 0 ? WideNode{} : bvh.nodes[tree.firstNode]);
    }
    return roots;
}

WideBvh refitOrBuild(WideBvh previous, const Primitives& before, const Primitives& primitives, SplitRule rule)
{
    if (canRefit(previous, before, primitives)) {
        if (auto refitted =
                refitBvh(previous, withInstances(primitiveBoxes(primitives), primitives, rootsOf(previous)), 1.0 / kWorthwhile)) {
            return *std::move(refitted);
        }
    }
    return primitives.placements.empty() ? buildSceneBvh(primitives, rule) : buildTwoLevels(primitives, rule, previous, before);
}

}  // namespace

std::vector<Box> primitiveBoxes(const Primitives& primitives)
{
    std::vector<Box> boxes = boxesOf(primitives.triangles);
    boxes.reserve(primitives.count());
    for (const PlacedSphere& sphere : primitives.spheres.all()) {
        boxes.push_back(computeBox(sphere));
    }
    return boxes;
}

WideBvh buildSceneBvh(const Primitives& primitives, SplitRule rule)
{
    if (primitives.count() == 0 && primitives.placements.empty()) {
        return makeEmptyTree();  // of a scene that is transparent all over
    }
    if (!primitives.placements.empty()) {
        return buildTwoLevels(primitives, rule, {}, {});
    }
    if (const PointParts points(primitives, rule); !points.empty()) {
        return buildTopTree(primitives, points, {}, rule);
    }
    return buildTree(primitives.triangles, rule, [&] { return primitiveBoxes(primitives); });
}

WideBvh updateSceneBvh(WideBvh previous, const Primitives& before, const Primitives& primitives, SplitRule rule)
{
    if (haveSameSurfaces(before, primitives)) {
        return previous;
    }
    return refitOrBuild(std::move(previous), before, primitives, rule);
}

WideBvh moveInstances(WideBvh previous, const Primitives& primitives, SplitRule rule)
{
    return refitOrBuild(std::move(previous), primitives, primitives, rule);
}

}  // namespace glim
