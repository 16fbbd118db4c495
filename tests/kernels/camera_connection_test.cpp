// A point is connected to the camera by the ray that sees it, and weighs as much as the film that its surroundings cover.
#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/support/any_camera.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

namespace glim::camera_connection_test {

struct Case {
    FlatCamera camera;
    vec2 film, disk;
    vec3 p, wo;
    float weight;
};

struct Ray {
    glm::dvec3 origin, direction;
};

// As lensRay of shaders/lib/camera.glsl, in double.
Ray rayOf(const FlatCamera& camera, const glm::dvec2& film, const glm::dvec2& disk)
{
    const glm::dvec3 across = film.x * glm::dvec3(camera.right) + film.y * glm::dvec3(camera.up);
    const glm::dvec3 aperture = disk.x * glm::dvec3(camera.lensRight) + disk.y * glm::dvec3(camera.lensUp);
    const bool orthographic = camera.kind == kOrthographic;
    const glm::dvec3 turn = (orthographic ? glm::dvec3(0.0) : across) - aperture * static_cast<double>(camera.inverseFocus);
    return {glm::dvec3(camera.position) + aperture + (orthographic ? across : glm::dvec3(0.0)),
            glm::normalize(glm::dvec3(camera.forward) + turn)};
}

// Where the ray of a film point meets the plane through p across wo.
glm::dvec3 meets(const FlatCamera& camera, const glm::dvec2& film, const glm::dvec2& disk, const glm::dvec3& p, const glm::dvec3& wo)
{
    const Ray ray = rayOf(camera, film, disk);
    return ray.origin + ray.direction * (glm::dot(p - ray.origin, wo) / glm::dot(ray.direction, wo));
}

TEST(CameraConnectionTest, IsTheRayThatSeesThePoint)
{
    Random random(81);
    std::vector<Case> cases;
    for (int i = 0; i < 20000; ++i) {
        Camera camera = anyCamera(random);
        camera.position *= 1.0F / std::max(1.0F, glm::length(camera.position));
        camera.yfov = static_cast<float>(random.uniform(0.2, 2.0));
        if (i % 2 == 0) {
            camera.kind = Camera::Kind::Orthographic;
            camera.halfHeight = static_cast<float>(random.uniform(0.5, 3.0));
        }
        const Lens lens{i % 3 == 0 ? 0.0F : static_cast<float>(random.uniform(0.01, 0.3)), static_cast<float>(random.uniform(0.5, 5.0))};
        Case c{};
        c.camera = flattenCamera(camera, static_cast<float>(random.uniform(0.5, 2.0)), lens);
        c.film = vec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        c.disk = 0.7F * vec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const Ray ray = rayOf(c.camera, c.film, c.disk);
        const glm::dvec3 p = ray.origin + ray.direction * random.uniform(0.5, 5.0);
        c.p = p;
        c.wo = -ray.direction;
        constexpr double kStep = 1e-4;
        const auto side = [&](const glm::dvec2& step) {
            return (meets(c.camera, glm::dvec2(c.film) + step, c.disk, p, ray.direction) -
                    meets(c.camera, glm::dvec2(c.film) - step, c.disk, p, ray.direction)) /
                   (2.0 * kStep);
        };
        // The film is 2 by 2.
        c.weight = static_cast<float>(1.0 / (4.0 * glm::length(glm::cross(side({kStep, 0.0}), side({0.0, kStep})))));
        cases.push_back(c);
    }
    KernelTest(test_kernels::camera_connection_test).cases(cases).run();
}

// Where the film shows a place, in double. The camera looks along -z from its position.
glm::dvec2 filmOf(const FlatCamera& camera, const glm::dvec3& p)
{
    const FlatProjection& projection = camera.projection;
    const glm::dvec3 from = p - glm::dvec3(camera.position);
    glm::dvec2 image(from.x, from.y);
    if (projection.model == kEquirectangular) {
        image = {std::atan2(from.x, -from.z), std::atan2(from.y, std::hypot(from.x, from.z))};
    } else if (projection.model == kFisheye) {
        const double sine = glm::length(image), angle = std::atan2(sine, -from.z);
        image *= angle * (1.0 + angle * angle * static_cast<double>(projection.radial.x)) / sine;
    } else {
        image /= -from.z;
        image *= 1.0 + glm::dot(image, image) * static_cast<double>(projection.radial.x);
    }
    return image / glm::dvec2(projection.scale) - glm::dvec2(projection.shift);
}

TEST(CameraConnectionTest, FollowsTheProjection)
{
    Random random(82);
    for (const Projection::Model model : {Projection::Model::Straight, Projection::Model::RadialTangential, Projection::Model::Fisheye,
                                          Projection::Model::Equirectangular}) {
        std::vector<Case> cases;
        for (int i = 0; i < 5000; ++i) {
            Camera camera;
            camera.position = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            camera.projection.model = model;
            const bool isFlat = model == Projection::Model::Straight || model == Projection::Model::RadialTangential;
            if (model != Projection::Model::Equirectangular) {
                camera.projection.intrinsics = Intrinsics{{random.uniform(50, 90), 60.0}, {60.0, 40.0}, {100.0, 100.0}};
                camera.projection.distortion = {model == Projection::Model::Straight ? 0.0 : random.uniform(-0.08, 0.2)};
            }
            const glm::dvec3 any = random.direction();
            const glm::dvec3 wo = isFlat ? -glm::normalize(glm::dvec3(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), -1.0)) : any;
            if (!isFlat && (std::abs(wo.y) > 0.95 || (model == Projection::Model::Fisheye && (wo.z < -0.2 || wo.z > 0.999)))) {
                continue;  // by the poles; where the distortion may fold back; by the middle, where differences are not accurate
            }
            Case c{};
            c.camera = flattenCamera(camera, 1.0F);
            c.p = glm::dvec3(c.camera.position) - wo * random.uniform(0.5, 5.0);
            const glm::dvec3 p(c.p), towards = glm::normalize(p - glm::dvec3(c.camera.position));
            const glm::dvec3 side = glm::normalize(glm::cross(towards, random.direction())), other = glm::cross(towards, side);
            constexpr double kStep = 1e-5;
            const auto derivative = [&](const glm::dvec3& to) {
                glm::dvec2 step = filmOf(c.camera, p + kStep * to) - filmOf(c.camera, p - kStep * to);
                step.x -= model == Projection::Model::Equirectangular ? 2.0 * std::round(0.5 * step.x) : 0.0;
                return step / (2.0 * kStep);
            };
            const glm::dvec2 a = derivative(side), b = derivative(other);
            c.weight = static_cast<float>(0.25 * std::abs(a.x * b.y - a.y * b.x));
            c.film = vec2(filmOf(c.camera, p));
            c.wo = -towards;
            if (std::abs(c.film.x) < 0.999F) {  // at the seam either side is right
                cases.push_back(c);
            }
        }
        EXPECT_GT(cases.size(), 1000U);
        KernelTest(test_kernels::camera_connection_test).cases(cases).run();
    }
}

}  // namespace glim::camera_connection_test
