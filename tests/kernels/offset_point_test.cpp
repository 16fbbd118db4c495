#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numbers>

namespace glim::offset_point_test {

struct Case {
    vec3 v0, v1, v2, v3;
    vec2 barycentric;
    vec3 normal, direction;
    float from, side, next;
    std::uint32_t large;
};

struct Result {
    vec3 point, bound, origin, onSphere;
    std::uint32_t self, neighbour;
};

// H7's table: triangles of `size` about a point at `place`, which the ray leaves.
struct Row {
    const char* name;
    double size, place;
    bool neighbours;    // rounding of their corners bends them by less than what is tested
    bool flat = false;  // along an axis, across which they have no extent
};

constexpr Row kRows[] = {
    {"unit at the origin", 1.0, 1.0, true},
    {"scale 1e-4", 1e-4, 1e-4, true},
    {"scale 1e5", 1e5, 1e5, true},
    {"unit at 1e4", 1.0, 1e4, true},
    {"unit at 1e6", 1.0, 1e6, false},
    {"size 1e5 near the origin", 1e5, 1.0, true},
    {"size 1e3 near the origin", 1e3, 1.0, true},
    {"H51 a flat ground of 1e3 m", 1e3, 1.0, true, true},
    {"H51 a flat ground of 1e5 m", 1e5, 1.0, true, true},
    {"H51 a flat ground of 1e7 m", 1e7, 1.0, true, true},
};

void setNext(Case& c, Random& random)
{
    c.from = static_cast<float>(random.logUniform(1e-30, 1e30) * (random.below(2) == 0 ? 1.0 : -1.0));
    c.side = static_cast<float>(random.uniform(-1.0, 1.0));
    c.next = std::nextafter(c.from, c.side > 0.0F ? 3e38F : -3e38F);
    if (random.below(16) == 0) {
        c.from = 0.0F;
        c.next = c.side > 0.0F ? 0x1p-126F : -0x1p-126F;
    } else if (random.below(16) == 0) {
        c.side = 0.0F;
        c.next = c.from;
    }
}

// One half of the points lie close to the edge that the neighbour shares.
Case makeCase(const Row& row, bool large, Random& random)
{
    Case c{};
    const double toEdge = random.below(2) == 0 ? random.uniform() : random.logUniform(1e-8, 1.0);
    const double b1 = (1.0 - toEdge) * random.uniform(), b2 = 1.0 - toEdge - b1;
    c.barycentric = {b1, b2};
    glm::dvec3 normal(0.0);
    while (glm::length(normal) == 0.0) {  // at 1e6 rounding flattens some
        glm::dvec3 e1 = row.size * random.normalVector(), e2 = row.size * random.normalVector();
        if (row.flat) {
            const int axis = static_cast<int>(random.below(3));
            e1[axis] = e2[axis] = 0.0;
        }
        const glm::dvec3 v0 = row.place * random.direction() - b1 * e1 - b2 * e2;
        c.v0 = v0;
        c.v1 = v0 + e1;
        c.v2 = v0 + e2;
        normal = glm::cross(glm::dvec3(c.v1 - c.v0), glm::dvec3(c.v2 - c.v0));
    }
    c.v3 = glm::dvec3(c.v1) + glm::dvec3(c.v2) - glm::dvec3(c.v0);
    const glm::dvec3 n = glm::normalize(normal) * (random.below(2) == 0 ? 1.0 : -1.0);
    c.normal = n;
    const glm::dvec3 x = glm::normalize(glm::cross(n, random.direction())), y = glm::cross(n, x);
    const double u = random.uniform(), phi = 2.0 * std::numbers::pi * random.uniform();
    c.direction = std::sqrt(u) * (std::cos(phi) * x + std::sin(phi) * y) + std::sqrt(1.0 - u) * n;
    setNext(c, random);
    c.large = large ? 1 : 0;
    return c;
}

// What an offset may be at most; by axes, each counts by its share of the normal.
double getLimit(const Case& c, const glm::dvec3& point)
{
    const glm::dvec3 e1 = glm::dvec3(c.v1) - glm::dvec3(c.v0), e2 = glm::dvec3(c.v2) - glm::dvec3(c.v0);
    if (c.large == 0) {
        return 5e-6 * std::max(glm::length(e1), glm::length(e2)) + 4.0 * 0x1p-23 * glm::length(point);
    }
    const glm::dvec3 across = glm::abs(glm::dvec3(c.normal));
    return 5e-6 * glm::dot(across, glm::max(glm::abs(e1), glm::abs(e2))) + 4.0 * 0x1p-23 * glm::dot(across, glm::abs(point));
}

struct Tally {
    double rays = 0.0, unbounded = 0.0, self = 0.0, neighbour = 0.0, behind = 0.0, inSphere = 0.0, offset = 0.0, limit = 0.0;
};

void count(Tally& tally, const Case& c, const Result& r)
{
    const glm::dvec3 e1 = glm::dvec3(c.v1) - glm::dvec3(c.v0), e2 = glm::dvec3(c.v2) - glm::dvec3(c.v0);
    const glm::dvec3 n = glm::cross(e1, e2) * (glm::dot(glm::cross(e1, e2), glm::dvec3(c.normal)) > 0.0 ? 1.0 : -1.0);
    tally.rays += 1.0;
    const glm::dvec2 b(c.barycentric);
    const glm::dvec3 error = glm::abs(glm::dvec3(r.point) - (glm::dvec3(c.v0) + e1 * b.x + e2 * b.y));
    const bool bounded = glm::all(glm::lessThanEqual(error, glm::dvec3(r.bound)));
    tally.unbounded += bounded ? 0.0 : 1.0;
    tally.self += r.self;
    tally.neighbour += r.neighbour;
    tally.behind += glm::dot(glm::dvec3(r.origin) - glm::dvec3(c.v0), n) > 0.0 ? 0.0 : 1.0;
    tally.inSphere += glm::distance(glm::dvec3(r.onSphere), glm::dvec3(c.v0)) > glm::length(e1) ? 0.0 : 1.0;
    tally.offset += glm::distance(glm::dvec3(r.origin), glm::dvec3(r.point));
    tally.limit += getLimit(c, glm::dvec3(r.point));
}

void expectToLeave(const Row& row, bool large)
{
    Tally tally;
    for (int round = 0; round < testRounds(); ++round) {
        Random random(static_cast<std::uint64_t>(round) * 13 + 10);
        std::vector<Case> cases(300000);
        std::generate(cases.begin(), cases.end(), [&] { return makeCase(row, large, random); });
        KernelTest test(test_kernels::offset_point_test);
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        const std::vector<Result> results = test.results<Result>();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            count(tally, cases[i], results[i]);
        }
    }
    std::cout << "  " << row.name << (large ? ", by axes" : "") << ": of " << tally.rays << " rays " << tally.self
              << " meet their triangle, " << tally.neighbour << " its neighbour; " << tally.unbounded << " points exceed their bound, "
              << tally.behind << " rays start behind the triangle, " << tally.inSphere << " in the sphere; mean offset "
              << tally.offset / tally.rays << " m, allowed " << tally.limit / tally.rays << '\n';
    EXPECT_LT(tally.self / tally.rays, 1e-4) << row.name;
    EXPECT_LT(row.neighbours ? tally.neighbour / tally.rays : 0.0, 1e-4) << row.name;
    EXPECT_EQ(tally.unbounded, 0.0) << row.name;
    EXPECT_EQ(tally.behind, 0.0) << row.name;
    EXPECT_EQ(tally.inSphere, 0.0) << row.name;
    EXPECT_LE(tally.offset, tally.limit) << row.name;
}

// A ray skips the triangle that it leaves (traverse.glsl): `self` counts the hits that only this rule prevents.
TEST(OffsetPointTest, H7RaysDoNotHitTheSurfaceThatTheyLeave)
{
    for (const Row& row : kRows) {
        expectToLeave(row, true);
        if (!row.flat) {  // from flat ones, 4e-4 of the rays meet them
            expectToLeave(row, false);
        }
    }
}

}  // namespace glim::offset_point_test
