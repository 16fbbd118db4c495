// Whole pictures whose answer is known on paper. The T-numbers are those of tests/MEASUREMENTS.md.
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::vec3 kRho(0.8F, 0.5F, 0.2F);

// A camera that sees a spot of the floor y = 0 around the origin, 2 mm wide: small enough that a formula at the point is the
// pixel's value (the second derivative of what is tested, times 1e-6).
void lookAtFloor(SceneBuilder& builder) { builder.orthographic({0.03F, 0.05F, 0.02F}, {0, 0, 0}, 1e-3F); }

SceneBuilder floorScene()
{
    SceneBuilder builder;
    const auto floor = builder.lambert(kRho);
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, floor);
    lookAtFloor(builder);
    return builder;
}

// One bounce: the radiance that the floor reflects of irradiance E.
glm::dvec3 reflected(const glm::dvec3& irradiance) { return glm::dvec3(kRho) * irradiance / kPi; }

RenderSettings direct(std::uint32_t spp)
{
    RenderSettings settings = squareSettings(128, samplesFor(spp));
    settings.bounces = 1;
    return settings;
}

TEST(TruthTest, T1ConvexLambertObjectUnderAConstantSky)
{
    const glm::vec3 sky(1.0F, 2.0F, 4.0F);
    SceneBuilder ball, box;
    ball.sphere({0, 0, 0}, 1.0F, ball.lambert(kRho)).environment(sky).perspective({0, 0, 5}, {0, 0, 0}, 0.2F);
    box.cube(1.0F, box.lambert(kRho), false).environment(sky).perspective({3, 4, 5}, {0, 0, 0}, 0.1F);
    for (const SceneBuilder* builder : {&ball, &box}) {
        expectEverywhere(renderScene(builder->scene(), squareSettings(64, 64)), glm::dvec3(kRho * sky), 2);
    }
}

class FurnaceTest : public testing::TestWithParam<float> {};

// T2, T3: a closed room whose walls all emit e and reflect a: e (1 - a^(k+1)) / (1 - a) after k bounces.
TEST_P(FurnaceTest, H25T2T3ClosedRoom)
{
    const double a = static_cast<double>(GetParam());
    SceneBuilder builder;
    builder.cube(1.0F, builder.lambert(glm::vec3(GetParam()), glm::vec3(1.0F, 2.0F, 0.5F)), true)
        .perspective({0.3F, 0.2F, 0.6F}, {-1, -0.5F, -1}, 1.0F);
    for (const std::uint32_t bounces : {0U, 1U, 2U, 5U, 1000U}) {
        RenderSettings settings = squareSettings(96, samplesFor(64));
        settings.bounces = bounces;
        const double truth = (1.0 - std::pow(a, bounces + 1.0)) / (1.0 - a);
        expectMean("T2/T3 albedo " + std::to_string(a) + ", bounces " + std::to_string(bounces), renderScene(builder.scene(), settings),
                   truth * glm::dvec3(1.0, 2.0, 0.5));
    }
}

INSTANTIATE_TEST_SUITE_P(Albedos, FurnaceTest, testing::Values(0.5F, 0.9F));

TEST(TruthTest, T5GlassUnderAConstantSkyVanishes)
{
    SceneBuilder builder;
    const auto glass = builder.glass(1.5F);
    builder.sphere({0, 0, 0}, 1.0F, glass).sphere({0.8F, 0.9F, -2.0F}, 0.7F, glass).environment({1.0F, 2.0F, 4.0F});
    builder.perspective({0, 0, 5}, {0, 0, 0}, 0.6F);
    RenderSettings settings = squareSettings(96, 64);
    settings.bounces = 1000;
    // Every path ends in the sky with the throughput it began with, up to the rounding of eta^2 on each crossing.
    expectEverywhere(renderScene(builder.scene(), settings), {1.0, 2.0, 4.0}, 8);
}

// H23: normals up to 20 degrees off the faces neither trap light in glass nor make any.
TEST(TruthTest, H23SmoothGlassUnderAConstantSkyVanishes)
{
    SceneBuilder builder;
    builder.glass(1.5F);
    builder.environment(glm::vec3(1.0F)).perspective({0, 0, 5}, {0, 0, 0}, 0.4F);  // silhouettes too
    Scene scene = builder.scene();
    addMesh(scene, icosphere(1), 0, listVertices(icosphere(1)));
    RenderSettings settings = squareSettings(48, samplesFor(64));
    settings.bounces = 1000;
    expectEverywhere(renderScene(scene, settings), glm::dvec3(1.0), 8);
}

// H16: no sample has noise, but the patch has a gradient, which its mean has not.
void expectExactMean(const Film& film, const glm::dvec3& truth)
{
    const glm::dvec3 error = glm::abs(meanOf(film).mean - truth) / truth;
    EXPECT_LE(std::max({error.r, error.g, error.b}), 1e-5);
}

TEST(TruthTest, H16T9PointDirectionalAndSpotLight)
{
    const glm::dvec3 position(0.5, 2.0, -0.7);
    const double distance2 = glm::dot(position, position), cosine = position.y / std::sqrt(distance2);
    const glm::dvec3 down = -position / std::sqrt(distance2);
    PunctualLight light{"", PunctualLight::Kind::Point, glm::vec3(position), glm::vec3(down), glm::vec3(3, 5, 7), 0.05F, 0.1F};
    const glm::dvec3 fromPoint = reflected(glm::dvec3(3, 5, 7) * cosine / distance2);
    expectExactMean(renderScene(floorScene().light(light).scene(), direct(32)), fromPoint);
    light.range = 1.5F * static_cast<float>(std::sqrt(distance2));
    expectExactMean(renderScene(floorScene().light(light).scene(), direct(32)), fromPoint * (1.0 - 16.0 / 81.0));
    light.range = 0.0F;
    light.kind = PunctualLight::Kind::Spot;
    expectExactMean(renderScene(floorScene().light(light).scene(), direct(32)), fromPoint);
    light.kind = PunctualLight::Kind::Directional;
    expectEverywhere(renderScene(floorScene().light(light).scene(), direct(32)), reflected(glm::dvec3(3, 5, 7) * cosine), 2);
}

// T10, T10b (Snyder 1996; Lagarde and de Rousiers 2014): a sphere of radius r at distance d, its centre at angle of cosine c
// to the normal.
glm::dvec3 sphereIrradiance(double r, double d, double c, const glm::dvec3& radiance)
{
    const double h = d / r;
    if (c * h >= 1.0) {
        return kPi * radiance * (r / d) * (r / d) * c;
    }
    const double s = std::sqrt(1.0 - c * c), x = std::sqrt(h * h - 1.0), y = -x * c / s;
    return radiance * ((c * std::acos(y) - x * s * std::sqrt(1.0 - y * y)) / (h * h) + std::atan(s * std::sqrt(1.0 - y * y) / x));
}

TEST(TruthTest, T10SphereLight)
{
    const glm::vec3 radiance(6, 4, 2);
    for (const auto& [center, radius] :
         {std::pair{glm::vec3(0.6F, 1.5F, -0.4F), 0.5F}, {glm::vec3(2.0F, 0.2F, 0.5F), 0.5F}, {glm::vec3(-0.3F, 3.0F, 1.0F), 0.001F}}) {
        SceneBuilder builder;
        // No floor but a small patch, so that it does not hide the part of the light below the horizon from itself.
        const auto patch = builder.lambert(kRho);
        builder.quad({glm::vec3(-0.1F, 0, 0.1F), {0.1F, 0, 0.1F}, {0.1F, 0, -0.1F}, {-0.1F, 0, -0.1F}}, patch);
        lookAtFloor(builder);
        builder.sphere(center, radius, builder.lambert(glm::vec3(0.0F), radiance));
        const double d = glm::length(glm::dvec3(center));
        const double c = static_cast<double>(center.y) / d;
        expectMean("T10 sphere light, r/d " + std::to_string(static_cast<double>(radius) / d), renderScene(builder.scene(), direct(128)),
                   reflected(sphereIrradiance(static_cast<double>(radius), d, c, glm::dvec3(radiance))));
    }
}

// T12 (Lambert 1760): irradiance at the origin, normal +y, of a polygon above the horizon.
glm::dvec3 polygonIrradiance(const std::vector<glm::vec3>& corners, const glm::dvec3& radiance)
{
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 u = glm::normalize(glm::dvec3(corners[i]));
        const glm::dvec3 v = glm::normalize(glm::dvec3(corners[(i + 1) % corners.size()]));
        const glm::dvec3 across = glm::cross(u, v);
        sum += std::atan2(glm::length(across), glm::dot(u, v)) * across.y / glm::length(across);
    }
    return 0.5 * std::abs(sum) * radiance;
}

void expectPolygon(const std::string& name, const std::vector<glm::vec3>& corners)
{
    const glm::vec3 radiance(6, 4, 2);
    SceneBuilder builder = floorScene();
    builder.polygon(corners, builder.lambert(glm::vec3(0.0F), radiance));
    expectMean(name, renderScene(builder.scene(), direct(128)), reflected(polygonIrradiance(corners, glm::dvec3(radiance))));
}

TEST(TruthTest, T11DiskLightAsPolygon)
{
    const double height = 1.0, radius = 0.8, offset = 0.5;
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 400; ++i) {  // clockwise from above: the front looks down
        const double phi = 2.0 * kPi * i / 400;
        corners.emplace_back(offset + radius * std::cos(phi), height, radius * std::sin(phi));
    }
    // A 400-gon inscribed in the disk has 4.1e-5 less area; the closed form of the disk bounds the polygon's formula.
    const double squares = height * height + offset * offset + radius * radius;
    const double disk =
        kPi / 2.0 * (1.0 - (squares - 2.0 * radius * radius) / std::sqrt(squares * squares - 4.0 * radius * radius * offset * offset));
    EXPECT_NEAR(polygonIrradiance(corners, glm::dvec3(1.0)).r / disk, 1.0, 1e-4);
    expectPolygon("T11 disk light", corners);
}

TEST(TruthTest, T12RectangleAndTriangleLight)
{
    expectPolygon("T12 rectangle", {{-0.5F, 1, -0.3F}, {0.7F, 1, -0.3F}, {0.7F, 1, 0.6F}, {-0.5F, 1, 0.6F}});
    expectPolygon("T12 near rectangle", {{-1, 0.1F, -1}, {1, 0.1F, -1}, {1, 0.1F, 1}, {-1, 0.1F, 1}});
    expectPolygon("T12 grazing triangle", {{1, 0.01F, -1}, {1, 0.01F, 1}, {1, 1.5F, 0}});
}

TEST(TruthTest, T15ConcentricSpheres)
{
    const double e = 2.0, rho1 = 0.6, rho2 = 0.7, f = 0.25;
    const double l2 = rho2 * f * e / (1.0 - rho2 * (1.0 - f) - rho1 * rho2 * f);
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.lambert(glm::vec3(0.6F), glm::vec3(2.0F)))
        .sphere({0, 0, 0}, 2.0F, builder.lambert(glm::vec3(0.7F), glm::vec3(0.0F), true))
        .perspective({1.5F, 0, 0}, {1.6F, 0, 0}, 1.0F)  // at the outer sphere
        .perspective({1.5F, 0, 0}, {0, 0, 0}, 0.8F);    // at the inner one
    RenderSettings settings = squareSettings(128, samplesFor(64));
    settings.bounces = 1000;
    const FlatScene flat = flattened(builder.scene());
    expectMean("T15 outer sphere", renderFlat(flat, builder.scene().cameras[0], settings), glm::dvec3(l2));
    expectMean("T15 inner sphere", renderFlat(flat, builder.scene().cameras[1], settings), glm::dvec3(e + rho1 * l2));
}

// T18: k reflections between facing mirrors keep r^k and the direction; the ray climbs the shaft to the sky.
TEST(TruthTest, T18FacingMirrors)
{
    SceneBuilder builder;
    const auto mirror = builder.mirror(glm::vec3(1.0F));
    builder.quad({glm::vec3(0, -50, -50), {0, 50, -50}, {0, 50, 50}, {0, -50, 50}}, mirror)
        .quad({glm::vec3(1, -50, -50), {1, 50, -50}, {1, 50, 50}, {1, -50, 50}}, mirror)
        .environment(glm::vec3(1.0F))
        .orthographic({0.5F, 0, 0}, {1.5F, 1, 0}, 0.1F);
    const Film film = renderScene(builder.scene(), squareSettings(32, 32));
    expectEverywhere(film, glm::dvec3(1.0), 64);  // 50 reflections, at 64 bounces at most
}

TEST(TruthTest, T19IndexMatchedGlassChangesNothing)
{
    SceneBuilder plain;
    const float size = 2.0F;
    for (int i = 0; i < 4; ++i) {
        const float x = -size + static_cast<float>(i) * size / 2.0F;
        const auto color = plain.lambert(glm::vec3(0.0F), glm::vec3(1.0F + static_cast<float>(i), 2.0F, 0.25F));
        plain.quad({glm::vec3(x, -size, -3), {x + size / 2, -size, -3}, {x + size / 2, size, -3}, {x, size, -3}}, color);
    }
    plain.perspective({0, 0, 5}, {0, 0, 0}, 0.4F);
    SceneBuilder covered = plain;
    covered.sphere({0, 0, 0}, 0.9F, covered.glass(1.0F));
    const Film a = renderScene(plain.scene(), squareSettings(64, 32));
    const Film b = renderScene(covered.scene(), squareSettings(64, 32));
    int different = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        different += a.pixels[i].mean != b.pixels[i].mean ? 1 : 0;
    }
    EXPECT_EQ(different, 0) << "pixels of " << a.pixels.size();
}

}  // namespace
}  // namespace glim
