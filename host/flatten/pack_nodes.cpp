// Ylitie, Karras, Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1.
#include "host/flatten/pack_nodes.hpp"

#include "host/bvh/parallel_for.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <thread>

namespace glim {
namespace {

static_assert(kBvhWidth == 8 && kMaxLeafRefs == 3, "what fits into a word of hits");

constexpr double kMaxSteps = 255.0;

// Grows every box by at least one ulp and 2^-30 of the scene. Even for the smallest direction component that intersect_node.glsl has, a
// face that would pass through the ray's origin is then hit at |t| >= 1e9 scene sizes. Rounding in double is far below that.
Box thicken(const Box& box, float pad) { return roundOutwards({box.lo - pad, box.hi + pad}); }

Box computeNodeBox(const WideNode& node, float pad)
{
    Box bounds = kEmptyBox;
    for (const WideChild& child : node.children) {
        if (child.kind != WideChild::Kind::Nothing) {
            bounds = unite(bounds, thicken(child.box, pad));
        }
    }
    return bounds;
}

float padOf(const Box& root)
{
    const glm::vec3 farthest = glm::max(glm::abs(root.lo), glm::abs(root.hi));
    return std::ldexp(std::max({farthest.x, farthest.y, farthest.z, std::numeric_limits<float>::min()}), -30);
}

// The biased float exponent of the smallest power of two such that kMaxSteps of them cover the extent.
std::uint32_t biasedExponent(double extent)
{
    int exponent = 0;
    const double mantissa = std::frexp(extent / kMaxSteps, &exponent);  // in [1/2, 1)
    return static_cast<std::uint32_t>(std::clamp(mantissa == 0.5 ? exponent - 1 : exponent, -126, 127) + 127);
}

// The planes of one axis: a byte for each child, four children in a word.
struct Planes {
    std::array<std::uint32_t, 2> lo{}, hi{};
};

Planes packPlanes(const WideNode& node, float pad, int axis, float from, std::uint32_t exponent)
{
    const double step = std::ldexp(1.0, static_cast<int>(exponent) - 127);
    Planes planes;
    for (std::uint32_t i = 0; i < kBvhWidth; ++i) {
        if (node.children[i].kind == WideChild::Kind::Nothing) {
            continue;
        }
        const Box box = thicken(node.children[i].box, pad);
        const double lo = std::floor((static_cast<double>(box.lo[axis]) - static_cast<double>(from)) / step);
        const double hi = std::ceil((static_cast<double>(box.hi[axis]) - static_cast<double>(from)) / step);
        planes.lo[i / 4] |= static_cast<std::uint32_t>(std::clamp(lo, 0.0, kMaxSteps)) << i % 4 * 8;
        planes.hi[i / 4] |= static_cast<std::uint32_t>(std::clamp(hi, 0.0, kMaxSteps)) << i % 4 * 8;
    }
    return planes;
}

// A node's children, without their boxes.
struct Content {
    std::uint32_t firstNode = 0, firstRef = 0;
    std::uint32_t inner = 0;                 // bit i: child i is a node
    std::array<std::uint32_t, 2> entries{};  // a byte for each child
};

Content contentOf(const WideNode& node)
{
    Content content;
    std::uint32_t refs = 0;
    for (std::uint32_t i = 0; i < kBvhWidth; ++i) {
        const WideChild& child = node.children[i];
        std::uint32_t entry = 0;
        if (child.kind == WideChild::Kind::Inner) {
            content.firstNode = content.inner == 0 ? child.first : content.firstNode;
            content.inner |= 1U << i;
            entry = 1U << 5 | (kFirstNodeBit + i);
        } else if (child.kind == WideChild::Kind::Leaf) {
            content.firstRef = refs == 0 ? child.first : content.firstRef;
            entry = ((1U << child.count) - 1) << 5 | refs;
            refs += child.count;
        }
        content.entries[i / 4] |= entry << i % 4 * 8;
    }
    return content;
}

std::array<uvec4, kNodeTexels> pack(const WideNode& node, float pad)
{
    const Content content = contentOf(node);
    if ((content.entries[0] | content.entries[1]) == 0) {
        return {};  // an instance, which flatten_scene.cpp fills in
    }
    const Box bounds = computeNodeBox(node, pad);
    std::array<Planes, 3> planes;
    std::uint32_t exponents = content.inner << 24;
    for (int axis = 0; axis < 3; ++axis) {
        const std::uint32_t exponent = biasedExponent(static_cast<double>(bounds.hi[axis]) - static_cast<double>(bounds.lo[axis]));
        planes[axis] = packPlanes(node, pad, axis, bounds.lo[axis], exponent);
        exponents |= exponent << axis * 8;
    }
    return {{{std::bit_cast<std::uint32_t>(bounds.lo.x), std::bit_cast<std::uint32_t>(bounds.lo.y),
              std::bit_cast<std::uint32_t>(bounds.lo.z), exponents},
             {content.firstNode, content.firstRef, content.entries[0], content.entries[1]},
             {planes[0].lo[0], planes[0].lo[1], planes[1].lo[0], planes[1].lo[1]},
             {planes[2].lo[0], planes[2].lo[1], planes[0].hi[0], planes[0].hi[1]},
             {planes[1].hi[0], planes[1].hi[1], planes[2].hi[0], planes[2].hi[1]}}};
}

}  // namespace

std::vector<uvec4> packNodes(const WideBvh& bvh)
{
    constexpr std::size_t kBlock = 1024;
    std::vector<uvec4> texels(bvh.nodes.size() * kNodeTexels);
    const auto packTree = [&](const Box& box, std::size_t begin, std::size_t end) {
        const float pad = padOf(box);
        parallelFor((end - begin + kBlock - 1) / kBlock, std::thread::hardware_concurrency(), [&](std::size_t block) {
            const std::size_t first = begin + block * kBlock;
            for (std::size_t i = first; i < std::min(first + kBlock, end); ++i) {
                std::ranges::copy(pack(bvh.nodes[i], pad), texels.begin() + static_cast<std::ptrdiff_t>(i * kNodeTexels));
            }
        });
    };
    packTree(bvh.box, 0, bvh.meshTrees.empty() ? bvh.nodes.size() : bvh.meshTrees[0].firstNode);
    for (std::size_t i = 0; i < bvh.meshTrees.size(); ++i) {
        packTree(bvh.meshTrees[i].box, bvh.meshTrees[i].firstNode,
                 i + 1 < bvh.meshTrees.size() ? bvh.meshTrees[i + 1].firstNode : bvh.nodes.size());
    }
    return texels;
}

}  // namespace glim
