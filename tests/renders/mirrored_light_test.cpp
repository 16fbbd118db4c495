// Caustics that are known on paper: a plane mirror shows a lamp again.
#include "tests/support/build_scene.hpp"
#include "tests/support/caustic_films.hpp"
#include "tests/support/named.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glim {
namespace {

constexpr double kPi = std::numbers::pi;

// A floor y = 0 beside a mirror x = -1 that reflects everything, seen from above by parallel rays.
constexpr float kHalf = 0.4F;
const glm::vec3 kRho(0.8F, 0.5F, 0.2F);

SceneBuilder floorAndMirror(const PunctualLight& light)
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(kRho))
        .quad({glm::vec3(-1, 0, 1), {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}}, builder.mirror(glm::vec3(1.0F)))
        .light(light)
        .orthographic({0.2F, 2.5F, 0.0F}, {0.2F, 0.0F, 0.0F}, kHalf);
    return builder;
}

// Irradiance that the light gives the floor at p, without occlusion. Its range counts to the first surface, which is the mirror after
// `part` of the way.
double irradianceAt(const PunctualLight& light, const glm::dvec3& p, double part = 1.0)
{
    if (light.kind == PunctualLight::Kind::Directional) {
        return static_cast<double>(light.intensity.r) * std::max(0.0, -static_cast<double>(light.direction.y));
    }
    const glm::dvec3 towards = glm::dvec3(light.position) - p;
    const double distance2 = glm::dot(towards, towards), distance = std::sqrt(distance2);
    double intensity = static_cast<double>(light.intensity.r);
    if (light.kind == PunctualLight::Kind::Spot) {
        const double versine = 1.0 + glm::dot(towards, glm::dvec3(light.direction)) / distance;
        const double ramp =
            (static_cast<double>(light.versineOuter) - versine) / static_cast<double>(light.versineOuter - light.versineInner);
        intensity *= std::pow(std::clamp(ramp, 0.0, 1.0), 2.0);
    }
    if (light.range > 0.0F) {
        const double share = part * part * distance2 / std::pow(static_cast<double>(light.range), 2.0);
        intensity *= std::clamp(1.0 - share * share, 0.0, 1.0);
    }
    return intensity * towards.y / distance / distance2;
}

PunctualLight mirrored(PunctualLight light)
{
    light.position.x = -2.0F - light.position.x;
    light.direction.x = -light.direction.x;
    return light;
}

// The mean of rho / pi times the irradiance of the light and of its image over each pixel, by 4 x 4 points.
Picture floorPicture(const PunctualLight& light, const Camera& camera, std::uint32_t side)
{
    Picture picture{side, side, {}, std::vector<glm::vec3>(std::size_t{side} * side, glm::vec3(0.0F))};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        double sum = 0.0;
        for (int sub = 0; sub < 16; ++sub) {
            const double x = (i % side + (sub % 4 + 0.5) / 4.0) / side, y = (i / side + (sub / 4 + 0.5) / 4.0) / side;
            glm::dvec3 p = glm::dvec3(camera.position) + static_cast<double>(kHalf) * ((2.0 * x - 1.0) * glm::dvec3(camera.right) +
                                                                                       (1.0 - 2.0 * y) * glm::dvec3(camera.up));
            p.y = 0.0;
            const PunctualLight image = mirrored(light);
            const double behind = -1.0 - static_cast<double>(image.position.x);
            sum += irradianceAt(light, p) + irradianceAt(image, p, behind / (behind + 1.0 + p.x));
        }
        picture.radiance.push_back(kRho * static_cast<float>(sum / (16.0 * kPi)));
    }
    return picture;
}

class MirroredLightTest : public testing::TestWithParam<test::Named<PunctualLight>> {};

// A plane mirror makes a second light. With two surfaces at most there is nothing else.
TEST_P(MirroredLightTest, IsAnImageOfIt)
{
    const PunctualLight light = GetParam().value;
    const Scene scene = floorAndMirror(light).scene();
    RenderSettings settings = squareSettings(32, samplesFor(8192));
    settings.bounces = 2;
    const Film film = renderScene(scene, settings);
    ASSERT_FALSE(film.splats.empty());
    expectAgreement(GetParam().name, makePicture(film), floorPicture(light, scene.cameras.front(), 32));
}

INSTANTIATE_TEST_SUITE_P(
    Lights, MirroredLightTest,
    testing::Values(
        test::Named{"point", PunctualLight{"", PunctualLight::Kind::Point, {0.5F, 1.2F, 0.3F}, {0, 0, -1}, glm::vec3(3.0F)}},
        test::Named{"range",
                    PunctualLight{"", PunctualLight::Kind::Point, {0.1F, 0.6F, 0.1F}, {0, 0, -1}, glm::vec3(3.0F), 0.0F, 1.0F, 1.6F}},
        test::Named{"spot", PunctualLight{"",
                                          PunctualLight::Kind::Spot,
                                          {0.5F, 1.2F, 0.3F},
                                          glm::normalize(glm::vec3(-1.5F, -0.6F, -0.3F)),
                                          glm::vec3(3.0F),
                                          0.1F,
                                          0.4F}},
        test::Named{"narrowSpot", PunctualLight{"",
                                                PunctualLight::Kind::Spot,
                                                {0.5F, 1.2F, 0.3F},
                                                glm::normalize(glm::vec3(-1.5F, -0.6F, -0.3F)),
                                                glm::vec3(3.0F),
                                                1e-4F,
                                                3e-4F}},
        test::Named{"directional",
                    PunctualLight{
                        "", PunctualLight::Kind::Directional, {0, 0, 0}, glm::normalize(glm::vec3(-0.7F, -0.6F, 0.1F)), glm::vec3(3.0F)}}),
    test::nameOfParameter);

}  // namespace
}  // namespace glim
