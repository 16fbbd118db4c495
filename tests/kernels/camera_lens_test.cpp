// The thin lens, in double: where rays leave it and where they meet.
#include "host/flatten/flatten_scene.hpp"
#include "test_kernels.hpp"
#include "tests/support/any_camera.hpp"
#include "tests/support/kernel_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <numbers>

namespace glim::camera_lens_test {

using glm::dvec3;

constexpr double kUlp = 0x1p-24;  // half an ulp of 1
constexpr int kRaysPerPoint = 8;

struct Case {
    FlatCamera camera;
    vec2 film, disk;
};

// What the camera's floats mean.
struct Truth {
    dvec3 onLens;  // the ray's origin
    dvec3 focus;   // where all rays of the film point meet
    double radius;
    double turn;  // the most by which across and aperture turn rays
};

Truth truthOf(const Case& c)
{
    const FlatCamera& camera = c.camera;
    const glm::dvec2 film(c.film), disk(c.disk);
    const dvec3 across = film.x * dvec3(camera.right) + film.y * dvec3(camera.up);
    const dvec3 aperture = disk.x * dvec3(camera.lensRight) + disk.y * dvec3(camera.lensUp);
    const double depth = 1.0 / static_cast<double>(camera.inverseFocus);
    const bool orthographic = camera.kind == kOrthographic;
    const dvec3 eye = dvec3(camera.position) + (orthographic ? across : dvec3(0.0));
    const dvec3 towards = dvec3(camera.forward) + (orthographic ? dvec3(0.0) : across);
    const double turn = glm::length(aperture) / depth + (orthographic ? 0.0 : glm::length(across));
    return {eye + aperture, eye + depth * towards, glm::length(dvec3(camera.lensRight)), turn};
}

Camera anyLensCamera(Random& random, bool orthographic)
{
    Camera camera = anyCamera(random);
    camera.position *= 0.01F;
    camera.yfov = static_cast<float>(random.uniform(0.01, 2.0));
    if (orthographic) {
        camera.kind = Camera::Kind::Orthographic;
        camera.halfHeight = static_cast<float>(random.logUniform(1e-2, 10.0));
    }
    return camera;
}

vec2 onDisk(Random& random)
{
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    const double r = random.below(4) == 0 ? 1.0 : std::sqrt(random.uniform());
    return vec2(glm::dvec2(r * std::cos(angle), r * std::sin(angle)));
}

std::vector<Case> anyCases(bool orthographic)
{
    Random random(orthographic ? 86 : 85);
    std::vector<Case> cases;
    for (int i = 0; i < 20000; ++i) {
        const float focus = static_cast<float>(random.logUniform(0.1, 100.0));
        const Lens lens{focus * static_cast<float>(random.logUniform(1e-4, 1.0)), focus};
        const FlatCamera camera = flattenCamera(anyLensCamera(random, orthographic), 1.5F, lens);
        const vec2 film(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        for (int k = 0; k < kRaysPerPoint; ++k) {
            cases.push_back({camera, film, onDisk(random)});
        }
    }
    return cases;
}

struct Worst {
    double origin = 0.0;   // as a share of what rounding explains
    double meeting = 0.0;  // as a share of the distance from the lens
    double share = 0.0;    // of the limit
};

// The origin is a sum of five products, position and aperture among them. The direction is off by half an ulp when forward is added, and by
// some 12 half ulps of what turns it: six in across and aperture / depth, six in normalizeSum.
void expectRay(const Case& c, const PathRay& ray, Worst& worst)
{
    const Truth truth = truthOf(c);
    const dvec3 origin(ray.origin), direction(ray.direction), forward(c.camera.forward), eye(c.camera.position);
    const double film = glm::length(dvec3(c.camera.right)) + glm::length(dvec3(c.camera.up));
    const double extent = glm::length(eye) + truth.radius + film;
    const double originSlack = 4.0 * kUlp * extent;
    EXPECT_LE(glm::length(origin - truth.onLens), originSlack);
    worst.origin = std::max(worst.origin, glm::length(origin - truth.onLens) / originSlack);
    const double distance = glm::length(truth.focus - truth.onLens);
    const double t = glm::dot(truth.focus - origin, forward) / glm::dot(direction, forward);
    const double miss = glm::length(origin + t * direction - truth.focus);
    const double cosine = glm::dot(direction, forward);
    const double slack = (distance * kUlp * (1.0 + 12.0 * truth.turn) + originSlack) / cosine;
    EXPECT_LE(miss, slack);
    worst.meeting = std::max(worst.meeting, miss / distance);
    worst.share = std::max(worst.share, miss / slack);
}

TEST(CameraLensTest, H35RaysOfAFilmPointMeetInFocus)
{
    for (const bool orthographic : {false, true}) {
        const std::vector<Case> cases = anyCases(orthographic);
        KernelTest test(test_kernels::camera_lens_test);
        test.cases(cases).resultsOf<PathRay>(cases.size()).run();
        const std::vector<PathRay> rays = test.results<PathRay>();
        Worst worst;
        double widest = 0.0;  // angle between rays of one film point
        for (std::size_t i = 0; i < cases.size() && !HasFailure(); ++i) {
            SCOPED_TRACE("ray " + std::to_string(i));
            expectRay(cases[i], rays[i], worst);
            const std::size_t first = i - i % kRaysPerPoint;
            widest = std::max(widest, glm::length(dvec3(rays[i].direction) - dvec3(rays[first].direction)));
        }
        std::cout << "  " << (orthographic ? "orthographic" : "perspective") << ": rays miss their meeting point by at most "
                  << worst.meeting << " of its distance, " << worst.share << " of the limit; origins off by " << worst.origin
                  << " of theirs; rays of one point up to " << widest << " rad apart\n";
        EXPECT_GT(widest, 0.5);
    }
}

// With a lens of no size the disk does not matter.
TEST(CameraLensTest, H35PinholesIgnoreTheDisk)
{
    Random random(87);
    std::vector<Case> cases;
    std::vector<Case> middles;
    for (int i = 0; i < 1000; ++i) {
        const FlatCamera camera = flattenCamera(anyLensCamera(random, i % 2 == 0), 1.5F);
        const vec2 film(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        cases.push_back({camera, film, onDisk(random)});
        middles.push_back({camera, film, vec2(0.0F)});
    }
    KernelTest test(test_kernels::camera_lens_test), middle(test_kernels::camera_lens_test);
    test.cases(cases).resultsOf<PathRay>(cases.size()).run();
    middle.cases(middles).resultsOf<PathRay>(cases.size()).run();
    const std::vector<PathRay> a = test.results<PathRay>(), b = middle.results<PathRay>();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        ASSERT_TRUE(a[i].origin == b[i].origin && a[i].direction == b[i].direction) << i;
    }
}

}  // namespace glim::camera_lens_test
