#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/traverse_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <iostream>

namespace glim::traverse_test {

using Case = TraverseCase;

struct Result {
    PathHit hit;
    uint unoccluded;
};

// As a share of a primitive's size. The watertight test in float is right to some 1e-6 of it at coordinates of about 1.
constexpr double kMargin = 1e-4;

struct Tally {
    std::size_t rays = 0, ambiguous = 0, hits = 0, occluded = 0;
};

ReferenceRay inDouble(const PathRay& ray) { return {glm::dvec3(ray.origin), glm::dvec3(ray.direction), ray.source}; }

void compareClosest(const Reference& reference, const SceneOnDevice& scene, const Case& c, const PathHit& hit, Tally& tally)
{
    const ReferenceRay ray = inDouble(c.ray);
    const ReferenceHit grown = reference.closest(ray, kMargin), shrunk = reference.closest(ray, -kMargin);
    const double exact = reference.closest(ray, 0.0).t;
    const double nearer = std::min({grown.t, exact, shrunk.t}), farther = std::max({grown.t, exact, shrunk.t});
    // An error of 3e-7 of the coordinates (about 1) along the normal is that over the cosine along the ray; the shear adds as much.
    const double slack = 1e-6 / std::min(grown.cosine, shrunk.cosine);
    const double t = static_cast<double>(hit.t);
    EXPECT_GE(t, nearer * (1.0 - slack) - slack);
    EXPECT_LE(t, farther * (1.0 + slack) + slack);
    ++tally.rays;
    tally.hits += hit.primitiveRef != kNoPrimitiveRef ? 1 : 0;
    if (grown.id != shrunk.id) {
        ++tally.ambiguous;
    } else {
        EXPECT_EQ(scene.idOf(hit.primitiveRef), grown.id);
    }
}

void compareShadow(const Reference& reference, const Case& c, bool unoccluded, Tally& tally)
{
    const ReferenceRay ray = inDouble(c.ray);
    const double tMax = static_cast<double>(c.tMax);
    const bool grown = reference.isOccluded(ray, tMax, c.target, kMargin);
    const bool shrunk = reference.isOccluded(ray, tMax, c.target, -kMargin);
    EXPECT_TRUE(grown != shrunk || unoccluded == !grown);
    tally.occluded += unoccluded ? 0 : 1;
}

class TraverseTest : public testing::TestWithParam<TraverseInput> {};

TEST_P(TraverseTest, AgreesWithBruteForceAndTheReference)
{
    const Scene scene = GetParam().make();
    const SceneOnDevice onDevice(scene);
    const std::vector<Box> boxes = piecesOrPrimitives(onDevice.primitives);
    RayMaker maker(onDevice);
    std::vector<Case> cases;
    for (int i = 0; i < 6000; ++i) {
        cases.push_back(maker.anywhere(boxes));
        cases.push_back(maker.leaving());
    }
    KernelTest test = onDevice.test(test_kernels::traverse_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    const std::vector<Result> results = test.results<Result>();
    const Reference reference(scene);
    Tally tally;
    for (std::size_t i = 0; i < cases.size() && !HasFailure(); ++i) {
        SCOPED_TRACE("ray " + std::to_string(i));
        compareClosest(reference, onDevice, cases[i], results[i].hit, tally);
        compareShadow(reference, cases[i], results[i].unoccluded != 0, tally);
    }
    std::cout << GetParam().name << ": " << tally.rays << " rays, " << tally.hits << " hits, " << tally.occluded << " occluded, "
              << tally.ambiguous << " left to rounding\n";
    EXPECT_LT(tally.ambiguous, tally.rays / 50);
    EXPECT_GT(tally.hits, tally.rays / 50);
    EXPECT_LT(tally.occluded, tally.rays * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(Scenes, TraverseTest, testing::ValuesIn(traverseInputs()),
                         [](const testing::TestParamInfo<TraverseInput>& parameter) { return std::string(parameter.param.name); });

// Points of triangles where their pieces meet, on edges of pieces' boxes, seen from near and far.
std::vector<Case> raysAtCuts(const Triangles& triangles, const Pieces& pieces, std::size_t count)
{
    Random random(4);
    std::vector<Case> cases;
    while (cases.size() < count) {
        const std::uint32_t piece = static_cast<std::uint32_t>(pieces.boxes.size()) - 1 - random.below(50);
        const Triangle& triangle = triangles[pieces.primitives[piece]];
        const glm::dvec3 a(triangle.vertices[random.below(3)]);
        const glm::dvec3 b = glm::dvec3(triangle.vertices[0]) + random.uniform() * glm::dvec3(triangle.vertices[1] - triangle.vertices[0]);
        const int axis = static_cast<int>(random.below(3));
        const double place = static_cast<double>((random.below(2) == 0 ? pieces.boxes[piece].lo : pieces.boxes[piece].hi)[axis]);
        const double share = (place - a[axis]) / (b[axis] - a[axis]);
        if (share > 0.0 && share < 1.0) {
            const glm::vec3 target(a + share * (b - a)), origin = target + glm::vec3(random.logUniform(1e-4, 2.0) * random.direction());
            cases.push_back({{origin, kNoPrimitive, target - origin}, kNoPrimitive, 1.5F});
        }
    }
    return cases;
}

// The kernel compares with brute force, bit by bit.
TEST(TraversePiecesTest, LoseNoHitWhereTheyMeet)
{
    const SceneOnDevice onDevice(makeTestScene(strips(12, 9)));
    const Triangles& triangles = onDevice.primitives.triangles;
    ASSERT_GT(onDevice.bvh.order.size(), triangles.size() + 40);
    const std::vector<Case> cases = raysAtCuts(triangles, splitTriangles(triangles, primitiveBoxes(onDevice.primitives)), 30000);
    KernelTest test = onDevice.test(test_kernels::traverse_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    std::size_t met = 0;
    for (const Result& result : test.results<Result>()) {
        met += result.hit.primitiveRef != kNoPrimitiveRef && std::abs(result.hit.t - 1.0F) < 1e-5F ? 1 : 0;
    }
    std::cout << onDevice.bvh.order.size() << " primitive references of " << triangles.size() << " triangles, " << met << " of "
              << cases.size() << " rays met where they were aimed\n";
    EXPECT_GT(met, cases.size() / 4);
}

// Copies of one triangle and mirrored pairs of edges: the lowest primitive id wins whatever the order of the leaves.
TEST(TraverseTiesTest, GoToTheLowestPrimitive)
{
    Triangles mesh = icosphere(1);
    const Triangles copy = mesh;
    mesh.insert(mesh.end(), copy.begin(), copy.end());
    const SceneOnDevice scene(makeTestScene(mesh));
    std::vector<Case> cases;
    for (const Triangle& triangle : copy) {
        for (const glm::vec3& vertex : triangle.vertices) {
            cases.push_back({{glm::vec3(0.0F), kNoPrimitive, vertex}, kNoPrimitive, 1.0F});
            cases.push_back({{glm::vec3(0.0F), kNoPrimitive, vertex + triangle.vertices[0]}, kNoPrimitive, 1.0F});
        }
    }
    KernelTest test = scene.test(test_kernels::traverse_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    for (const Result& result : test.results<Result>()) {
        EXPECT_LT(scene.idOf(result.hit.primitiveRef), copy.size());
    }
}

// The ray meets a strip of 2 x 2e-7, where plain edge functions are rounding noise; the distance that they interpolate is negative by the
// rounding of CPUs (tools/mutants).
TEST(TraverseSliverTest, H2SliverIsHit)
{
    const SceneOnDevice scene(makeTestScene(sliverBox(150)));
    const auto bits = [](uint x, uint y, uint z) {
        return vec3(std::bit_cast<float>(x), std::bit_cast<float>(y), std::bit_cast<float>(z));
    };
    const PathRay ray{bits(0x3e4b89e3, 0x3e85cdb0, 0x3e0c7dd7), kNoPrimitive, bits(0xbf5fb293, 0x3f3d1928, 0x3f5ce06a)};
    KernelTest test = scene.test(test_kernels::traverse_test);
    test.features(kFeatureSlivers).cases(std::vector<Case>{{ray, kNoPrimitive, 1.0F}}).resultsOf<Result>(1).run();
    EXPECT_NE(test.results<Result>()[0].hit.primitiveRef, kNoPrimitiveRef);
}

}  // namespace glim::traverse_test
