#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/support/any_camera.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace glim::camera_test {

struct Case {
    FlatCamera camera;
    vec2 position, size, film;
    vec3 origin, direction;
    float originTolerance;
};

double computeHalfHeight(const Camera& camera)
{
    return camera.kind == Camera::Kind::Perspective ? std::tan(0.5 * static_cast<double>(camera.yfov))
                                                    : static_cast<double>(camera.halfHeight);
}

glm::dvec2 makeFilm(vec2 position, vec2 size)
{
    return {2.0 * static_cast<double>(position.x) / static_cast<double>(size.x) - 1.0,
            1.0 - 2.0 * static_cast<double>(position.y) / static_cast<double>(size.y)};
}

// What camera and picture mean in glTF: the picture's height spans yfov, or 2 halfHeight; pixels are square; y points down.
glm::dvec3 acrossOf(const Camera& camera, vec2 position, vec2 size)
{
    const double aspect = static_cast<double>(size.x) / static_cast<double>(size.y);
    const glm::dvec2 film = makeFilm(position, size);
    return computeHalfHeight(camera) * (film.x * aspect * glm::dvec3(camera.right) + film.y * glm::dvec3(camera.up));
}

Case makeCase(const Camera& camera, vec2 position, vec2 size)
{
    Case c{flattenCamera(camera, size.x / size.y), position, size, makeFilm(position, size), {}, {}, 0.0F};
    const bool perspective = camera.kind == Camera::Kind::Perspective;
    const glm::dvec3 across = acrossOf(camera, position, size), forward(camera.forward), eye(camera.position);
    c.origin = perspective ? eye : eye + across;
    const double extent = computeHalfHeight(camera) * (1.0 + static_cast<double>(size.x / size.y));
    c.originTolerance = perspective ? 0.0F : static_cast<float>(5e-7 * (glm::length(eye) + extent));
    c.direction = glm::normalize(perspective ? forward + across : forward);
    return c;
}

vec2 positionIn(Random& random, vec2 size, int i)
{
    const vec2 corners[] = {{0.0F, 0.0F}, {size.x, 0.0F}, {0.0F, size.y}, size};
    return i % 8 < 4 ? corners[i % 8] : vec2(random.uniform(), random.uniform()) * size;
}

TEST(CameraTest, RaysGoWhereTheFilmSays)
{
    Random random(80);
    std::vector<Case> cases;
    for (int i = 0; i < 100000; ++i) {
        Camera camera = anyCamera(random);
        camera.yfov = static_cast<float>(random.uniform(0.01, 3.0));
        if (i % 3 == 0) {
            camera.kind = Camera::Kind::Orthographic;
            camera.halfHeight = static_cast<float>(random.logUniform(1e-3, 1e3));
        }
        const std::uint32_t height = 1 + random.below(4000);
        const vec2 size(1 + random.below(3 * height), height);
        cases.push_back(makeCase(camera, positionIn(random, size, i), size));
    }
    KernelTest(test_kernels::camera_test).cases(cases).resultsOf<vec3>(cases.size()).run();
}

// The direction by normalize, in float32.
vec3 normalizedDirection(const Case& c) { return glm::normalize(c.camera.forward + (c.film.x * c.camera.right + c.film.y * c.camera.up)); }

// H35: at a field of view of 0.1 degree on 1920 pixels each direction is within 0.07 pixel.
TEST(CameraTest, H35ThinFieldsOfView)
{
    constexpr float kSize = 1920.0F;
    Random random(81);
    std::vector<Case> cases;
    std::vector<glm::dvec3> truth;
    for (int i = 0; i < 100000; ++i) {
        Camera camera = anyCamera(random);
        camera.yfov = static_cast<float>(0.1 * std::numbers::pi / 180.0);
        cases.push_back(makeCase(camera, positionIn(random, {kSize, kSize}, i), {kSize, kSize}));
        truth.push_back(glm::normalize(glm::dvec3(camera.forward) + acrossOf(camera, cases.back().position, {kSize, kSize})));
    }
    KernelTest test(test_kernels::camera_test);
    test.cases(cases).resultsOf<vec3>(cases.size()).run();
    const std::vector<vec3> directions = test.results<vec3>();
    const double pixel = 0.1 * std::numbers::pi / 180.0 / static_cast<double>(kSize);
    double worst = 0.0, squares = 0.0, naive = 0.0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const double angle = glm::length(glm::cross(glm::dvec3(directions[i]), truth[i])) / pixel;
        worst = std::max(worst, angle);
        squares += angle * angle / static_cast<double>(cases.size());
        naive = std::max(naive, glm::length(glm::cross(glm::dvec3(normalizedDirection(cases[i])), truth[i])) / pixel);
    }
    printHardCase("H35", "field of view .1 degree on 1920 pixels", static_cast<double>(cases.size()),
                  "directions within " + figure(worst) + " pixels, root of mean square " + figure(std::sqrt(squares)),
                  "by normalize: within " + figure(naive));
    EXPECT_LE(worst, 0.07);
}

}  // namespace glim::camera_test
