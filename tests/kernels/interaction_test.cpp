#include "test_kernels.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

namespace glim::interaction_test {

struct Result {
    PathHit hit;
    vec3 point, errorBound, ng, ns;
    uint front, material, light;
    vec3 emitted;
};

using glm::dvec3;

constexpr double kUlp = 0x1p-24;  // half an ulp of 1
constexpr std::uint32_t kFlat = 0, kSmooth = 1, kRound = 2;

class SurfaceTest : public testing::TestWithParam<float> {
protected:
    double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }
    dvec3 direction()
    {
        std::normal_distribution<double> normal;
        const double x = normal(random_), y = normal(random_);
        return glm::normalize(dvec3(x, y, normal(random_)));
    }

    // Flat triangles, smooth ones whose normals lean away by up to some 70 degrees and that emit from their fronts, and spheres
    // that emit from both sides.
    Scene makeScene(float shift)
    {
        std::vector<Sphere> spheres = randomSpheres(40, 0.2F, 3);
        for (Sphere& sphere : spheres) {
            sphere.center += shift;
            sphere.material = kRound;
        }
        Scene scene = makeTestScene(placed(randomTriangles(150, 0.3F, 1), 1.0F, shift), spheres);
        scene.materials.resize(3);
        scene.showsBackFaces = true;
        scene.materials[kSmooth].emission = glm::vec3(1.0F, 0.5F, 0.25F);
        scene.materials[kRound].emission = glm::vec3(0.0F, 3.0F, 7.0F);
        scene.materials[kRound].doubleSided = true;
        const Triangles smooth = placed(randomTriangles(150, 0.3F, 2), 1.0F, shift);
        std::vector<glm::vec3> normals;
        for (const Triangle& t : smooth) {
            for (int v = 0; v < 3; ++v) {
                normals.emplace_back(glm::normalize(normalOf(t) + 0.9 * direction()));
            }
        }
        addMesh(scene, smooth, kSmooth, normals);
        return scene;
    }

    static dvec3 normalOf(const Triangle& t)
    {
        const dvec3 a(t.vertices[0]), b(t.vertices[1]), c(t.vertices[2]);
        return glm::normalize(glm::cross(b - a, c - a));
    }

    // Aimed at primitives from all sides; a quarter of them grazing.
    std::vector<PathRay> makeRays(const Triangles& triangles, float shift)
    {
        std::vector<PathRay> rays;
        for (int i = 0; i < 20000; ++i) {
            const std::size_t id = random_() % triangles.size();
            const Triangle& t = triangles[id];
            const double u = 0.5 * uniform(), v = 0.5 * uniform();
            const dvec3 a(t.vertices[0]);
            const dvec3 target = a + u * (dvec3(t.vertices[1]) - a) + v * (dvec3(t.vertices[2]) - a);
            dvec3 towards = direction();
            if (i % 4 == 0) {
                const dvec3 n = normalOf(t);
                towards = glm::normalize(glm::cross(n, towards) + 0.03 * (uniform() - 0.5) * n);
            }
            const dvec3 from = i % 3 == 0 ? dvec3(shift) + 0.5 * direction() : target - 0.3 * towards;
            rays.push_back({glm::vec3(from), kNoPrimitive, glm::vec3(i % 3 == 0 ? direction() : towards)});
        }
        return rays;
    }

    void checkTriangle(const Primitives& primitives, std::uint32_t id, const PathRay& ray, const Result& r);
    void checkSphere(const Sphere& sphere, const PathRay& ray, const Result& r);
    void checkEmission(const Material& material, const Result& r);
    void checkSides(const dvec3& normal, const dvec3& shading, const PathRay& ray, const Result& r, double slack);

    std::mt19937 random_{11};
    std::size_t smoothed_ = 0, gaveWay_ = 0, spheres_ = 0, triangles_ = 0;
    std::size_t darkBacks_ = 0, brightBacks_ = 0, brightFronts_ = 0;
};

// |error| <= bound on each axis.
void expectWithin(const dvec3& error, const vec3& bound)
{
    for (int k = 0; k < 3; ++k) {
        EXPECT_LE(std::abs(error[k]), static_cast<double>(bound[k])) << "axis " << k;
    }
}

// `normal` and `shading` as the scene has them, on the front.
void SurfaceTest::checkSides(const dvec3& normal, const dvec3& shading, const PathRay& ray, const Result& r, double slack)
{
    const dvec3 wo = -dvec3(ray.direction);
    const double cosine = glm::dot(normal, wo);
    if (std::abs(cosine) < slack) {
        return;  // rounding decides which side is seen
    }
    const double side = cosine > 0.0 ? 1.0 : -1.0;
    EXPECT_EQ(r.front, cosine > 0.0 ? 1U : 0U);
    EXPECT_LE(glm::length(dvec3(r.ng) - side * normal), slack);
    const double shadingCosine = side * glm::dot(shading, wo);
    if (std::abs(shadingCosine) > slack) {
        const bool kept = shadingCosine > 0.0;
        EXPECT_LE(glm::length(dvec3(r.ns) - side * (kept ? shading : normal)), slack);
        gaveWay_ += kept ? 0 : 1;
    }
}

void SurfaceTest::checkTriangle(const Primitives& primitives, std::uint32_t id, const PathRay& ray, const Result& r)
{
    const Triangle& t = primitives.triangles[id];
    const dvec3 a(t.vertices[0]), e1 = dvec3(t.vertices[1]) - a, e2 = dvec3(t.vertices[2]) - a;
    const double b1 = static_cast<double>(r.hit.barycentric.x), b2 = static_cast<double>(r.hit.barycentric.y);
    const dvec3 point(r.point), n = normalOf(t);
    const double longest = std::max({glm::length(e1), glm::length(e2), glm::length(e1 - e2)});
    // The cross product's roundings, 4 of a product of two edges, over its length.
    const double slack = 1e-6 + 8.0 * kUlp * longest * longest / glm::length(glm::cross(e1, e2));
    {
        SCOPED_TRACE("point of the barycentrics");
        expectWithin(point - (a + b1 * e1 + b2 * e2), r.errorBound);
    }
    EXPECT_LE(std::abs(glm::dot(n, point - a)), glm::dot(glm::abs(n), dvec3(r.errorBound)));
    // The ray's point, where the triangle is no sliver and is not grazed: weights are for the right vertices.
    const double grazing = std::abs(glm::dot(n, dvec3(ray.direction)));
    if (slack < 1e-5 && grazing > 0.1) {
        const double reach = glm::length(dvec3(ray.origin)) + 1.0;
        const dvec3 onRay = dvec3(ray.origin) + static_cast<double>(r.hit.t) * dvec3(ray.direction);
        EXPECT_LE(glm::length(point - onRay), 100.0 * kUlp * reach);
    }
    dvec3 shading = n;
    if (primitives.findInstance(id) == kSmooth) {
        const glm::uvec3 m = primitives.vertexIndices[id];
        const auto normal = [&](int v) { return dvec3(primitives.vertexNormals[m[v]]); };
        shading = glm::normalize((1.0 - b1 - b2) * normal(0) + b1 * normal(1) + b2 * normal(2));
        ++smoothed_;
    }
    checkSides(n, shading, ray, r, slack);
    ++triangles_;
}

void SurfaceTest::checkSphere(const Sphere& sphere, const PathRay& ray, const Result& r)
{
    const dvec3 outward = dvec3(r.point) - dvec3(sphere.center);
    const dvec3 n = glm::normalize(outward);
    const double bound = glm::dot(glm::abs(n), dvec3(r.errorBound));
    EXPECT_LE(std::abs(glm::length(outward) - static_cast<double>(sphere.radius)), bound);
    // The normal is the one of the unrounded point.
    const double slack = 1e-6 + glm::length(dvec3(r.errorBound)) / static_cast<double>(sphere.radius);
    checkSides(n, n, ray, r, slack);
    ++spheres_;
}

void SurfaceTest::checkEmission(const Material& material, const Result& r)
{
    const bool front = r.front != 0, emits = material.emission != glm::vec3(0.0F);
    EXPECT_EQ(r.emitted, front || material.doubleSided ? material.emission : glm::vec3(0.0F));
    brightFronts_ += emits && front ? 1 : 0;
    brightBacks_ += emits && !front && material.doubleSided ? 1 : 0;
    darkBacks_ += emits && !front && !material.doubleSided ? 1 : 0;
}

TEST_P(SurfaceTest, IsTheOneOfTheScene)
{
    const Scene scene = makeScene(GetParam());
    const SceneOnDevice onDevice(scene);
    const std::vector<PathRay> rays = makeRays(onDevice.primitives.triangles, GetParam());
    KernelTest test = onDevice.test(test_kernels::interaction_test);
    test.cases(rays).resultsOf<Result>(rays.size()).run();
    const std::vector<Result> results = test.results<Result>();
    for (std::size_t i = 0; i < rays.size() && !HasFailure(); ++i) {
        SCOPED_TRACE("ray " + std::to_string(i));
        const Result& r = results[i];
        const std::uint32_t id = onDevice.idOf(r.hit.primitiveRef);
        if (id == kNoPrimitive) {
            continue;
        }
        const bool isTriangle = id < onDevice.primitives.triangles.size();
        EXPECT_EQ(r.material, isTriangle ? (id < 150 ? kFlat : kSmooth) : kRound);
        EXPECT_EQ(r.light > 0, r.material != kFlat);
        if (r.light > 0) {
            EXPECT_EQ(onDevice.flat.lights[r.light - 1].primitive, id);
        }
        checkEmission(scene.materials[r.material], r);
        if (isTriangle) {
            checkTriangle(onDevice.primitives, id, rays[i], r);
        } else {
            checkSphere(scene.spheres[id - onDevice.primitives.triangles.size()], rays[i], r);
        }
    }
    std::cout << triangles_ << " hits of triangles (" << smoothed_ << " smooth), " << spheres_ << " of spheres, " << gaveWay_
              << " shading normals looked away; emission seen from " << brightFronts_ << " fronts and " << brightBacks_
              << " backs, not from " << darkBacks_ << " backs\n";
    EXPECT_GT(triangles_, 5000U);
    EXPECT_GT(spheres_, 500U);
    EXPECT_GT(gaveWay_, 100U);
    EXPECT_GT(std::min({brightFronts_, brightBacks_, darkBacks_}), 100U);
}

INSTANTIATE_TEST_SUITE_P(Shifts, SurfaceTest, testing::Values(0.0F, 100.0F));

// Where the three normals cancel, the flat one is taken.
TEST(SurfaceNormalTest, FallsBackToTheFlatOne)
{
    Scene scene = makeTestScene({});
    const glm::vec3 up(0, 0, 1);
    addMesh(scene, {{{glm::vec3(-1, -1, 0), glm::vec3(1, -1, 0), glm::vec3(0, 1, 0)}}}, 0, {up, -up, up});
    const SceneOnDevice onDevice(scene);
    // The weight of the second vertex is 1/2 there, exactly.
    const std::vector<PathRay> rays = {{glm::vec3(0.25F, -0.5F, 1.0F), kNoPrimitive, -up}};
    KernelTest test = onDevice.test(test_kernels::interaction_test);
    test.cases(rays).resultsOf<Result>(1).run();
    const Result result = test.results<Result>()[0];
    EXPECT_EQ(result.hit.barycentric.x, 0.5F);
    EXPECT_EQ(result.ns, up);
}

}  // namespace glim::interaction_test
