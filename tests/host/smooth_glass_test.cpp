// H23: which normal decides on which side of smooth glass a ray is. The renderer's rule in double, and one that asks the face's
// normal. In a ball of 80 triangles under a sky of 1, every path should bring home 1.
#include "tests/harness/random.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

using glm::dvec3;

constexpr double kIndex = 1.5;
constexpr int kBounces = 1000, kPaths = 20000;

// Fresnel's equations for unpolarised light by Snell's law; eta = index beyond / index before.
double reflectance(double cosine, double eta)
{
    const double sine2 = (1.0 - cosine * cosine) / (eta * eta);
    if (sine2 >= 1.0) {
        return 1.0;
    }
    const double t = std::sqrt(1.0 - sine2);
    const double parallel = (eta * cosine - t) / (eta * cosine + t), perpendicular = (cosine - eta * t) / (cosine + eta * t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

struct Side {
    bool outside;
    dvec3 normal;  // towards wo
};

// Both normals point outwards.
Side sideByShading(const dvec3& shading, const dvec3&, const dvec3& wo)
{
    const bool outside = glm::dot(shading, wo) > 0.0;
    return {outside, outside ? shading : -shading};
}

// If the shading normal looks away, the face's normal is taken.
Side sideByFace(const dvec3& shading, const dvec3& face, const dvec3& wo)
{
    const bool outside = glm::dot(face, wo) > 0.0;
    const double sign = outside ? 1.0 : -1.0;
    return {outside, sign * (glm::dot(sign * shading, wo) > 0.0 ? shading : face)};
}

using Rule = Side (*)(const dvec3&, const dvec3&, const dvec3&);

double traceToTheSky(const Reference& reference, const Triangles& ball, ReferenceRay ray, Rule rule, Random& random)
{
    double throughput = 1.0;
    for (int bounce = 0; bounce < kBounces; ++bounce) {
        const ReferenceHit hit = reference.closest(ray, 0.0);
        if (!std::isfinite(hit.t)) {
            return throughput;
        }
        const Triangle& triangle = ball[hit.id];
        const dvec3 v0(triangle.vertices[0]), e1 = dvec3(triangle.vertices[1]) - v0, e2 = dvec3(triangle.vertices[2]) - v0;
        const dvec3 point = ray.origin + hit.t * ray.direction, cross = glm::cross(e1, e2), wo = -ray.direction;
        const dvec3 face = glm::normalize(glm::dot(cross, v0) > 0.0 ? cross : -cross);
        // The corners are their own normals, so points are their own interpolated ones.
        const auto [outside, n] = rule(glm::normalize(point), face, wo);
        const double eta = outside ? kIndex : 1.0 / kIndex, cosine = glm::dot(wo, n);
        if (random.uniform() < reflectance(cosine, eta)) {
            ray = {point, glm::normalize(2.0 * cosine * n - wo), hit.id};
        } else {
            const double t = std::sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
            ray = {point, glm::normalize((cosine / eta - t) * n - wo / eta), hit.id};
            throughput /= eta * eta;
        }
    }
    return 0.0;
}

struct Outcome {
    double mean = 0.0;
    int lost = 0;  // paths that do not bring home 1
};

// Rays at the disk that the ball covers.
Outcome measure(Rule rule)
{
    const Triangles ball = icosphere(1);
    const Reference reference(makeTestScene(ball));
    Random random(23);
    Outcome outcome;
    for (int i = 0; i < kPaths; ++i) {
        const double r = std::sqrt(random.uniform()), phi = random.uniform(0.0, 2.0 * std::numbers::pi);
        const double value = traceToTheSky(reference, ball, {{r * std::cos(phi), r * std::sin(phi), 5.0}, {0.0, 0.0, -1.0}}, rule, random);
        outcome.mean += value / kPaths;
        outcome.lost += std::abs(value - 1.0) > 1e-9 ? 1 : 0;
    }
    return outcome;
}

TEST(SmoothGlassTest, H23ShadingNormalDecidesTheSide)
{
    const Outcome shading = measure(sideByShading), face = measure(sideByFace);
    printHardCase("H23", "glass ball of 80 triangles, by the rule alone", kPaths, "mean " + figure(shading.mean),
                  "side by the face: mean " + std::to_string(face.mean) + ", " + std::to_string(face.lost) + " paths lost");
    EXPECT_EQ(shading.lost, 0);
    EXPECT_GT(face.lost, 0);
}

}  // namespace
}  // namespace glim
