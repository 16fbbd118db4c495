#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace glim::intersect_sphere_test {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Case {
    vec3 origin, direction, center;
    float radius, tmax;
    std::uint32_t onSphere;
};

struct Roots {
    bool real;
    double first, last;
};

// By the quadratic formula in extended precision: with 64 digits its cancellation costs less than float's rounding.
Roots rootsOf(const Case& c)
{
    using Vector = glm::vec<3, long double>;
    const Vector f = Vector(c.origin) - Vector(c.center), d(c.direction);
    const long double a = glm::dot(d, d), b = glm::dot(f, d);
    const long double radius = static_cast<long double>(c.radius);
    const long double discriminant = b * b - a * (glm::dot(f, f) - radius * radius);
    const long double root = std::sqrt(std::max(0.0L, discriminant));
    return {discriminant >= 0.0L, static_cast<double>((-b - root) / a), static_cast<double>((-b + root) / a)};
}

std::vector<float> distances(const std::vector<Case>& cases)
{
    constexpr std::size_t kPart = 500000;  // that fit a buffer anywhere
    std::vector<float> found;
    for (std::size_t begin = 0; begin < cases.size(); begin += kPart) {
        const auto first = cases.begin() + static_cast<std::ptrdiff_t>(begin);
        const std::vector<Case> part(first, first + static_cast<std::ptrdiff_t>(std::min(kPart, cases.size() - begin)));
        KernelTest test(test_kernels::intersect_sphere_test);
        test.cases(part).resultsOf<float>(part.size()).run();
        const std::vector<float> results = test.results<float>();
        found.insert(found.end(), results.begin(), results.end());
    }
    return found;
}

struct Accuracy {
    double falseMisses = 0.0;  // share of the rays that meet the sphere
    double meanError = 0.0;    // of t, metres
};

// b^2 - 4 a c as in the textbooks, in float.
std::vector<float> naiveDistances(const std::vector<Case>& cases)
{
    std::vector<float> found;
    for (const Case& c : cases) {
        const vec3 f = c.origin - c.center;
        const float a = glm::dot(c.direction, c.direction), b = 2.0F * glm::dot(f, c.direction);
        const float discriminant = b * b - 4.0F * a * (glm::dot(f, f) - c.radius * c.radius);
        const float root = std::sqrt(std::max(0.0F, discriminant));
        const float first = (-b - root) / (2.0F * a), t = first > 0.0F ? first : (-b + root) / (2.0F * a);
        found.push_back(discriminant >= 0.0F && t > 0.0F ? t : -1.0F);
    }
    return found;
}

Accuracy measure(const std::vector<Case>& cases, const std::vector<float>& found)
{
    double meeting = 0.0, missed = 0.0, error = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Roots roots = rootsOf(cases[i]);
        const double t = roots.first > 0.0 ? roots.first : roots.last;
        if (!roots.real || !(t > 0.0)) {
            continue;
        }
        meeting += 1.0;
        if (found[i] < 0.0F) {
            missed += 1.0;
        } else {
            error += std::abs(static_cast<double>(found[i]) - t);
        }
    }
    EXPECT_GT(meeting, 0.4 * static_cast<double>(cases.size()));
    return {missed / meeting, error / (meeting - missed)};
}

// A ray from `distance` at a point of the disc that the sphere shows.
Case rayFrom(Random& random, double radius, double distance)
{
    const glm::dvec3 center(0.0), out = random.direction();
    const glm::dvec3 rim = glm::normalize(glm::cross(out, random.direction()));
    Case c{center + distance * out, {}, center, static_cast<float>(radius), kInfinity, 0};
    const glm::dvec3 target = center + radius * std::sqrt(random.uniform()) * rim;
    c.direction = glm::normalize(target - glm::dvec3(c.origin));
    return c;
}

std::string describe(const Accuracy& accuracy, double radius)
{
    return "misses " + figure(accuracy.falseMisses) + ", error of t " + figure(accuracy.meanError / radius) + " r";
}

struct Row {
    double radius, distance, falseMisses, meanError;  // limits; the error in radii
};

// Radius, distance, largest share of false misses, largest mean error; at 1e5 five half ulps of t.
TEST(IntersectSphereTest, H9FarSpheresAreAccurate)
{
    for (const Row& row : {Row{1.0, 2.0, 1e-5, 1e-6}, Row{1.0, 1e3, 1e-5, 2e-4}, Row{1.0, 1e4, 1e-4, 1e-3}, Row{1.0, 1e5, 5e-4, 2e-2},
                           Row{1e-3, 10.0, 1e-4, 1e-3}}) {
        Random random(6);
        std::vector<Case> cases(hardTrials(400000));
        std::generate(cases.begin(), cases.end(), [&] { return rayFrom(random, row.radius, row.distance); });
        const Accuracy accuracy = measure(cases, distances(cases)), naive = measure(cases, naiveDistances(cases));
        printHardCase("H9", "radius " + figure(row.radius) + " from " + figure(row.distance), static_cast<double>(cases.size()),
                      describe(accuracy, row.radius), "b^2 - 4ac: " + describe(naive, row.radius));
        EXPECT_LE(accuracy.falseMisses, row.falseMisses);
        EXPECT_LE(accuracy.meanError / row.radius, row.meanError);
        EXPECT_EQ(naive.falseMisses > row.falseMisses, row.distance > 100.0 * row.radius);
    }
}

// A ground sphere of radius 1e5, seen from 1 above; looking down.
TEST(IntersectSphereTest, H9HugeSphereBelowTheCamera)
{
    Random random(7);
    std::vector<Case> cases(hardTrials(400000));
    for (Case& c : cases) {
        glm::dvec3 down = random.direction();
        down.y = -std::max(0.1, std::abs(down.y));
        c = {{0.0F, 1.0F, 0.0F}, glm::normalize(down), {0.0F, -1e5F, 0.0F}, 1e5F, kInfinity, 0};
    }
    const Accuracy accuracy = measure(cases, distances(cases)), naive = measure(cases, naiveDistances(cases));
    printHardCase("H9", "ground of 1e5 from 1 above (r: metres)", static_cast<double>(cases.size()), describe(accuracy, 1.0),
                  "b^2 - 4ac: " + describe(naive, 1.0));
    EXPECT_EQ(accuracy.falseMisses, 0.0);
    EXPECT_LE(accuracy.meanError, 2e-5);
    EXPECT_GT(naive.meanError, 2e-5);
}

TEST(IntersectSphereTest, SeenFromWithin)
{
    Random random(8);
    std::vector<Case> cases(200000);
    for (Case& c : cases) {
        const double radius = random.logUniform(1e-4, 1e5);
        const glm::dvec3 center = radius * random.normalVector();
        c = {center + radius * random.uniform(0.0, 0.99) * random.direction(),
             random.direction(),
             center,
             static_cast<float>(radius),
             kInfinity,
             0};
    }
    const std::vector<float> found = distances(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        // At 0.99 of the radius the far root is conditioned like 1 / sqrt(1 - 0.99^2) = 7; ten roundings of up to 5 radii.
        ASSERT_NEAR(static_cast<double>(found[i]), rootsOf(cases[i]).last, 2e-5 * static_cast<double>(cases[i].radius)) << i;
    }
}

// A ray that starts on the sphere meets the far side from within, or nothing. It never meets its start.
TEST(IntersectSphereTest, LeavesItsOwnSurface)
{
    Random random(9);
    std::vector<Case> cases(300000);
    std::vector<double> chords;  // 0: outwards
    for (Case& c : cases) {
        const double radius = random.logUniform(1e-4, 1e5);
        const glm::dvec3 center = radius * random.normalVector(), n = random.direction();
        const glm::dvec3 d = random.direction();
        c = {center + radius * n, d, center, static_cast<float>(radius), kInfinity, 1};
        chords.push_back(std::max(0.0, -2.0 * radius * glm::dot(n, d)));
    }
    const std::vector<float> found = distances(cases);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        // The start is off the sphere by up to d = 1e-6 radii, so the far root is off by d r / chord, and at most sqrt(2 d) r.
        const double radius = static_cast<double>(cases[i].radius), d = 1e-6 * radius;
        const double slack = std::min(d + d * radius / chords[i], std::sqrt(2.0 * d * radius));
        ASSERT_NEAR(std::max(0.0, static_cast<double>(found[i])), chords[i], slack) << i;
        if (glm::dot(cases[i].direction, cases[i].origin - cases[i].center) > 1e-5F * cases[i].radius) {
            ASSERT_EQ(found[i], -1.0F) << i;
        }
    }
}

TEST(IntersectSphereTest, TangentAndAwayAndBehind)
{
    const vec3 x(1.0F, 0.0F, 0.0F);
    const std::vector<Case> cases = {
        {{-3.0F, 1.0F, 0.0F}, x, {}, 1.0F, kInfinity, 0},             // touches at 3
        {{-3.0F, 1.0F + 0x1p-20F, 0.0F}, x, {}, 1.0F, kInfinity, 0},  // passes
        {{3.0F, 0.0F, 0.0F}, x, {}, 1.0F, kInfinity, 0},              // behind
        {{-3.0F, 0.0F, 0.0F}, x, {}, 1.0F, 1.5F, 0},                  // too far
        {{0.0F, 1.0F, 0.0F}, x, {}, 1.0F, kInfinity, 0},              // starts at the point of contact
        {{-3.0F, 0.0F, 0.0F}, 2.0F * x, {}, 1.0F, kInfinity, 0},      // direction of length 2
    };
    EXPECT_EQ(distances(cases), (std::vector<float>{3.0F, -1.0F, -1.0F, -1.0F, -1.0F, 1.0F}));
}

}  // namespace glim::intersect_sphere_test
