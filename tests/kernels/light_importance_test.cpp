// The importance of a node of the light tree: the formula by angles in double, and a bound of what any emitter in the node sends.
#include "shaders/shared/scene_types.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::light_importance_test {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-6;  // of a cosine: some twenty operations of half an ulp

struct Case {
    LightNode node;
    vec3 p, n;
    uint isScalable;
};

// Cones of normals and of emission from nothing to everything, on both sides or on one.
LightNode anyNode(Random& random)
{
    LightNode node{};
    node.center = vec3(random.normalVector());
    node.radius = static_cast<float>(random.below(4) == 0 ? 0.0 : random.logUniform(1e-3, 2.0));
    node.axis = vec3(random.direction());
    node.power = static_cast<float>(random.logUniform(1e-6, 1.0));
    node.cosNormals = static_cast<float>(random.below(3) == 0 ? 1.0 : random.uniform(-1.0, 1.0));
    node.cosEmission = static_cast<float>(random.below(2) == 0 ? 0.0 : random.uniform(0.0, 1.0));
    node.children = random.below(2) == 0 ? kTwoSidedNode : 0;
    return node;
}

std::vector<vec2> importances(const std::vector<Case>& cases)
{
    KernelTest test(test_kernels::light_importance_test);
    test.cases(cases).resultsOf<vec2>(cases.size()).run();
    return test.results<vec2>();
}

double angleBetween(const dvec3& a, const dvec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

struct Bounds {
    double low, high;
    bool hold(double value) const { return value >= low && value <= high; }
};

// What the formula allows, its angles being off by as much as a cosine's or a sine's rounding makes them.
struct Expected {
    Bounds emitted, received;  // cosines
    double scale;              // power over the squared distance
    bool inside;
};

Expected expectedOf(const Case& c)
{
    const dvec3 towards = dvec3(c.node.center) - dvec3(c.p);
    const double distance = glm::length(towards), radius = static_cast<double>(c.node.radius);
    const bool inside = distance <= radius;
    const double scale = static_cast<double>(c.node.power) / std::pow(std::max(distance, radius), 2.0);
    const double sine = std::min(1.0, radius / distance);
    const double spheres[] = {std::asin(sine * (1.0 - kRounding)), std::asin(std::min(1.0, sine * (1.0 + kRounding)))};
    double axis = angleBetween(dvec3(c.node.axis), -towards);
    axis = (c.node.children & kTwoSidedNode) != 0 ? std::min(axis, kPi - axis) : axis;
    const double axes[] = {std::acos(std::min(1.0, std::cos(axis) + kRounding)), std::acos(std::max(-1.0, std::cos(axis) - kRounding))};
    // Section 3: theta' = max(theta - theta_o - theta_u, 0).
    const double normals = std::acos(static_cast<double>(c.node.cosNormals)), ends = static_cast<double>(c.node.cosEmission);
    const double least = std::cos(std::max(0.0, axes[1] - normals - spheres[0])) - kRounding;
    const double most = std::cos(std::max(0.0, axes[0] - normals - spheres[1])) + kRounding;
    const auto emitted = [ends](double cosine) { return cosine > ends ? std::max(cosine, 0.0) : 0.0; };
    // cos(theta_i - theta_u) is cos theta_i cos theta_u + sin theta_i sin theta_u; with 1 for sin theta_i it only grows.
    const double receiver = angleBetween(dvec3(c.n), towards);
    const auto received = [receiver](double sphere) {
        return std::clamp(std::cos(receiver) * std::cos(sphere) + std::sin(sphere), 0.0, 1.0);
    };
    const double one = received(spheres[0]), other = received(spheres[1]);
    return {{emitted(least), emitted(most)},
            {std::max(0.0, std::min(one, other) - kRounding), std::max(one, other) + kRounding},
            scale,
            inside};
}

TEST(LightImportanceTest, IsTheFormulaByAngles)
{
    Random random(61);
    std::vector<Case> cases;
    for (int i = 0; i < 200000; ++i) {
        const LightNode node = anyNode(random);
        const double distance = static_cast<double>(std::max(node.radius, 1e-3F)) * random.logUniform(0.3, 1e3);
        cases.push_back({node, vec3(dvec3(node.center) + distance * random.direction()), vec3(random.direction()), 1});
    }
    const std::vector<vec2> found = importances(cases);
    std::size_t inside = 0, unlit = 0, unseen = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Expected expected = expectedOf(cases[i]);
        const double without = static_cast<double>(found[i].x) / expected.scale, with = static_cast<double>(found[i].y) / expected.scale;
        const Bounds all = expected.inside ? Bounds{1.0 - kRounding, 1.0 + kRounding} : expected.emitted;
        const Bounds reached = expected.inside ? Bounds{1.0, 1.0} : expected.received;
        EXPECT_TRUE(all.hold(without)) << "case " << i << ": " << without << " in [" << all.low << ", " << all.high << ']';
        EXPECT_TRUE((Bounds{all.low * reached.low - kRounding, all.high * reached.high + kRounding}).hold(with))
            << "case " << i << ": " << with;
        EXPECT_TRUE(expected.inside || reached.high > kRounding || found[i].y == 0.0F) << "case " << i << ": " << with;
        inside += expected.inside ? 1 : 0;
        unlit += !expected.inside && all.high == 0.0 ? 1 : 0;
        unseen += !expected.inside && reached.high <= kRounding ? 1 : 0;
    }
    // So that each of the three rules has been met.
    EXPECT_GT(inside, cases.size() / 20);
    EXPECT_GT(unlit, cases.size() / 20);
    EXPECT_GT(unseen, cases.size() / 20);
}

dvec3 within(Random& random, const dvec3& axis, double angle)
{
    const dvec3 across = glm::normalize(glm::cross(axis, random.direction()));
    return std::cos(angle) * axis + std::sin(angle) * across;
}

// An emitter somewhere in the node's sphere whose normal is within the node's cone, mostly at the rim of both. What it sends to the
// receiver is no more than what the importance says; but for the distance, which counts to the sphere's middle.
TEST(LightImportanceTest, BoundsWhatAnyEmitterInTheNodeSends)
{
    Random random(62);
    std::vector<Case> cases;
    for (int i = 0; i < 4000; ++i) {
        const LightNode node = anyNode(random);
        const double distance = static_cast<double>(std::max(node.radius, 1e-3F)) * random.logUniform(1.01, 20.0);
        cases.push_back({node, vec3(dvec3(node.center) + distance * random.direction()), vec3(random.direction()), 1});
    }
    const std::vector<vec2> found = importances(cases);
    double tightest = INFINITY;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto& [node, p, n, isScalable] = cases[i];
        const double distance2 = glm::dot(dvec3(p) - dvec3(node.center), dvec3(p) - dvec3(node.center));
        const double cosine = static_cast<double>(found[i].y) * distance2 / static_cast<double>(node.power);
        const double cone = std::acos(static_cast<double>(node.cosNormals));
        double most = 0.0;
        for (int k = 0; k < 400; ++k) {
            const double share = k % 4 == 0 ? std::cbrt(random.uniform()) : 1.0;
            const dvec3 emitter = dvec3(node.center) + share * static_cast<double>(node.radius) * random.direction();
            const dvec3 towards = glm::normalize(dvec3(p) - emitter);
            const dvec3 normal = within(random, dvec3(node.axis), cone * (k % 3 == 0 ? random.uniform() : 1.0));
            double emitted = glm::dot(normal, towards);
            emitted = (node.children & kTwoSidedNode) != 0 ? std::abs(emitted) : emitted;
            const bool shines = emitted > 0.0 && emitted > static_cast<double>(node.cosEmission);
            most = std::max(most, shines ? emitted * std::max(0.0, -glm::dot(dvec3(n), towards)) : 0.0);
        }
        EXPECT_LE(most, cosine + kRounding) << "case " << i;
        tightest = most > 0.1 ? std::min(tightest, cosine / most) : tightest;
    }
    EXPECT_LT(tightest, 1.01) << "or the bound is loose everywhere";
}

// The receiver at the middle or on the rim of the sphere, a node without extent, normals that need a sine of 0.
TEST(LightImportanceTest, IsFiniteAtTheEdgesOfItsDomain)
{
    std::vector<Case> cases;
    for (const float radius : {0.0F, 1e-20F, 1.0F, 1e6F}) {
        for (const float away : {0.0F, 1e-25F, 1e-3F, 1.0F, 1.0F + 0x1p-23F, 1e6F, 1e12F}) {
            for (const float cosNormals : {-1.0F, 0.0F, 1.0F}) {
                const uint isScalable = radius >= 1e-3F && away <= 1e6F ? 1 : 0;
                for (const vec3 axis : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0)}) {
                    cases.push_back({{vec3(0.0F), radius, axis, 1.0F, cosNormals, 0.0F, 0, 0}, {0, 0, away}, {0, 0, -1}, isScalable});
                }
            }
        }
    }
    const std::vector<vec2> found = importances(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        for (const float importance : {found[i].x, found[i].y}) {
            // A sum of 2^27 children's is finite too.
            EXPECT_TRUE(importance >= 0.0F && importance <= 1.001e30F) << "case " << i << ": " << importance;
        }
    }
}

}  // namespace glim::light_importance_test
