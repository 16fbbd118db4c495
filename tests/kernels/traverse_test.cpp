#include "test_kernels.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <iostream>
#include <limits>
#include <random>

namespace glim {
namespace {

struct Case {
    PathRay ray;
    uint target = kNoRecord;
    float reach = 1.0F;
};

struct Result {
    PathHit hit;
    uint unoccluded;
};

// Of a primitive's size. The watertight test in float is right to some 1e-6 of it at coordinates of about 1.
constexpr double kMargin = 1e-4;

class RayMaker {
public:
    explicit RayMaker(const SceneOnDevice& scene) : scene_(scene) {}

    // Anywhere, in any direction; every third with one or two direction components of +0 or -0, and then with its origin
    // exactly on planes of the boxes of primitives.
    Case anywhere(const std::vector<Box>& boxes)
    {
        Case c{};
        c.ray.source = kNoRecord;
        c.ray.origin = point(1.2F);
        c.ray.direction = glm::normalize(point(1.0F));
        if (random_() % 3 == 0) {
            const auto kept = static_cast<int>(random_() % 3);
            for (int k = 0; k < 3; ++k) {
                if (k != kept && (random_() % 2 == 0 || k == (kept + 1) % 3)) {
                    c.ray.direction[k] = random_() % 2 == 0 ? 0.0F : -0.0F;
                    const Box& box = boxes[below(boxes.size())];
                    c.ray.origin[k] = random_() % 2 == 0 ? box.lo[k] : box.hi[k];
                }
            }
            c.ray.direction = glm::normalize(c.ray.direction);
        }
        pickShadow(c);
        return c;
    }

    // Off the surface of a primitive, towards any side.
    Case leaving(const Scene& scene)
    {
        Case c = {};
        const std::uint32_t id = below(scene_.recordOf.size());
        c.ray.source = scene_.recordOf[id];
        c.ray.direction = glm::normalize(point(1.0F));
        if (id < scene.triangles.size()) {
            const Triangle& t = scene.triangles[id];
            c.ray.origin = 0.5F * t.vertices[0] + 0.2F * t.vertices[1] + 0.3F * t.vertices[2];
        } else {
            const Sphere& sphere = scene.spheres[id - scene.triangles.size()];
            c.ray.origin = sphere.center + sphere.radius * glm::normalize(point(1.0F));
        }
        pickShadow(c);
        return c;
    }

private:
    glm::vec3 point(float size)
    {
        std::uniform_real_distribution<float> within(-size, size);
        const float x = within(random_), y = within(random_);
        return {x, y, within(random_)};
    }

    void pickShadow(Case& c)
    {
        c.target = random_() % 2 == 0 ? below(scene_.recordOf.size()) : kNoRecord;
        c.reach = random_() % 4 == 0 ? std::numeric_limits<float>::infinity()
                                     : std::uniform_real_distribution<float>(0.05F, 1.0F)(random_);
    }

    std::uint32_t below(std::size_t count) { return static_cast<std::uint32_t>(random_() % count); }

    const SceneOnDevice& scene_;
    std::mt19937 random_{7};
};

struct Tally {
    std::size_t rays = 0, ambiguous = 0, hits = 0, occluded = 0;
};

ReferenceRay inDouble(const SceneOnDevice& scene, const PathRay& ray)
{
    return {glm::dvec3(ray.origin), glm::dvec3(ray.direction), scene.idOf(ray.source)};
}

void compareClosest(const Reference& reference, const SceneOnDevice& scene, const Case& c, const PathHit& hit, Tally& tally)
{
    const ReferenceRay ray = inDouble(scene, c.ray);
    const ReferenceHit grown = reference.closest(ray, kMargin), shrunk = reference.closest(ray, -kMargin);
    const double exact = reference.closest(ray, 0.0).t;
    const double nearer = std::min({grown.t, exact, shrunk.t}), farther = std::max({grown.t, exact, shrunk.t});
    // 3e-7 of the coordinates (about 1) along the normal, so that over the cosine along the ray; the sheared test adds as much.
    const double slack = 1e-6 / std::min(grown.cosine, shrunk.cosine);
    const double t = static_cast<double>(hit.t);
    EXPECT_GE(t, nearer * (1.0 - slack) - slack);
    EXPECT_LE(t, farther * (1.0 + slack) + slack);
    ++tally.rays;
    tally.hits += hit.record != kNoRecord ? 1 : 0;
    if (grown.id != shrunk.id) {
        ++tally.ambiguous;
    } else {
        EXPECT_EQ(scene.idOf(hit.record), grown.id);
    }
}

void compareShadow(const Reference& reference, const SceneOnDevice& scene, const Case& c, bool unoccluded, Tally& tally)
{
    const ReferenceRay ray = inDouble(scene, c.ray);
    const double reach = static_cast<double>(c.reach);
    const bool grown = reference.isOccluded(ray, reach, scene.idOf(c.target), kMargin);
    const bool shrunk = reference.isOccluded(ray, reach, scene.idOf(c.target), -kMargin);
    EXPECT_TRUE(grown != shrunk || unoccluded == !grown);
    tally.occluded += unoccluded ? 0 : 1;
}

struct Input {
    const char* name;
    std::function<Scene()> make;
};

void PrintTo(const Input& input, std::ostream* out) { *out << input.name; }

class TraverseTest : public testing::TestWithParam<Input> {};

TEST_P(TraverseTest, AgreesWithBruteForceAndTheReference)
{
    const Scene scene = GetParam().make();
    const std::vector<Box> boxes = primitiveBoxes(scene);
    const SceneOnDevice onDevice(scene);
    RayMaker maker(onDevice);
    std::vector<Case> cases;
    for (int i = 0; i < 6000; ++i) {
        cases.push_back(maker.anywhere(boxes));
        cases.push_back(maker.leaving(scene));
    }
    KernelTest test = onDevice.test(test_kernels::traverse_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    const Reference reference(scene);
    Tally tally;
    for (std::size_t i = 0; i < cases.size() && !HasFailure(); ++i) {
        SCOPED_TRACE("ray " + std::to_string(i));
        compareClosest(reference, onDevice, cases[i], results[i].hit, tally);
        compareShadow(reference, onDevice, cases[i], results[i].unoccluded != 0, tally);
    }
    std::cout << GetParam().name << ": " << tally.rays << " rays, " << tally.hits << " hits, " << tally.occluded
              << " occluded, " << tally.ambiguous << " left to rounding\n";
    EXPECT_LT(tally.ambiguous, tally.rays / 50);
    EXPECT_GT(tally.hits, tally.rays / 50);
    EXPECT_LT(tally.occluded, tally.rays * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, TraverseTest,
    testing::Values(
        Input{"Mixed", [] { return sceneOf(randomTriangles(250, 0.3F, 1), randomSpheres(50, 0.2F, 2)); }},
        Input{"Large", [] { return sceneOf(randomTriangles(60, 1.5F, 3), randomSpheres(6, 1.2F, 4)); }},
        Input{"Spheres", [] { return sceneOf({}, randomSpheres(200, 0.3F, 5)); }},
        Input{"Small", [] { return sceneOf(randomTriangles(500, 0.1F, 6), randomSpheres(100, 0.1F, 7)); }},
        Input{"OneTriangle", [] { return sceneOf(randomTriangles(1, 1.5F, 8)); }},
        Input{"OneSphere", [] { return sceneOf({}, {{"", glm::vec3(0.1F, 0.2F, 0.0F), 0.8F, 0}}); }}),
    [](const testing::TestParamInfo<Input>& parameter) { return std::string(parameter.param.name); });

// Copies of one triangle and mirrored pairs of edges: the lowest primitive id wins whatever the order of the leaves.
TEST(TraverseTiesTest, GoToTheLowestPrimitive)
{
    Mesh mesh = icosphere(1);
    const Mesh copy = mesh;
    mesh.insert(mesh.end(), copy.begin(), copy.end());
    const SceneOnDevice scene(sceneOf(mesh));
    std::vector<Case> cases;
    for (const Triangle& triangle : copy) {
        for (const glm::vec3& vertex : triangle.vertices) {
            cases.push_back({{glm::vec3(0.0F), kNoRecord, vertex}, kNoRecord, 1.0F});
            cases.push_back({{glm::vec3(0.0F), kNoRecord, vertex + triangle.vertices[0]}, kNoRecord, 1.0F});
        }
    }
    KernelTest test = scene.test(test_kernels::traverse_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    for (const Result& result : test.results<Result>()) {
        EXPECT_LT(scene.idOf(result.hit.record), copy.size());
    }
}

// KNOWN BUG: the ray meets a strip of 2 x 2e-7, where the watertight test's weights are rounding noise; the distance that they
// interpolate comes out negative, and the hit is lost. Once this fails, expect a hit, and allow no misses in watertight_test.cpp.
TEST(TraverseKnownBug, ASliverMayLoseItsHit)
{
    const SceneOnDevice scene(sceneOf(sliverBox(150)));
    const auto bits = [](uint x, uint y, uint z) {
        return vec3(std::bit_cast<float>(x), std::bit_cast<float>(y), std::bit_cast<float>(z));
    };
    const PathRay ray{bits(0x3e4b89e3, 0x3e85cdb0, 0x3e0c7dd7), kNoRecord, bits(0xbf5fb293, 0x3f3d1928, 0x3f5ce06a)};
    KernelTest test = scene.test(test_kernels::traverse_test);
    test.cases(std::vector<Case>{{ray, kNoRecord, 1.0F}}).resultsOf<Result>(1).run();
    EXPECT_EQ(test.results<Result>()[0].hit.record, kNoRecord);
}

}  // namespace
}  // namespace glim
