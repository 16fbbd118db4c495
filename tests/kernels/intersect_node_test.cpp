#include "host/bvh/build_bvh.hpp"
#include "host/bvh/collapse_bvh.hpp"
#include "host/flatten/pack_nodes.hpp"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iostream>
#include <limits>
#include <optional>

namespace glim::intersect_node_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Case {
    std::array<uvec4, kNodeTexels> texels;
    vec3 origin, direction;
    float tmax;
    std::uint32_t nudges, mustHit, mustMiss, octant;
};

struct Tree {
    WideBvh wide;
    std::vector<uvec4> texels;
};

// The tree of triangles, most of which lie in a plane of two axes, so that their boxes are flat.
Tree treeOf(Random& random, double scale, double shift)
{
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const glm::dvec3 center = scale * (shift + 3.0 * random.normalVector());
        std::array<vec3, 3> vertices;
        for (vec3& v : vertices) {
            v = center + scale * random.normalVector();
        }
        if (i % 4 < 3) {
            const int axis = static_cast<int>(i % 4);
            vertices[1][axis] = vertices[2][axis] = vertices[0][axis];
        }
        boxes.push_back(
            {glm::min(vertices[0], glm::min(vertices[1], vertices[2])), glm::max(vertices[0], glm::max(vertices[1], vertices[2]))});
    }
    Tree tree{collapseBvh(buildBvh(boxes)), {}};
    tree.texels = packNodes(tree.wide);
    return tree;
}

// Where the ray enters the box grown by `pad`, in double from the float inputs.
std::optional<double> enterBox(const Box& box, const Case& c, const glm::dvec3& pad)
{
    double near = 0.0, far = kInfinity;
    for (int k = 0; k < 3; ++k) {
        const double lo = static_cast<double>(box.lo[k]) - pad[k] - static_cast<double>(c.origin[k]);
        const double hi = static_cast<double>(box.hi[k]) + pad[k] - static_cast<double>(c.origin[k]);
        const double d = static_cast<double>(c.direction[k]);
        if (d == 0.0) {
            far = lo <= 0.0 && hi >= 0.0 ? far : -1.0;
            continue;
        }
        near = std::max(near, std::min(lo / d, hi / d));
        far = std::min(far, std::max(lo / d, hi / d));
    }
    return near <= far ? std::optional(near) : std::nullopt;
}

// H4: zeros of either sign in one or two components, and components below kSmallestDirection.
vec3 hardDirection(Random& random)
{
    vec3 d = random.direction();
    const std::uint32_t kind = random.below(4), axis = random.below(3);
    if (kind == 1 || kind == 2) {
        d[axis] = random.below(2) == 0 ? 0.0F : -0.0F;
    }
    if (kind == 2) {
        d[(axis + 1) % 3] = random.below(2) == 0 ? 0.0F : -0.0F;
        d[(axis + 2) % 3] = random.below(2) == 0 ? 1.0F : -1.0F;
    }
    if (kind == 3) {
        d[axis] = static_cast<float>(std::copysign(random.logUniform(1e-30, 1e-4), random.uniform(-1.0, 1.0)));
    }
    return d;
}

// The slab test with GLSL's min and max as specified (y < x ? y : x and x < y ? y : x), infinite reciprocals and no padding.
bool naiveHit(const Box& box, const Case& c)
{
    float near = 0.0F, far = c.tmax;
    for (int k = 0; k < 3; ++k) {
        const float inverse = 1.0F / c.direction[k];
        const float lo = (box.lo[k] - c.origin[k]) * inverse, hi = (box.hi[k] - c.origin[k]) * inverse;
        const float first = hi < lo ? hi : lo, last = lo < hi ? hi : lo;
        near = near < first ? first : near;
        far = last < far ? last : far;
    }
    return near <= far;
}

// Counts of rays that meet the box that the triangles need: [0] without a zero among the direction's components, [1] with one.
struct NaiveMisses {
    std::size_t rays[2], misses[2];
};

void countNaive(NaiveMisses& naive, const Box& box, const Case& c)
{
    const int kind = c.direction.x == 0.0F || c.direction.y == 0.0F || c.direction.z == 0.0F ? 1 : 0;
    ++naive.rays[kind];
    naive.misses[kind] += naiveHit(box, c) ? 0 : 1;
}

// The bits that a child has in a word of hits.
std::uint32_t bitsOf(const WideNode& node, std::uint32_t place, std::uint32_t octant)
{
    const WideChild& child = node.children[place];
    if (child.kind == WideChild::Kind::Inner) {
        return 1U << (kFirstNodeBit + (place ^ octant));
    }
    std::uint32_t before = 0;
    for (std::uint32_t i = 0; i < place; ++i) {
        before += node.children[i].kind == WideChild::Kind::Leaf ? node.children[i].count : 0;
    }
    return child.kind == WideChild::Kind::Leaf ? ((1U << child.count) - 1) << before : 0;
}

// One step of each axis, and what rounding may add.
glm::dvec3 padOf(const Case& c, const Box& box)
{
    const glm::vec3 reach = glm::abs(c.origin) + glm::abs(box.lo) + glm::abs(box.hi);
    glm::dvec3 pad(1e-5 * static_cast<double>(std::max({reach.x, reach.y, reach.z})));
    for (int k = 0; k < 3; ++k) {
        pad[k] += std::ldexp(1.0, static_cast<int>(c.texels[0].w >> 8 * k & 255U) - 127);
    }
    return pad;
}

void judge(Case& c, const WideNode& node)
{
    std::uint32_t all = 0;
    for (std::uint32_t i = 0; i < kBvhWidth; ++i) {
        const WideChild& child = node.children[i];
        const std::uint32_t bits = bitsOf(node, i, c.octant);
        all |= bits;
        if (bits != 0) {
            const auto needed = enterBox(child.box, c, glm::dvec3(0.0)), grown = enterBox(child.box, c, padOf(c, child.box));
            c.mustHit |= needed && *needed <= static_cast<double>(c.tmax) ? bits : 0;
            c.mustMiss |= !grown || *grown > 1.00001 * static_cast<double>(c.tmax) ? bits : 0;
        }
    }
    c.mustMiss |= ~all;
}

// H5: a ray at a corner, edge, face or inner point of a child's box; or, one in eight, past it.
Case rayAt(const Tree& tree, Random& random, double scale, NaiveMisses& naive)
{
    const std::uint32_t index = random.below(static_cast<std::uint32_t>(tree.wide.nodes.size()));
    const WideNode& node = tree.wide.nodes[index];
    Case c{{}, {}, hardDirection(random), 0.0F, random.below(125), 0, 0, 0};
    std::copy_n(tree.texels.begin() + index * kNodeTexels, kNodeTexels, c.texels.begin());
    std::uint32_t place = random.below(kBvhWidth);
    while (node.children[place].kind == WideChild::Kind::Nothing) {
        place = (place + 1) % kBvhWidth;
    }
    const Box& box = node.children[place].box;
    glm::dvec3 target;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t where = random.below(3);
        const double lo = static_cast<double>(box.lo[k]), hi = static_cast<double>(box.hi[k]);
        target[k] = where == 0 ? lo : where == 1 ? hi : static_cast<double>(static_cast<float>(glm::mix(lo, hi, random.uniform())));
        c.octant |= std::signbit(c.direction[k]) ? 0U : 1U << k;
    }
    if (random.below(8) == 0) {
        target += scale * random.logUniform(1e-6, 1.0) * random.normalVector();
    }
    const double distance = random.below(8) == 0 ? 0.0 : scale * random.logUniform(1e-3, 1e3);
    c.origin = target - distance * glm::dvec3(c.direction);
    c.tmax = std::numeric_limits<float>::infinity();
    const std::optional<double> needed = enterBox(box, c, glm::dvec3(0.0));
    if (needed && random.below(2) == 0) {
        c.tmax = std::nextafter(static_cast<float>(*needed), std::numeric_limits<float>::infinity());  // a hit just there
    } else if (random.below(8) == 0) {
        c.tmax = static_cast<float>(0.99 * distance);
    }
    judge(c, node);
    if ((c.mustHit & bitsOf(node, place, c.octant)) != 0) {
        countNaive(naive, box, c);
    }
    return c;
}

TEST(IntersectNodeTest, H4H5IsConservative)
{
    constexpr std::size_t kRays = 334000;
    NaiveMisses naive{};
    for (int round = 0; round < hardRounds(6 * kRays); ++round) {
        for (const double scale : {1e-4, 1.0, 1e5}) {
            for (const double shift : {0.0, 1e3}) {
                Random random(static_cast<std::uint64_t>(round) * 17 + 4);
                const Tree tree = treeOf(random, scale, shift);
                std::vector<Case> cases(kRays);
                std::size_t hits = 0, misses = 0;
                for (Case& c : cases) {
                    c = rayAt(tree, random, scale, naive);
                    hits += static_cast<std::size_t>(std::popcount(c.mustHit));
                    misses += static_cast<std::size_t>(std::popcount(c.mustMiss));
                }
                std::cout << "  scale " << scale << " shift " << shift << ": " << tree.wide.nodes.size() << " nodes, " << hits
                          << " bits that must be set, " << misses << " that must not\n";
                EXPECT_GT(hits, kRays / 2);
                EXPECT_GT(misses, kRays);
                KernelTest(test_kernels::intersect_node_test).cases(cases).run();
            }
        }
    }
    const char* names[] = {"corners, edges and flat boxes", "zero direction components"};
    for (const int kind : {0, 1}) {
        printHardCase(kind == 0 ? "H5" : "H4", names[kind], static_cast<double>(naive.rays[kind]), "misses 0",
                      "min and max without padding: " + std::to_string(naive.misses[kind]) + " missed");
        EXPECT_GT(naive.misses[kind], naive.rays[kind] / 1000);
    }
}

}  // namespace glim::intersect_node_test
