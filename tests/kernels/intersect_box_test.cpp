#include "host/bvh/build_bvh.hpp"
#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iostream>
#include <limits>
#include <optional>

namespace glim {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

enum Verdict : std::uint32_t { Miss = 0, Hit = 1, Either = 2 };

struct Case {
    vec3 lo, hi, origin, direction;
    float tmax;
    std::uint32_t verdict, nudges;
    float enter, tolerance;
};

// A leaf's box as kernels see it, and as its triangles need it.
struct Leaf {
    Box stored, needed;
};

vec3 floatsOf(const uvec4& texel)
{
    return {std::bit_cast<float>(texel.x), std::bit_cast<float>(texel.y), std::bit_cast<float>(texel.z)};
}

Leaf leafOf(const FlatScene& flat, const Box& stored, std::uint32_t first, std::uint32_t count)
{
    const float infinity = std::numeric_limits<float>::infinity();
    Leaf leaf{stored, {vec3(infinity), vec3(-infinity)}};
    for (std::uint32_t i = first * kRecordTexels; i < (first + count) * kRecordTexels; ++i) {
        leaf.needed.lo = glm::min(leaf.needed.lo, floatsOf(flat.records[i]));
        leaf.needed.hi = glm::max(leaf.needed.hi, floatsOf(flat.records[i]));
    }
    return leaf;
}

// Every leaf of a scene of triangles, most of which lie in a plane of two axes, so that their boxes were flat.
std::vector<Leaf> leavesOfScene(Random& random, double scale, double shift)
{
    Scene scene;
    scene.materials.resize(1);
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const glm::dvec3 center = scale * (shift + 3.0 * random.normalVector());
        Triangle triangle{};
        for (vec3& v : triangle.vertices) {
            v = center + scale * random.normalVector();
        }
        if (i % 4 < 3) {
            const int axis = static_cast<int>(i % 4);
            triangle.vertices[1][axis] = triangle.vertices[2][axis] = triangle.vertices[0][axis];
        }
        scene.triangles.push_back(triangle);
    }
    scene.primitives.push_back({"all", 0, 3000, 0, false});
    const FlatScene flat = flattenScene(scene, buildBvh(primitiveBoxes(scene)));
    std::vector<Leaf> leaves;
    for (std::size_t i = 0; i < flat.nodes.size(); i += kNodeTexels) {
        const uvec4* node = &flat.nodes[i];
        for (int child = 0; child < 2; ++child) {
            const std::uint32_t first = node[child].w, count = node[2 + child].w;
            if (count != 0 && count != kEmptyLeaf) {
                leaves.push_back(leafOf(flat, {floatsOf(node[2 * child]), floatsOf(node[2 * child + 1])}, first, count));
            }
        }
    }
    return leaves;
}

// Where the ray enters the box grown by `pad`, in double from the float inputs.
std::optional<double> enterBox(const Box& box, const Case& c, double pad)
{
    double near = 0.0, far = kInfinity;
    for (int k = 0; k < 3; ++k) {
        const double lo = static_cast<double>(box.lo[k]) - pad - static_cast<double>(c.origin[k]);
        const double hi = static_cast<double>(box.hi[k]) + pad - static_cast<double>(c.origin[k]);
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

// Of rays that meet the box that the triangles need; without and with a zero among the direction's components.
struct NaiveMisses {
    std::size_t rays[2], misses[2];
};

void countNaive(NaiveMisses& naive, const Box& box, const Case& c)
{
    const int kind = c.direction.x == 0.0F || c.direction.y == 0.0F || c.direction.z == 0.0F ? 1 : 0;
    ++naive.rays[kind];
    naive.misses[kind] += naiveHit(box, c) ? 0 : 1;
}

// H5: a ray at a corner, edge, face or inner point of the box that the triangles need; or, one in eight, past it.
Case rayAt(const Leaf& leaf, Random& random, double scale, NaiveMisses& naive)
{
    Case c{leaf.stored.lo, leaf.stored.hi, {}, hardDirection(random), 0.0F, Either, random.below(125), 0.0F, 0.0F};
    glm::dvec3 target;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t place = random.below(3);
        const double lo = static_cast<double>(leaf.needed.lo[k]), hi = static_cast<double>(leaf.needed.hi[k]);
        const float inner = static_cast<float>(glm::mix(lo, hi, random.uniform()));
        target[k] = place == 0 ? lo : place == 1 ? hi : static_cast<double>(inner);
    }
    if (random.below(8) == 0) {
        target += scale * random.logUniform(1e-6, 1.0) * random.normalVector();
    }
    const double distance = random.below(8) == 0 ? 0.0 : scale * random.logUniform(1e-3, 1e3);
    c.origin = target - distance * glm::dvec3(c.direction);
    c.tmax = std::numeric_limits<float>::infinity();
    const std::optional<double> needed = enterBox(leaf.needed, c, 0.0), stored = enterBox(leaf.stored, c, 0.0);
    if (needed && random.below(2) == 0) {
        c.tmax = std::nextafter(static_cast<float>(*needed), std::numeric_limits<float>::infinity());  // a hit just there
    }
    if (stored && *stored > 0.0 && random.below(8) == 0) {
        c.tmax = static_cast<float>(*stored * 0.999);  // ends before the box
        c.verdict = Miss;
        return c;
    }
    const glm::vec3 reach = glm::abs(c.origin) + glm::abs(leaf.stored.lo) + glm::abs(leaf.stored.hi);
    const double pad = 1e-5 * static_cast<double>(std::max({reach.x, reach.y, reach.z}));
    const std::optional<double> grown = enterBox(leaf.stored, c, pad);
    c.verdict = needed ? Hit : grown ? Either : Miss;
    if (needed) {
        countNaive(naive, leaf.needed, c);
    }
    c.enter = static_cast<float>(stored.value_or(-1.0));
    c.tolerance = 8e-7F * c.enter;  // difference, reciprocal of 2.5 + 2 ulp, product: 6 ulp
    return c;
}

TEST(IntersectBoxTest, H4H5MissesNoBoxThatTheSceneNeeds)
{
    constexpr std::size_t kRays = 334000;
    NaiveMisses naive{};
    for (int round = 0; round < hardRounds(6 * kRays); ++round) {
        for (const double scale : {1e-4, 1.0, 1e5}) {
            for (const double shift : {0.0, 1e3}) {
                Random random(static_cast<std::uint64_t>(round) * 17 + 4);
                const std::vector<Leaf> leaves = leavesOfScene(random, scale, shift);
                std::vector<Case> cases(kRays);
                for (Case& c : cases) {
                    c = rayAt(leaves[random.below(static_cast<std::uint32_t>(leaves.size()))], random, scale, naive);
                }
                const auto count = [&cases](std::uint32_t verdict) {
                    return std::count_if(cases.begin(), cases.end(), [verdict](const Case& c) { return c.verdict == verdict; });
                };
                const auto hits = count(Hit), misses = count(Miss);
                std::cout << "  scale " << scale << " shift " << shift << ": " << leaves.size() << " boxes, " << hits
                          << " rays that must hit, " << misses << " that must miss\n";
                EXPECT_GT(hits, 100000);
                EXPECT_GT(misses, 5000);
                KernelTest(test_kernels::intersect_box_test).cases(cases).run();
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

}  // namespace
}  // namespace glim
