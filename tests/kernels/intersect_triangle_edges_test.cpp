#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace glim::intersect_triangle_edges_test {

constexpr std::uint32_t kMaxRim = 6;

struct Case {
    vec3 origin, direction, hub, rim[kMaxRim];
    std::uint32_t triangles, turn;
};

// The ray that looks at `target`: every other one along an axis, from a place whose other coordinates are the target's.
void aim(Case& c, Random& random, const glm::dvec3& target, const glm::dvec3& view, double scale, int axis)
{
    const double distance = scale * random.logUniform(0.1, 30.0);
    c.origin = target - view * distance;
    c.direction = axis >= 0 ? view : glm::normalize(target - glm::dvec3(c.origin));
}

glm::dvec3 viewAlong(Random& random, int axis)
{
    glm::dvec3 view = random.direction();
    if (axis >= 0) {
        view = glm::dvec3(0.0);
        view[axis] = random.below(2) == 0 ? 1.0 : -1.0;
    }
    return view;
}

// Two triangles on either side of the edge from hub to rim[1] as the ray sees it, which meets the edge well within.
Case edgeCase(Random& random, double scale, double shift)
{
    Case c{};
    const int axis = static_cast<int>(random.below(6)) - 3;
    const glm::dvec3 view = viewAlong(random, axis);
    const glm::dvec3 center = scale * shift * random.direction();
    glm::dvec3 edge = random.direction();
    while (glm::length(glm::cross(edge, view)) < 0.2) {
        edge = random.direction();
    }
    c.hub = center - scale * edge;
    c.rim[1] = center + scale * edge;
    const glm::dvec3 side = glm::normalize(glm::cross(edge, view));
    for (const int k : {0, 2}) {
        const double across = (1.0 - k) * random.uniform(0.3, 1.0);
        c.rim[k] = center + scale * (across * side + random.uniform(-0.5, 0.5) * edge + random.uniform(-1.0, 1.0) * view);
    }
    c.triangles = 2;
    c.turn = random.bits();
    const glm::dvec3 target = glm::mix(glm::dvec3(c.hub), glm::dvec3(c.rim[1]), random.uniform(0.1, 0.9));
    aim(c, random, target, view, scale, axis);
    return c;
}

// Six triangles around the hub, which the ray looks at.
Case vertexCase(Random& random, double scale, double shift)
{
    Case c{};
    const int axis = static_cast<int>(random.below(6)) - 3;
    const glm::dvec3 view = viewAlong(random, axis);
    c.hub = scale * shift * random.direction();
    const glm::dvec3 x = glm::normalize(glm::cross(view, glm::dvec3(view.z, view.x, view.y) + glm::dvec3(0.3, 0.1, 0.2)));
    const glm::dvec3 y = glm::cross(view, x);
    for (std::uint32_t i = 0; i < kMaxRim; ++i) {
        const double phi = (i + random.uniform(-0.3, 0.3)) * std::numbers::pi / 3.0;
        const glm::dvec3 out = x * std::cos(phi) + y * std::sin(phi);
        c.rim[i] = glm::dvec3(c.hub) + scale * (random.uniform(0.3, 1.0) * out + random.uniform(-1.0, 1.0) * view);
    }
    c.triangles = kMaxRim;
    c.turn = random.bits();
    aim(c, random, glm::dvec3(c.hub), view, scale, axis);
    return c;
}

// H1: no ray falls between triangles, in any order of their corners. The same rays leak through Moller and Trumbore's test,
// which shows that they are hard.
void expectNoLeak(const std::string& what, Case (*makeCase)(Random&, double, double))
{
    std::size_t rays = 0, leaks = 0, many = 0;
    constexpr std::size_t kRays = 84000;
    for (int round = 0; round < hardRounds(6 * kRays); ++round) {
        for (const double scale : {1e-4, 1.0, 1e5}) {
            for (const double shift : {0.0, 1e4}) {
                Random random(static_cast<std::uint64_t>(round) * 31 + 5);
                std::vector<Case> cases(kRays);
                std::generate(cases.begin(), cases.end(), [&] { return makeCase(random, scale, shift); });
                KernelTest test(test_kernels::intersect_triangle_edges_test);
                test.cases(cases).resultsOf<uvec2>(cases.size()).run();
                for (const uvec2& hits : test.results<uvec2>()) {
                    ++rays;
                    leaks += hits.y == 0 ? 1 : 0;
                    many += hits.x > 1 ? 1 : 0;
                }
            }
        }
    }
    printHardCase("H1", what + ", scale 1e-4 to 1e5, shift 0 and 1e4", static_cast<double>(rays),
                  "leaks 0, " + std::to_string(many) + " hit more than once", "Moller and Trumbore: " + std::to_string(leaks) + " leaks");
    EXPECT_GT(leaks, rays / 1000) << what << ": these rays would not find a leak";
}

TEST(IntersectTriangleEdgesTest, H1NoRayPassesBetweenTwoTriangles) { expectNoLeak("edges", edgeCase); }

TEST(IntersectTriangleEdgesTest, H1NoRayPassesThroughAVertex) { expectNoLeak("vertices", vertexCase); }

}  // namespace glim::intersect_triangle_edges_test
