#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/irradiance_formulas.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glim::spherical_triangle_test {

struct Case {
    vec3 p, v0, e1, e2;
    vec2 u;
    float solidAngle, tolerance;
    vec2 weights;
    float weightsTolerance;
};

struct Result {
    float solidAngle;
    vec2 weights;
};

using Corners = std::array<glm::dvec3, 3>;  // relative to the point

Corners cornersOf(const Case& c)
{
    const glm::dvec3 v0 = glm::dvec3(c.v0) - glm::dvec3(c.p);
    return {v0, v0 + glm::dvec3(c.e1), v0 + glm::dvec3(c.e2)};
}

glm::dvec3 pointOf(const Corners& v, glm::dvec2 weights) { return v[0] + weights.x * (v[1] - v[0]) + weights.y * (v[2] - v[0]); }

// Van Oosterom and Strackee. H12AgreesWithKnownSolidAngles compares with angles known on paper.
double solidAngle(const Corners& v)
{
    const double a = glm::length(v[0]), b = glm::length(v[1]), c = glm::length(v[2]);
    const double numerator = std::abs(glm::dot(v[0], glm::cross(v[1] - v[0], v[2] - v[0])));
    return 2.0 * std::atan2(numerator, a * b * c + glm::dot(v[0], v[1]) * c + glm::dot(v[1], v[2]) * a + glm::dot(v[0], v[2]) * b);
}

double oneMinusCosine(const glm::dvec3& a, const glm::dvec3& b)
{
    const double lengths = glm::length(a) * glm::length(b), product = glm::dot(a, b);
    const glm::dvec3 normal = glm::cross(a, b);
    return (product > 0.0 ? glm::dot(normal, normal) / (lengths + product) : lengths - product) / lengths;
}

// Where Arvo's map takes a sample from: the solid angle of v0, v1 and a point of v0 v2, and the cosine along the arc from v1 to that point.
struct Arc {
    double share, along;
};

glm::dvec2 weightsOf(const Arc& arc) { return {1.0 - arc.along, arc.along * arc.share}; }

double partOfAngle(const Corners& v, double share) { return solidAngle({v[0], v[1], pointOf(v, {0, share})}) / solidAngle(v); }

double partOfArc(const Corners& v, const Arc& arc)
{
    return oneMinusCosine(v[1], pointOf(v, weightsOf(arc))) / oneMinusCosine(v[1], pointOf(v, {0, arc.share}));
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

Arc arcOf(const Corners& v, glm::dvec2 u)
{
    const double share = bisect(u.x, [&v](double middle) { return partOfAngle(v, middle); });
    return {share, bisect(u.y, [&v, share](double middle) { return partOfArc(v, {share, middle}); })};
}

Case makeCase(const glm::dvec3& p, const glm::dvec3& v0, const glm::dvec3& e1, const glm::dvec3& e2)
{
    Case c{};
    c.p = vec3(p);
    c.v0 = vec3(v0);
    c.e1 = vec3(e1);
    c.e2 = vec3(e2);
    return c;
}

// The triangle (0, 0), (1, 0), (.25, 1) at a height over the point whose foot is `foot`: no coordinate is rounded but the foot's.
Case upright(glm::dvec2 foot, double height) { return makeCase({}, {-foot, height}, {1, 0, 0}, {0.25, 1, 0}); }

struct Errors {
    double rounding;  // 1, or 0 where the height over the plane is exact
    double shift;     // of samples, in parts of the triangle
};

Case expecting(Case c, Random& random, const Errors& errors)
{
    c.u = {random.unitFloat(), random.unitFloat()};
    const Corners v = cornersOf(c);
    const glm::dvec3 e1 = v[1] - v[0], e2 = v[2] - v[0], normal = glm::cross(e1, e2);
    const double distance = std::max({glm::length(v[0]), glm::length(v[1]), glm::length(v[2])});
    const double height = std::abs(glm::dot(v[0], normal)) / glm::length(normal);
    const double flatness = glm::length(e1) * glm::length(e2) / glm::length(normal);
    const double angle = solidAngle(v), lengths = glm::length(v[0]) * glm::length(v[1]) * glm::length(v[2]);
    const double numerator = std::abs(glm::dot(v[0], normal)), denominator = numerator / std::tan(0.5 * angle);
    // The angle changes in proportion to the height, which is rounded at the size of the distance, and the normal of a sliver is rounded
    // more. The denominator is a sum of four products of
    // three rounded factors: 12 roundings at the size of its terms.
    const double tolerance = 1e-6 + errors.rounding * 2e-7 * flatness * distance / height +
                             24 * 0x1p-24 * lengths * numerator / (numerator * numerator + denominator * denominator) / angle;
    c.solidAngle = static_cast<float>(angle);
    c.tolerance = static_cast<float>(tolerance);
    c.weights = vec2(weightsOf(arcOf(v, glm::dvec2(c.u))));
    c.weightsTolerance = static_cast<float>(errors.shift);
    return c;
}

// What is off at most, over all rounds.
struct Worst {
    double solidAngle = 0.0, weights = 0.0, distribution = 0.0, beyond = 0.0, smallest = 7.0, largest = 0.0;
};

void raise(double& worst, double error) { worst = std::max(worst, error); }

void compare(Worst& worst, const Case& c, const Result& result)
{
    const Corners v = cornersOf(c);
    const double truth = solidAngle(v);
    worst.smallest = std::min(worst.smallest, truth);
    raise(worst.largest, truth);
    raise(worst.solidAngle, std::abs(static_cast<double>(result.solidAngle) / truth - 1.0));
    raise(worst.weights, static_cast<double>(glm::distance(result.weights, c.weights)));
    // Rounded weights do not tell the arc of a sample next to v1.
    const double along = 1.0 - static_cast<double>(result.weights.x);
    if (along > 0.1) {
        const Arc arc{static_cast<double>(result.weights.y) / along, along};
        const double off = std::max(std::abs(partOfAngle(v, arc.share) - static_cast<double>(c.u.x)),
                                    std::abs(partOfArc(v, arc) - static_cast<double>(c.u.y)));
        raise(worst.distribution, off);
        raise(worst.beyond, off - static_cast<double>(c.tolerance));  // it is stretched by what the solid angle is off by
    }
}

template <class Make>
void expectFamily(const std::string& what, Random& random, const Errors& errors, const Make& make)
{
    std::vector<Case> cases(20000);
    Worst worst;
    for (int round = 0; round < testRounds(); ++round) {
        std::generate(cases.begin(), cases.end(), [&] { return expecting(make(), random, errors); });
        KernelTest test(test_kernels::spherical_triangle_test);
        test.cases(cases).resultsOf<Result>(cases.size()).run();
        const std::vector<Result> results = test.results<Result>();
        for (std::size_t i = 0; i < cases.size(); ++i) {
            compare(worst, cases[i], results[i]);
        }
    }
    printHardCase("H12", what + ", " + figure(worst.smallest) + " to " + figure(worst.largest) + " sr",
                  static_cast<double>(cases.size()) * testRounds(),
                  "solid angle off by " + figure(worst.solidAngle) + ", samples by " + figure(worst.weights) +
                      " of the size, their distribution by " + figure(worst.distribution));
    EXPECT_LE(worst.beyond, 1e-3);
}

TEST(SphericalTriangleTest, H12AgreesWithDouble)
{
    Random random(12);
    const auto edge = [&random](double size) { return size * random.normalVector(); };
    for (const double low : {1e-1, 1e-2, 1e-3, 1e-4}) {
        expectFamily("triangles down to " + figure(low) + " of the distance", random, {1.0, 2e-5}, [&] {
            const double size = random.logUniform(low, 10.0 * low);
            return makeCase(random.direction(), {}, edge(size), edge(size));
        });
    }
    expectFamily("slivers", random, {1.0, 1e-3}, [&] {
        const glm::dvec3 e1 = edge(1.0);
        return makeCase(random.direction(), {}, e1, e1 * random.uniform(0.2, 1.5) + edge(random.logUniform(1e-3, 1e-1)));
    });
    expectFamily("slivers with a short edge", random, {1.0, 1e-3}, [&] {
        const glm::dvec3 e1 = edge(1.0), e2 = edge(random.logUniform(1e-3, 1e-1));
        return random.below(2) == 0 ? makeCase(random.direction(), {}, e1, e2) : makeCase(random.direction(), {}, e2, e1);
    });
    expectFamily("far ones", random, {1.0, 1e-5}, [&] { return makeCase(1e5 * random.direction(), {}, edge(1e2), edge(1e2)); });
    for (const double height : {0.1, 0.01, 0.001}) {
        const std::string what = "triangle of 1 at " + figure(height);
        expectFamily(what + ", points over it and beside", random, {0.0, 1e-3}, [&] {
            return upright({random.uniform(-1.0, 2.0), random.uniform(-1.0, 2.0)}, height);
        });
        expectFamily(what + ", points over the rim", random, {0.0, 2.0}, [&] {
            const std::array<glm::dvec2, 4> corners{{{0, 0}, {1, 0}, {0.25, 1}, {0, 0}}};
            const std::size_t side = random.below(3);
            return upright(glm::mix(corners[side], corners[side + 1], random.uniform()), height);
        });
    }
}

// A face of the octahedron, half a face of the cube and a face of the tetrahedron, each from the centre.
TEST(SphericalTriangleTest, H12AgreesWithKnownSolidAngles)
{
    Random random(13);
    std::vector<Case> cases{makeCase({}, {1, 0, 0}, {-1, 1, 0}, {-1, 0, 1}), makeCase({}, {-1, -1, 1}, {2, 0, 0}, {2, 2, 0}),
                            makeCase({}, {1, 1, 1}, {0, -2, -2}, {-2, 0, -2})};
    const std::array<double, 3> fractions{8.0, 12.0, 4.0};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const double truth = 4.0 * std::numbers::pi / fractions[i];
        cases[i] = expecting(cases[i], random, {0.0, 1e-6});
        EXPECT_NEAR(solidAngle(cornersOf(cases[i])), truth, 1e-14);
        cases[i].solidAngle = static_cast<float>(truth);
        cases[i].tolerance = 5e-7F;
    }
    KernelTest(test_kernels::spherical_triangle_test).cases(cases).resultsOf<Result>(cases.size()).run();
}

// The solid angle is 0 in the triangle's plane and on it, and nothing is NaN. In a plane of any direction, rounding decides the angle.
TEST(SphericalTriangleTest, H12SolidAngleIsZeroInThePlane)
{
    Random random(14);
    std::vector<Case> cases;
    const auto add = [&](Case c, float expected, float tolerance) {
        for (const float u : {0.0F, 0.25F, 0.5F, 1.0F - 0x1p-24F}) {
            c.u = {u, random.unitFloat()};
            c.solidAngle = expected;
            c.tolerance = tolerance;
            c.weightsTolerance = 2.0F;
            cases.push_back(c);
        }
    };
    for (const double x : {-0.5, 0.0, 0.25, 0.5, 0.75, 1.0, 2.0}) {
        for (const double y : {-0.5, 0.0, 0.25, 0.5, 1.0, 2.0}) {
            add(upright({x, y}, 0.0), 0.0F, 0.0F);
            add(makeCase({x, y, 1}, {}, {1, 0, 0}, {2, 0, 0}), 0.0F, 0.0F);
            add(makeCase({x, y, 1}, {}, {1, 0, 0}, {0, 0, 0}), 0.0F, 0.0F);
            for (const double height : {1e-30, 1e-12, 1e-7}) {
                add(upright({x, y}, height), 3.1415927F, 1.000001F);
            }
            const glm::dvec3 v0 = random.direction(), e1 = random.normalVector(), e2 = random.normalVector();
            add(makeCase(v0 + x * e1 + y * e2, v0, e1, e2), 3.1415927F, 1.000001F);
        }
    }
    KernelTest(test_kernels::spherical_triangle_test).cases(cases).resultsOf<Result>(cases.size()).run();
}

// Samples of one triangle from one point.
std::vector<Result> sample(Case c, std::uint64_t seed)
{
    Random random(seed);
    c.solidAngle = static_cast<float>(solidAngle(cornersOf(c)));
    c.tolerance = 1e-4F;
    c.weightsTolerance = 2.0F;
    std::vector<Case> cases(1000000, c);
    for (Case& one : cases) {
        one.u = {random.unitFloat(), random.unitFloat()};
    }
    KernelTest test(test_kernels::spherical_triangle_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// The triangle in kSide^2 smaller ones of its shape. Those that point upwards are on the diagonal and below.
constexpr int kSide = 20;

std::size_t cellOf(vec2 weights)
{
    const vec2 scaled = weights * static_cast<float>(kSide);
    const int x = std::min(kSide - 1, static_cast<int>(scaled.x)), y = std::min(kSide - 1 - x, static_cast<int>(scaled.y));
    const bool down = scaled.x - static_cast<float>(x) + scaled.y - static_cast<float>(y) > 1.0F && x + y < kSide - 1;
    return static_cast<std::size_t>((y * kSide + x) * 2 + (down ? 1 : 0));
}

double cellAngle(const Corners& v, int x, int y, bool down)
{
    if (x + y + (down ? 1 : 0) > kSide - 1) {
        return 0.0;
    }
    const auto corner = [&](int i, int j) { return pointOf(v, glm::dvec2(x + i, y + j) / static_cast<double>(kSide)); };
    return solidAngle({down ? corner(1, 1) : corner(0, 0), corner(1, 0), corner(0, 1)});
}

void expectUniform(const std::string& what, const Case& c, std::uint64_t seed)
{
    const Corners v = cornersOf(c);
    const std::vector<Result> results = sample(c, seed);
    std::vector<double> counts(kSide * kSide * 2, 0.0), expected;
    for (const Result& result : results) {
        ++counts[cellOf(result.weights)];
    }
    for (int i = 0; i < kSide * kSide * 2; ++i) {
        expected.push_back(static_cast<double>(results.size()) / solidAngle(v) * cellAngle(v, i / 2 % kSide, i / 2 / kSide, i % 2 == 1));
    }
    expectCounts(what, counts, expected, 7);
}

TEST(SphericalTriangleTest, H12IsUniform)
{
    expectUniform("triangle over the point, .1", upright({0.4, 0.3}, 0.1), 15);
    expectUniform("triangle over the point, .001", upright({0.4, 0.3}, 0.001), 16);
    expectUniform("triangle beside the point, .01", upright({-0.01, 0.3}, 0.01), 17);
    expectUniform("triangle seen from afar", makeCase({3, -2, 4}, {}, {1, 0.3, 0.2}, {-0.2, 0.8, 0.5}), 18);
    expectUniform("small triangle", makeCase({0.3, -0.2, 1}, {}, {1e-3, 3e-4, 2e-4}, {-2e-4, 8e-4, 5e-4}), 19);
    expectUniform("sliver across", makeCase({0.3, -0.2, 1}, {}, {1, 0, 0}, {0, 1e-3, 0}), 20);
    expectUniform("sliver along", makeCase({0.3, -0.2, 1}, {}, {0, 1e-3, 0}, {1, 0, 0}), 21);
}

TEST(SphericalTriangleTest, H12HasTheIrradianceOfAPolygon)
{
    std::uint64_t seed = 22;
    for (const double height : {1.0, 0.1, 0.01, 0.001}) {
        const Case c = upright({0.4, 0.3}, height);
        const Corners v = cornersOf(c);
        std::vector<double> values;
        for (const Result& result : sample(c, seed++)) {
            const glm::dvec3 point = pointOf(v, glm::dvec2(result.weights));
            values.push_back(static_cast<double>(result.solidAngle) * point.z / glm::length(point));
        }
        expectSampleMean("triangle at " + figure(height), values, computePolygonIrradiance({v.begin(), v.end()}, {0, 0, 1}), 4);
    }
}

}  // namespace glim::spherical_triangle_test
