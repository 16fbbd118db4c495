#include "shaders/shared/vocabulary.h"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/harness/statistics.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

namespace glim::warp_test {

struct Case {
    vec2 u;
    vec2 disk;
};

struct Result {
    vec3 hemisphere, sphere, uniformHemisphere;
    vec2 triangle, circle;
};

// Shirley and Chiu's map by its definition: the square's concentric frames go to circles, arc length kept.
glm::dvec2 concentricDisk(glm::dvec2 u)
{
    const double a = 2.0 * u.x - 1.0, b = 2.0 * u.y - 1.0;
    if (a == 0.0 && b == 0.0) {
        return {0.0, 0.0};
    }
    const double radius = std::max(std::abs(a), std::abs(b));
    const double quarter = std::numbers::pi / 4.0;
    const double phi = std::abs(a) > std::abs(b) ? (a > 0 ? quarter * (b / a) : quarter * (4.0 + b / a))
                                                 : (b > 0 ? quarter * (2.0 - a / b) : quarter * (6.0 - a / b));
    return {radius * std::cos(phi), radius * std::sin(phi)};
}

std::vector<Result> warped(const std::vector<vec2>& points)
{
    std::vector<Case> cases;
    for (const vec2& u : points) {
        cases.push_back({u, vec2(concentricDisk(glm::dvec2(u)))});
    }
    KernelTest test(test_kernels::warp_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

// The corners and middle of the square, their neighbours, both sides of where the circle is folded, and a grid.
std::vector<vec2> hardPoints()
{
    constexpr float kBelowOne = 1.0F - 0x1p-24F;
    std::vector<vec2> points;
    for (const float x : {0.0F, 0x1p-24F, 0.5F, kBelowOne}) {
        for (const float y : {0.0F, 0x1p-24F, 0.5F, kBelowOne}) {
            points.emplace_back(x, y);
        }
    }
    for (const float seam : {0.25F, 0.75F}) {
        for (const float u : {seam, std::nextafter(seam, 0.0F), std::nextafter(seam, 1.0F)}) {
            points.emplace_back(0.5F, u);
        }
    }
    for (int i = 0; i <= 64; ++i) {
        for (int j = 0; j <= 64; ++j) {
            points.emplace_back(std::min(static_cast<float>(i) / 64.0F, kBelowOne), std::min(static_cast<float>(j) / 64.0F, kBelowOne));
        }
    }
    return points;
}

// A circle of the sphere: its height z, and its point at the turn u from -x.
glm::dvec3 onSphere(double z, double u)
{
    const double r = std::sqrt((1.0 - z) * (1.0 + z)), phi = std::numbers::pi * (2.0 * u - 1.0);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// Against sine and cosine in double, on the whole circle and on both sides of its seams.
TEST(WarpTest, CirclesAreExactAndOfUnitRadius)
{
    Random random(7);
    std::vector<vec2> points = hardPoints();
    for (int i = 0; i < 200000; ++i) {
        points.emplace_back(0.5F, random.unitFloat());
    }
    const std::vector<Result> results = warped(points);
    double worst = 0.0, worstRadius = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double phi = std::numbers::pi * (2.0 * static_cast<double>(points[i].y) - 1.0);
        const glm::dvec2 circle(results[i].circle);
        worst = std::max(worst, glm::distance(circle, glm::dvec2(std::cos(phi), std::sin(phi))));
        worstRadius = std::max(worstRadius, std::abs(glm::length(circle) - 1.0));
    }
    std::printf("  points of the circle are off by %.3g, radii by %.3g\n", worst, worstRadius);
    EXPECT_LE(worst, 2e-7);  // as warp.glsl states
    EXPECT_LE(worstRadius, 1.5e-7);
}

// The kernel compares disk, hemisphere and densities; spheres are compared here, with Archimedes' map in double.
TEST(WarpTest, H18PointsAreOnTheDiskTheSphereAndTheTriangle)
{
    const std::vector<vec2> points = hardPoints();
    const std::vector<Result> results = warped(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec2 u(points[i]);
        EXPECT_LE(glm::distance(glm::dvec3(results[i].sphere), onSphere(1.0 - 2.0 * u.x, u.y)), 3e-7) << u.x << ", " << u.y;
        EXPECT_LE(glm::distance(glm::dvec3(results[i].uniformHemisphere), onSphere(1.0 - u.x, u.y)), 3e-7) << u.x << ", " << u.y;
    }
    printHardCase("H18", "cosine hemisphere, corners and grid", static_cast<double>(points.size()), "unit within 5e-7, finite");
}

double turnOf(const vec3& v) { return 0.5 + std::atan2(static_cast<double>(v.y), static_cast<double>(v.x)) / (2.0 * std::numbers::pi); }

// Each as a point of the unit square that is uniform if the warp is right: by area of the disk under the hemisphere, height
// on the sphere and the uniform hemisphere (Archimedes), and (b1 + b2)^2 and b2 / (b1 + b2) in the triangle.
glm::dvec2 unwarpHemisphere(const Result& r)
{
    return {glm::dot(glm::dvec2(r.hemisphere), glm::dvec2(r.hemisphere)), turnOf(r.hemisphere)};
}

glm::dvec2 unwarpSphere(const Result& r) { return {0.5 - 0.5 * static_cast<double>(r.sphere.z), turnOf(r.sphere)}; }

glm::dvec2 unwarpUniformHemisphere(const Result& r)
{
    return {1.0 - static_cast<double>(r.uniformHemisphere.z), turnOf(r.uniformHemisphere)};
}

glm::dvec2 unwarpTriangle(const Result& r)
{
    const glm::dvec2 b(r.triangle);
    return {(b.x + b.y) * (b.x + b.y), b.y / (b.x + b.y)};
}

std::size_t comparisons() { return 22 * static_cast<std::size_t>(testRounds()); }

void expectUniform(const std::string& what, const std::vector<Result>& results, glm::dvec2 (*unwarp)(const Result&))
{
    for (const int rows : {10, 80}) {
        const int columns = 2 * rows;
        std::vector<double> counts(static_cast<std::size_t>(rows * columns), 0.0);
        for (const Result& result : results) {
            const glm::dvec2 u = unwarp(result);
            const int row = std::min(rows - 1, static_cast<int>(u.x * rows));
            const int column = std::min(columns - 1, static_cast<int>(u.y * columns));
            ++counts[static_cast<std::size_t>(row * columns + column)];
        }
        const std::vector<double> expected(counts.size(), static_cast<double>(results.size()) / rows / columns);
        expectCounts(what, counts, expected, comparisons());
    }
}

void expectMean(const std::string& what, const std::vector<Result>& results, double truth, const std::function<float(const Result&)>& value)
{
    std::vector<double> values(results.size());
    std::transform(results.begin(), results.end(), values.begin(),
                   [&value](const Result& result) { return static_cast<double>(value(result)); });
    expectSampleMean(what, values, truth, comparisons());
}

void expectUniformityAndMoments(const std::vector<Result>& results)
{
    expectUniform("cosine hemisphere", results, unwarpHemisphere);
    expectUniform("sphere", results, unwarpSphere);
    expectUniform("uniform hemisphere", results, unwarpUniformHemisphere);
    expectUniform("triangle", results, unwarpTriangle);
    expectMean("hemisphere x", results, 0.0, [](const Result& r) { return r.hemisphere.x; });
    expectMean("hemisphere y", results, 0.0, [](const Result& r) { return r.hemisphere.y; });
    expectMean("hemisphere z", results, 2.0 / 3.0, [](const Result& r) { return r.hemisphere.z; });
    expectMean("hemisphere z^2", results, 0.5, [](const Result& r) { return r.hemisphere.z * r.hemisphere.z; });
    expectMean("uniform hemisphere x", results, 0.0, [](const Result& r) { return r.uniformHemisphere.x; });
    expectMean("uniform hemisphere y", results, 0.0, [](const Result& r) { return r.uniformHemisphere.y; });
    expectMean("uniform hemisphere z", results, 0.5, [](const Result& r) { return r.uniformHemisphere.z; });
    expectMean("uniform hemisphere z^2", results, 1.0 / 3.0, [](const Result& r) { return r.uniformHemisphere.z * r.uniformHemisphere.z; });
    expectMean("sphere x", results, 0.0, [](const Result& r) { return r.sphere.x; });
    expectMean("sphere y", results, 0.0, [](const Result& r) { return r.sphere.y; });
    expectMean("sphere z", results, 0.0, [](const Result& r) { return r.sphere.z; });
    expectMean("sphere z^2", results, 1.0 / 3.0, [](const Result& r) { return r.sphere.z * r.sphere.z; });
    expectMean("triangle b1", results, 1.0 / 3.0, [](const Result& r) { return r.triangle.x; });
    expectMean("triangle b1 b2", results, 1.0 / 12.0, [](const Result& r) { return r.triangle.x * r.triangle.y; });
}

TEST(WarpTest, KeepsUniformityAndMoments)
{
    for (int round = 0; round < testRounds(); ++round) {
        Random random(static_cast<std::uint64_t>(round) + 100);
        std::vector<vec2> points(1000000);
        std::generate(points.begin(), points.end(), [&random] { return vec2(random.unitFloat(), random.unitFloat()); });
        expectUniformityAndMoments(warped(points));
    }
}

}  // namespace glim::warp_test
