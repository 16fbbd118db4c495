#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/irradiance_formulas.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim::spherical_rectangle_test {

struct Case {
    vec3 p, corner, x, y;
    vec2 size, u;
    float solidAngle, tolerance;
    vec2 share;
    float shareTolerance;
};

struct Result {
    float solidAngle;
    vec2 share;
};

// In the frame of its edges, relative to the point's foot in its plane.
struct Seen {
    glm::dvec2 low, size;
    double height;
};

Seen seenBy(const Case& c)
{
    const glm::dvec3 from = glm::dvec3(c.corner) - glm::dvec3(c.p), x(c.x), y(c.y);
    return {{glm::dot(from, x), glm::dot(from, y)}, glm::dvec2(c.size), std::abs(glm::dot(from, glm::cross(x, y)))};
}

// Of the rectangle from the foot to (x, y). Another formula than the kernel's: four of these, which cancel.
double quadrant(double x, double y, double height) { return std::atan2(x * y, height * std::sqrt(x * x + y * y + height * height)); }

double solidAngle(const Seen& seen, glm::dvec2 from = {0, 0}, glm::dvec2 to = {1, 1})
{
    const glm::dvec2 low = seen.low + from * seen.size, high = seen.low + to * seen.size;
    return quadrant(high.x, high.y, seen.height) - quadrant(low.x, high.y, seen.height) - quadrant(high.x, low.y, seen.height) +
           quadrant(low.x, low.y, seen.height);
}

template <class Rising>
double bisect(double value, const Rising& rising)
{
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 45; ++i) {
        const double middle = 0.5 * (low + high);
        (rising(middle) < value ? low : high) = middle;
    }
    return low;
}

// The inverse of the distribution of shares: the strip's solid angle, then the part of a line, which is uniform in y / length.
glm::dvec2 shareOf(const Seen& seen, glm::dvec2 u)
{
    const double a = bisect(u.x * solidAngle(seen), [&seen](double share) { return solidAngle(seen, {0, 0}, {share, 1}); });
    const double x = seen.low.x + a * seen.size.x, distance = std::hypot(x, seen.height);
    const auto rise = [&seen, distance](double share) {
        const double y = seen.low.y + share * seen.size.y;
        return y / std::hypot(y, distance);
    };
    return {a, bisect(rise(0.0) + u.y * (rise(1.0) - rise(0.0)), rise)};
}

// From the foot's point to the nearest point of the rim.
double distanceToRim(const Seen& seen)
{
    const glm::dvec2 high = seen.low + seen.size;
    double nearest = 1e300;
    for (const double x : {seen.low.x, high.x}) {
        nearest = std::min(nearest, glm::length(glm::dvec3(x, std::clamp(0.0, seen.low.y, high.y), seen.height)));
    }
    for (const double y : {seen.low.y, high.y}) {
        nearest = std::min(nearest, glm::length(glm::dvec3(std::clamp(0.0, seen.low.x, high.x), y, seen.height)));
    }
    return nearest;
}

// A rectangle in a plane of any direction, seen from either side.
Case turned(Random& random, glm::dvec2 low, glm::dvec2 size, double height)
{
    const glm::dvec3 z = random.direction();
    const glm::dvec3 x = glm::normalize(glm::cross(z, random.direction())), y = glm::cross(z, x);
    const glm::dvec3 p = random.direction() * random.uniform();
    Case c{};
    c.p = vec3(p);
    c.corner = vec3(p + low.x * x + low.y * y + (random.below(2) == 0 ? height : -height) * z);
    c.x = vec3(x);
    c.y = vec3(y);
    c.size = vec2(size);
    return c;
}

// The same without rotation: no coordinate of the point is rounded.
Case upright(glm::dvec2 low, glm::dvec2 size, double height)
{
    Case c{};
    c.corner = vec3(low.x, low.y, height);
    c.x = vec3(1, 0, 0);
    c.y = vec3(0, 1, 0);
    c.size = vec2(size);
    return c;
}

Case expecting(Case c, Random& random)
{
    c.u = {random.unitFloat(), random.unitFloat()};
    const Seen seen = seenBy(c);
    const double distance = glm::length(glm::dvec3(seen.low, seen.height)) + std::max(seen.size.x, seen.size.y);
    // The solid angle changes in proportion to the height, which is rounded at the size of the distance unless the axes are the world's.
    // Near the rim the formula cancels.
    const double rounding = c.x.x == 1.0F ? 0.0 : 3e-7 * distance / seen.height;
    const double tolerance = 1e-6 + rounding + 6e-8 * distance / distanceToRim(seen);
    c.solidAngle = static_cast<float>(solidAngle(seen));
    c.tolerance = static_cast<float>(tolerance);
    c.share = vec2(shareOf(seen, glm::dvec2(c.u)));
    // Coordinates are rounded at the size of the distance. What the solid angle is off by stretches the distribution.
    c.shareTolerance = static_cast<float>(5e-7 * distance / std::min(seen.size.x, seen.size.y) + tolerance);
    return c;
}

// What is off at most, over all rounds.
struct Worst {
    double solidAngle = 0.0, share = 0.0, smallest = 7.0, largest = 0.0;
};

void raise(double& worst, double error) { worst = std::max(worst, error); }

void compare(Worst& worst, const Case& c, const Result& result)
{
    const double truth = solidAngle(seenBy(c));
    worst.smallest = std::min(worst.smallest, truth);
    raise(worst.largest, truth);
    raise(worst.solidAngle, std::abs(static_cast<double>(result.solidAngle) / truth - 1.0));
    raise(worst.share, static_cast<double>(glm::distance(result.share, c.share)));
}

template <class Make>
void expectFamily(const std::string& what, Random& random, const Make& make)
{
    std::vector<Case> cases(20000);
    Worst worst;
    for (int round = 0; round < testRounds(); ++round) {
        std::generate(cases.begin(), cases.end(), [&] { return expecting(make(), random); });
        KernelTest test(test_kernels::spherical_rectangle_test);
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        const std::vector<Result> results = test.results<Result>();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            compare(worst, cases[i], results[i]);
        }
    }
    printHardCase("H13", what + ", " + figure(worst.smallest) + " to " + figure(worst.largest) + " sr",
                  static_cast<double>(cases.size()) * testRounds(),
                  "solid angle off by " + figure(worst.solidAngle) + ", samples by " + figure(worst.share) + " of the size");
}

TEST(SphericalRectangleTest, H13AgreesWithDouble)
{
    Random random(13);
    const auto between = [&random](double low, double high) { return glm::dvec2(random.uniform(low, high), random.uniform(low, high)); };
    expectFamily("rectangles of any size", random, [&] {
        const double size = random.logUniform(1e-3, 2.0);
        return turned(random, between(-1.0, 1.0), size * between(0.5, 1.0), random.uniform(0.1, 1.0));
    });
    expectFamily("small ones", random,
                 [&] { return turned(random, between(-0.5, 0.5), 1e-3 * between(1.0, 2.0), random.uniform(0.7, 1.0)); });
    expectFamily("slivers", random, [&] {
        const double width = random.logUniform(1e-3, 1.0);
        return turned(random, between(-1.0, 1.0), random.below(2) == 0 ? glm::dvec2(1.0, width) : glm::dvec2(width, 1.0),
                      random.uniform(0.1, 1.0));
    });
    expectFamily("far ones", random,
                 [&] { return turned(random, 1e4 * between(-1.0, 1.0), 1e2 * between(0.5, 1.0), 1e4 * random.uniform(0.5, 1.0)); });
    for (const double height : {0.1, 0.01, 0.001}) {
        const std::string what = "square of 1 at " + figure(height);
        expectFamily(what + ", points over it and beside", random, [&] { return upright(between(-2.0, 1.0), {1, 1}, height); });
        expectFamily(what + ", any plane", random, [&] { return turned(random, between(-2.0, 1.0), {1, 1}, height); });
        expectFamily(what + ", points over the rim", random, [&] {
            return upright({random.uniform(-0.01, 0.01), random.uniform(-1.0, 0.0)}, {1, 1}, height);
        });
    }
}

// The solid angle is 0 in the rectangle's plane and on it, and nothing is NaN. In a plane of any direction, rounding decides the angle.
TEST(SphericalRectangleTest, H13SolidAngleIsZeroInThePlane)
{
    Random random(14);
    std::vector<Case> cases;
    const auto add = [&](Case c, float expected, float tolerance) {
        for (const float u : {0.0F, 0.25F, 0.5F, 1.0F - 0x1p-24F}) {
            c.u = {u, random.unitFloat()};
            c.solidAngle = expected;
            c.tolerance = tolerance;
            c.shareTolerance = 2.0F;
            cases.push_back(c);
        }
    };
    for (const double x : {0.0, -0.5, -1.0, -2.0, 1.0}) {
        for (const double y : {0.0, -0.5, -1.0, -2.0, 1.0}) {
            add(upright({x, y}, {1, 1}, 0.0), 0.0F, 0.0F);
            add(upright({x, y}, {0, 1}, 1.0), 0.0F, 0.0F);
            for (const double height : {0.0, 1e-30, 1e-12, 1e-7}) {
                add(upright({x, y}, {1, 1}, height), 3.1415927F, 1.000001F);
                add(turned(random, {x, y}, {1, 1}, height), 3.1415927F, 1.000001F);
            }
        }
    }
    KernelTest(test_kernels::spherical_rectangle_test).cases(cases).resultsOf<Result>(cases.size()).run();
}

// Samples of one rectangle from one point.
std::vector<Result> sample(Case c, std::uint64_t seed)
{
    Random random(seed);
    c.solidAngle = static_cast<float>(solidAngle(seenBy(c)));
    c.tolerance = 1e-4F;
    c.shareTolerance = 2.0F;
    std::vector<Case> cases(1000000, c);
    for (Case& one : cases) {
        one.u = {random.unitFloat(), random.unitFloat()};
    }
    KernelTest test(test_kernels::spherical_rectangle_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// Directions in cells of the rectangle, against the cells' solid angles.
void expectUniform(const std::string& what, const Case& c, std::uint64_t seed)
{
    constexpr int kCells = 20;
    const Seen seen = seenBy(c);
    const std::vector<Result> results = sample(c, seed);
    std::vector<double> counts(kCells * kCells, 0.0), expected(kCells * kCells, 0.0);
    for (const Result& result : results) {
        const glm::ivec2 cell = glm::min(glm::ivec2(result.share * static_cast<float>(kCells)), kCells - 1);
        ++counts[static_cast<std::size_t>(cell.y * kCells + cell.x)];
    }
    for (int i = 0; i < kCells * kCells; ++i) {
        const glm::dvec2 cell(i % kCells, i / kCells);
        expected[static_cast<std::size_t>(i)] =
            static_cast<double>(results.size()) / solidAngle(seen) *
            solidAngle(seen, cell / static_cast<double>(kCells), (cell + 1.0) / static_cast<double>(kCells));
    }
    expectCounts(what, counts, expected, 8);
}

TEST(SphericalRectangleTest, H13IsUniform)
{
    Random random(15);
    expectUniform("square over the point, .1", upright({-0.5, -0.5}, {1, 1}, 0.1), 16);
    expectUniform("square over the point, .001", upright({-0.5, -0.5}, {1, 1}, 0.001), 17);
    expectUniform("square beside the point, .01", upright({0.01, -0.3}, {1, 1}, 0.01), 18);
    expectUniform("square over a corner, .001", upright({-1.0, 0.0}, {1, 1}, 0.001), 19);
    expectUniform("square seen from afar", turned(random, {-3.0, 2.0}, {1, 1}, 4.0), 20);
    expectUniform("small square", turned(random, {-0.3, 0.2}, {2e-3, 2e-3}, 1.0), 21);
    expectUniform("sliver across", turned(random, {-0.3, 0.2}, {1.0, 1e-2}, 0.5), 22);
    expectUniform("sliver along", turned(random, {-0.3, 0.2}, {1e-2, 1.0}, 0.5), 23);
}

// Single samples of the irradiance of a square of 1 that a parallel receiver's point is under: their mean, and their deviation. Simpson's
// rule gives these deviations, in parts of the mean. At height 0 the cosines are uniform: 1/sqrt(3).
TEST(SphericalRectangleTest, H13NearSquaresAreNotNoisy)
{
    std::uint64_t seed = 24;
    for (const auto& [height, deviation] : {std::pair{1.0, 0.0433}, {0.1, 0.404}, {0.01, 0.557}, {0.001, 0.575}}) {
        const std::vector<Result> results = sample(upright({-0.5, -0.5}, {1, 1}, height), seed++);
        std::vector<double> values;
        double squares = 0.0;
        const double truth =
            computePolygonIrradiance({{-0.5, -0.5, height}, {0.5, -0.5, height}, {0.5, 0.5, height}, {-0.5, 0.5, height}}, {0, 0, 1});
        for (const Result& result : results) {
            const glm::dvec3 point(glm::dvec2(result.share) - 0.5, static_cast<double>(static_cast<float>(height)));
            values.push_back(static_cast<double>(result.solidAngle) * point.z / glm::length(point));
            squares += (values.back() / truth - 1.0) * (values.back() / truth - 1.0);
        }
        expectSampleMean("square of 1 at " + figure(height), values, truth, 4);
        const double measured = std::sqrt(squares / static_cast<double>(values.size()));
        printHardCase("H13", "square of 1 at " + figure(height), static_cast<double>(values.size()), "deviation " + figure(measured));
        EXPECT_NEAR(measured, deviation, 0.02 * deviation);
    }
}

}  // namespace glim::spherical_rectangle_test
