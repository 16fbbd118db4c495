#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <iterator>
#include <limits>

namespace glim::intersect_triangle_test {

enum Verdict : std::uint32_t { Miss = 0, Hit = 1, Either = 2 };

struct Case {
    vec3 origin, direction, v0, v1, v2;
    float tmax;
    std::uint32_t verdict = Either;
    std::uint32_t fat = 0;
    float t = -1.0F, tTolerance = 0.0F;
    vec2 barycentric{0.0F};
    float barycentricTolerance = 0.0F;
    std::uint32_t plain = 0;
};

constexpr double kUnit = 0x1p-24;  // relative rounding error of one float operation

// A triangle's corner in the plane that a ray's direction is projected out of, and how far rounding may move it: difference
// and subtraction 1 unit each on both terms, a division of 2.5 ulp and a product on the second.
struct Projected {
    glm::dvec2 p, error;
    double along;
};

Projected project(const vec3& v, const Case& c, int axis)
{
    const glm::dvec3 a = glm::dvec3(v) - glm::dvec3(c.origin), d(c.direction);
    Projected projected{};
    projected.along = a[axis];
    for (int k = 0; k < 2; ++k) {
        const int j = (axis + 1 + k) % 3;
        const double shear = d[j] / d[axis] * a[axis];
        projected.p[k] = a[j] - shear;
        projected.error[k] = kUnit * (2.0 * std::abs(a[j]) + 8.0 * std::abs(shear));
    }
    return projected;
}

struct EdgeFunction {
    double value, error;
};

EdgeFunction edgeFunction(const Projected& a, const Projected& b)
{
    const auto product = [](double x, double ex, double y, double ey) {
        return (std::abs(x) + ex) * (std::abs(y) + ey) * (1.0 + 2.0 * kUnit) - std::abs(x * y);
    };
    return {a.p.x * b.p.y - a.p.y * b.p.x, product(a.p.x, a.error.x, b.p.y, b.error.y) + product(a.p.y, a.error.y, b.p.x, b.error.x)};
}

// The truth by volumes in double, with bounds on what rounding may do to a float32 evaluation of Woop's formulas.
void judge(Case& c)
{
    const glm::dvec3 size = glm::abs(glm::dvec3(c.direction));
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const Projected v[3] = {project(c.v0, c, axis), project(c.v1, c, axis), project(c.v2, c, axis)};
    double sum = 0.0, sumError = 0.0, depth = 0.0, depthError = 0.0;
    bool someClearlyAbove = false, someClearlyBelow = false, allClear = true;
    EdgeFunction e[3];
    for (int i = 0; i < 3; ++i) {
        e[i] = edgeFunction(v[(i + 1) % 3], v[(i + 2) % 3]);
        sum += e[i].value;
        sumError += e[i].error + 2.0 * kUnit * std::abs(e[i].value);
        depth += e[i].value * v[i].along;
        depthError += (e[i].error + 5.0 * kUnit * std::abs(e[i].value)) * std::abs(v[i].along);
        someClearlyAbove = someClearlyAbove || e[i].value > e[i].error;
        someClearlyBelow = someClearlyBelow || e[i].value < -e[i].error;
        allClear = allClear && std::abs(e[i].value) > e[i].error;
    }
    if (someClearlyAbove && someClearlyBelow) {
        c.verdict = Miss;
        return;
    }
    if (!allClear || std::abs(sum) <= 1.5 * sumError) {
        return;
    }
    const double safe = std::abs(sum) - sumError;
    const double t = depth / sum / static_cast<double>(c.direction[axis]);
    const double tError = depthError / safe / size[axis] + std::abs(t) * (sumError / safe + 12.0 * kUnit);
    if (std::abs(t) <= tError || std::abs(t - static_cast<double>(c.tmax)) <= tError) {
        return;
    }
    c.verdict = t > 0.0 && t <= static_cast<double>(c.tmax) ? Hit : Miss;
    c.t = static_cast<float>(t);
    c.tTolerance = static_cast<float>(tError);
    c.barycentric = {e[1].value / sum, e[2].value / sum};
    c.barycentricTolerance = static_cast<float>(2.0 * (sumError / safe + 6.0 * kUnit));
}

glm::dvec3 rayDirection(Random& random)
{
    glm::dvec3 d = random.direction();
    if (random.below(4) == 0) {
        d = glm::dvec3(0.0);
        d[static_cast<int>(random.below(3))] = random.below(2) == 0 ? 1.0 : -1.0;
        return random.below(2) == 0 ? d : -d;  // with zeros of either sign
    }
    return d;
}

// Where Moller and Trumbore's ten roundings, each relative to |e1| |e2| |origin - v0|, stay below 1e-5 of t, and neither an
// edge nor tmax is near.
bool isFat(const Case& c)
{
    const glm::dvec3 e1(c.v1 - c.v0), e2(c.v2 - c.v0), d(c.direction), from = glm::dvec3(c.origin) - glm::dvec3(c.v0);
    const double sides = glm::length(e1) * glm::length(e2), apart = std::max(glm::length(e1), glm::length(e2));
    const double det = glm::dot(glm::cross(d, e2), e1);
    const double b1 = glm::dot(glm::cross(d, e2), from) / det, b2 = glm::dot(glm::cross(from, e1), d) / det;
    const double t = glm::dot(glm::cross(from, e1), e2) / det, tmax = static_cast<double>(c.tmax);
    const double least = std::min({std::abs(1.0 - b1 - b2), std::abs(b1), std::abs(b2)});
    return c.verdict != Either && least > 1e-3 && std::abs(t) > apart && std::abs(t) < 10.0 * apart &&
           std::abs(t - tmax) > 1e-3 * std::abs(t) && sides > 0.2 * apart * apart && std::abs(det) > 0.2 * sides;
}

// A ray at point b0 v0 + b1 v1 + b2 v2, which lies outside about as often as inside.
void aim(Case& c, Random& random, double scale)
{
    const double b1 = random.uniform(-0.4, 1.1), b2 = random.uniform(-0.4, 1.1 - b1);
    const glm::dvec3 target = glm::dvec3(c.v0) * (1.0 - b1 - b2) + glm::dvec3(c.v1) * b1 + glm::dvec3(c.v2) * b2;
    const glm::dvec3 d = rayDirection(random);
    const double distance = scale * random.logUniform(1e-2, 1e2);
    c.origin = target - d * distance;
    c.direction = d;
    const std::uint32_t reach = random.below(3);
    c.tmax = reach == 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(distance * (reach == 1 ? 1.5 : 0.7));
    judge(c);
    c.fat = isFat(c) ? 1 : 0;
}

void runCases(const std::string& what, const std::vector<Case>& cases)
{
    const auto count = [&cases](std::uint32_t verdict) {
        return std::count_if(cases.begin(), cases.end(), [verdict](const Case& c) { return c.verdict == verdict; });
    };
    std::cout << "  " << what << ": " << count(Hit) << " hits, " << count(Miss) << " misses, " << count(Either)
              << " that rounding may decide\n";
    EXPECT_GT(count(Hit), 100) << what;
    EXPECT_GT(count(Miss), 100) << what;
    KernelTest(test_kernels::intersect_triangle_test).cases(cases).run();
}

std::vector<Case> ordinaryCases(Random& random, double scale, double shift)
{
    std::vector<Case> cases(100000);
    for (Case& c : cases) {
        const glm::dvec3 center = scale * shift * random.direction();
        c.v0 = center + scale * random.normalVector();
        c.v1 = center + scale * random.normalVector();
        c.v2 = center + scale * random.normalVector();
        aim(c, random, scale);
    }
    return cases;
}

TEST(IntersectTriangleTest, AgreesWithDoubleAtAnyScaleAndPlace)
{
    for (int round = 0; round < testRounds(); ++round) {
        for (const double scale : {1e-4, 1.0, 1e5}) {
            for (const double shift : {0.0, 1e4}) {
                Random random(static_cast<std::uint64_t>(round) * 97 + 1);
                const std::string what = "scale " + std::to_string(scale) + " shift " + std::to_string(shift);
                runCases(what, ordinaryCases(random, scale, shift));
            }
        }
    }
}

// A ray that looks down at a flat ground from 1 cm to 10 m, which is as good as never near an edge.
Case groundCase(Random& random, double size)
{
    Case c{};
    c.plain = 1;
    c.tmax = std::numeric_limits<float>::infinity();
    const auto axis = static_cast<int>(random.below(3));
    const double height = random.uniform(-2.0, 2.0);
    const auto corner = [&](double angle) {
        glm::vec3 v(0.0F);
        v[axis] = static_cast<float>(height);
        v[(axis + 1) % 3] = static_cast<float>(size * std::cos(angle));
        v[(axis + 2) % 3] = static_cast<float>(size * std::sin(angle));
        return v;
    };
    const double turn = random.uniform(0.0, 6.28);
    c.v0 = corner(turn);
    c.v1 = corner(turn + random.uniform(1.8, 2.4));
    c.v2 = corner(turn - random.uniform(1.8, 2.4));
    glm::dvec3 d = random.direction();
    while (std::abs(d[axis]) < 0.02) {
        d = random.direction();
    }
    c.direction = d;
    glm::dvec3 from = 0.01 * size * random.direction();
    from[axis] = height - random.logUniform(0.01, std::min(10.0, 0.002 * size)) * (d[axis] > 0.0 ? 1.0 : -1.0);
    c.origin = from;
    const double t = (static_cast<double>(c.v0[axis]) - static_cast<double>(c.origin[axis])) / static_cast<double>(c.direction[axis]);
    c.verdict = Hit;
    c.t = static_cast<float>(t);
    // A difference, products, two sums, the weights' sum, a reciprocal and a division of 2.5 ulp each, and a product.
    c.tTolerance = static_cast<float>((1.0 + 1.0 + 2.0 + 2.0 + 5.0 + 5.0 + 1.0) * kUnit * t);
    c.barycentric = {1.0 / 3.0, 1.0 / 3.0};
    c.barycentricTolerance = 1.0F;
    return c;
}

TEST(IntersectTriangleTest, H51FlatGroundsGiveTheDistance)
{
    for (const double size : {1e2, 1e4, 1e6, 1e7}) {
        Random random(11);
        std::vector<Case> cases = ordinaryCases(random, 1.0, 0.0);  // so that every check of the kernel runs
        std::generate_n(std::back_inserter(cases), 100000, [&] { return groundCase(random, size); });
        KernelTest(test_kernels::intersect_triangle_test).cases(cases).run();
        printHardCase("H51", "rays at a flat ground of " + figure(size) + " m", 1e5, "t within 1e-6 of it");
    }
}

// Aspect ratios of 1 to 1e8.
TEST(IntersectTriangleTest, H2SliversAgreeWithDouble)
{
    constexpr std::size_t kRays = 500000;
    for (int round = 0; round < hardRounds(2 * kRays); ++round) {
        Random random(static_cast<std::uint64_t>(round) * 97 + 2);
        for (int part = 0; part < 2; ++part) {
            std::vector<Case> cases(kRays);
            for (Case& c : cases) {
                const glm::dvec3 v0 = random.normalVector(), v1 = random.normalVector();
                c.v0 = v0;
                c.v1 = v1;
                c.v2 = glm::mix(v0, v1, random.uniform(-0.2, 1.2)) + random.normalVector() / random.logUniform(1.0, 1e8);
                aim(c, random, 1.0);
            }
            runCases("slivers", cases);
        }
    }
    printHardCase("H2", "aspect ratios to 1e8", 2.0 * kRays * hardRounds(2 * kRays), "each as double says, or rounding decides");
}

// Whether Moller and Trumbore's determinant passes the threshold of 1e-8 that many add to their test.
bool passesThreshold(const Case& c)
{
    const vec3 e1 = c.v1 - c.v0, e2 = c.v2 - c.v0;
    return std::abs(glm::dot(e1, glm::cross(c.direction, e2))) >= 1e-8F;
}

TEST(IntersectTriangleTest, H2SmallTrianglesAreHit)
{
    Random random(5);
    std::vector<Case> cases = ordinaryCases(random, 1e-5, 0.0);
    const auto isLost = [](const Case& c) { return c.verdict == Hit && !passesThreshold(c); };
    const auto isHit = [](const Case& c) { return c.verdict == Hit; };
    const auto lost = std::count_if(cases.begin(), cases.end(), isLost), hits = std::count_if(cases.begin(), cases.end(), isHit);
    runCases("size 1e-5", cases);
    printHardCase("H2", "triangles of 1e-5", static_cast<double>(hits), "hits lost 0",
                  "threshold of 1e-8 for the determinant: " + std::to_string(lost) + " lost");
    EXPECT_GT(lost, hits / 2);
}

// Coincident and collinear corners, and sizes whose products leave float's normal range. Only the outputs' being
// numbers, and in range, is at stake (the kernel checks it for every case); beyond 1e-9 to 1e10 the third powers of distances
// leave the range, and hits may be lost.
TEST(IntersectTriangleTest, H2DegenerateTrianglesGiveNoNan)
{
    Random random(3);
    std::vector<Case> cases(200000);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        Case& c = cases[i];
        const double scale = i % 5 == 4 ? random.logUniform(1e-22, 1e15) : 1.0;
        c.v0 = scale * random.normalVector();
        c.v1 = i % 5 == 0 ? c.v0 : vec3(scale * random.normalVector());
        c.v2 = i % 5 <= 1   ? c.v1
               : i % 5 == 2 ? 2.0F * c.v1 - c.v0
               : i % 5 == 3 ? c.v0 + 2.0F * (c.v1 - c.v0)
                            : vec3(scale * random.normalVector());
        aim(c, random, scale);
        if (scale < 1e-9 || scale > 1e10) {
            c.verdict = Either;
            c.fat = 0;
        }
    }
    runCases("degenerate", cases);
}

// Rays in the plane of a triangle that pass it at half of its distance and more. All three edge functions are rounding noise, and
// often zero. When such zeros counted as hits, brute force saw triangles that the tree had rightly culled.
TEST(IntersectTriangleTest, RaysInTheTrianglesPlaneMissIt)
{
    Random random(4);
    // Among others that are hit, so that every check of the kernel runs.
    std::vector<Case> cases = ordinaryCases(random, 1.0, 0.0);
    for (int i = 0; i < 400000; ++i) {
        const glm::dvec3 direction = random.direction();
        const glm::dvec3 aside = glm::normalize(glm::cross(direction, random.direction()));
        const auto corner = [&] { return vec3(random.uniform(0.5, 2.0) * direction + random.uniform(0.5, 1.0) * aside); };
        Case& c = cases.emplace_back();
        c.origin = vec3(0.0F);
        c.direction = vec3(direction);
        c.v0 = corner();
        c.v1 = corner();
        c.v2 = corner();
        c.tmax = std::numeric_limits<float>::max();
        c.verdict = Miss;
    }
    KernelTest(test_kernels::intersect_triangle_test).cases(cases).run();
}

}  // namespace glim::intersect_triangle_test
