// Single-sided surfaces are not there for rays from behind of a path from the camera, nor for those of a light path that go the other way.
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <cstdio>

namespace glim::single_sided_test {

struct Segment {
    vec3 from, to;
};

struct Result {
    float t;
    uint fromBehind;
    uint forwards, backwards;
};

std::vector<Result> trace(const SceneOnDevice& scene, const std::vector<Segment>& segments)
{
    KernelTest test = scene.test(test_kernels::single_sided_test);
    test.cases(segments).resultsOf<Result>(segments.size()).run();
    return test.results<Result>();
}

std::vector<Segment> segmentsWithin(float size, std::size_t count)
{
    Random random(11);
    const auto point = [&] { return size * (2.0F * vec3(random.unitFloat(), random.unitFloat(), random.unitFloat()) - 1.0F); };
    std::vector<Segment> segments;
    while (segments.size() < count) {
        const vec3 from = point();
        segments.push_back({from, point()});
    }
    return segments;
}

// Triangles and spheres, of which every other is single-sided.
Scene halfSingleSided()
{
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].doubleSided = true;
    scene.spheres = randomSpheres(20, 0.4F, 5);
    for (std::uint32_t i = 0; i < scene.spheres.size(); ++i) {
        scene.spheres[i].material = i % 2;
    }
    addMesh(scene, randomTriangles(60, 0.5F, 3), 0);
    addMesh(scene, randomTriangles(60, 0.5F, 4), 1);
    return scene;
}

struct Tally {
    std::size_t hits = 0, fromBehind = 0, free = 0, disagree = 0;
};

Tally tallyOf(const std::vector<Result>& results)
{
    Tally tally;
    for (const Result& result : results) {
        tally.hits += std::isinf(result.t) ? 0 : 1;
        tally.fromBehind += result.fromBehind;
        tally.free += result.forwards;
        tally.disagree += result.forwards != result.backwards ? 1 : 0;
    }
    std::printf("%zu rays, %zu hits, %zu from behind, %zu ways free, %zu of them one way only\n", results.size(), tally.hits,
                tally.fromBehind, tally.free, tally.disagree);
    return tally;
}

TEST(SingleSidedTest, RaysFromBehindMeetOnlyOtherSurfaces)
{
    const std::vector<Segment> segments = segmentsWithin(1.2F, 20000);
    Scene scene = halfSingleSided();
    const Tally tally = tallyOf(trace(SceneOnDevice(scene), segments));
    EXPECT_GT(tally.fromBehind, tally.hits / 10);
    EXPECT_GT(tally.free, segments.size() / 10);
    EXPECT_LE(tally.disagree, segments.size() / 5000);  // rays that graze an edge round otherwise in the other direction
    scene.materials[1].doubleSided = false;
    const SceneOnDevice single(scene);
    EXPECT_EQ(single.flat.features & kFeatureSingleSided, kFeatureSingleSided);
    const Tally fronts = tallyOf(trace(single, segments));
    EXPECT_EQ(fronts.fromBehind, 0U);
    EXPECT_GT(fronts.free, tally.free);
    scene.showsBackFaces = true;
    const SceneOnDevice shown(scene);
    EXPECT_EQ(shown.flat.features & kFeatureSingleSided, FeatureMask{0});
    const Tally both = tallyOf(trace(shown, segments));
    EXPECT_GT(both.fromBehind, both.hits / 4);
    EXPECT_LT(both.free, tally.free);
}

// A closed mesh is met from outside at its near side and not from within, also where an instance mirrors it.
TEST(SingleSidedTest, AMirroredFrontStaysTheFront)
{
    for (const std::uint64_t maxFlatTriangles : {kMaxFlatTriangles, std::uint64_t{0}}) {
        for (const glm::dvec3 scale : {glm::dvec3(1, 1, 1), glm::dvec3(1, 1, -1), glm::dvec3(-0.5, -1.5, -1), glm::dvec3(-1, 2, -0.3)}) {
            Scene scene;
            scene.materials.emplace_back();
            addMesh(scene, icosphere(2));
            const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.8, glm::normalize(glm::dvec3(1, 2, 0.5)));
            scene.instances[0].worldFromMesh = glm::scale(turned, scale);
            scene.instances.push_back(scene.instances[0]);
            scene.instances[1].worldFromMesh[3] += glm::dvec4(50, 0, 0, 0);
            const SceneOnDevice onDevice(scene, makePrimitives(scene, maxFlatTriangles));
            ASSERT_EQ(onDevice.flat.instances.empty(), maxFlatTriangles != 0);
            Random random(3);
            std::vector<Segment> segments;
            for (int i = 0; i < 2000; ++i) {
                const vec3 within(turned * glm::dvec4(scale * (0.5 * random.direction()), 1.0)), outside(9.0 * random.direction());
                segments.push_back({outside, within});
                segments.push_back({within, outside});
            }
            const std::vector<Result> results = trace(onDevice, segments);
            for (std::size_t i = 0; i < results.size() && !HasFailure(); i += 2) {
                EXPECT_LT(results[i].t, 1.0F);
                EXPECT_EQ(results[i].fromBehind, 0U);
                EXPECT_EQ(results[i].forwards, 0U);
                EXPECT_EQ(results[i].backwards, 0U);
                EXPECT_FALSE(results[i + 1].t < 1.0F);
                EXPECT_EQ(results[i + 1].forwards, 1U);
                EXPECT_EQ(results[i + 1].backwards, 1U);
            }
        }
    }
}

}  // namespace glim::single_sided_test
