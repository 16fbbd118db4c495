#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/traverse_cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

namespace glim::course_scan_test {

struct Case {
    PathRay ray;
    uint target;
    float tMax;
    uvec2 cuts;
};

struct Result {
    PathHit hit;
    uint unoccluded;
};

// Now and then a piece is empty.
Case cutAnywhere(const TraverseCase& c, std::uint32_t refs, Random& random)
{
    const std::uint32_t a = random.below(refs + 1), b = random.below(8) == 0 ? a : random.below(refs + 1);
    return {c.ray, c.target, c.tMax, {std::min(a, b), std::max(a, b)}};
}

std::vector<Result> scan(const SceneOnDevice& scene, const std::vector<TraverseCase>& rays)
{
    Random random(90);
    std::vector<Case> cases;
    for (const TraverseCase& ray : rays) {
        cases.push_back(cutAnywhere(ray, static_cast<std::uint32_t>(scene.bvh.order.size()), random));
    }
    KernelTest test = scene.test(test_kernels::course_scan_test);
    test.cases(cases).resultsOf<Result>(cases.size()).run();
    return test.results<Result>();
}

class ScanTest : public testing::TestWithParam<TraverseInput> {};

TEST_P(ScanTest, InPiecesAgreesWithTheTree)
{
    const Scene scene = GetParam().make();
    const SceneOnDevice onDevice(scene);
    const std::vector<Box> boxes = piecesOrPrimitives(onDevice.primitives);
    RayMaker maker(onDevice);
    std::vector<TraverseCase> rays;
    for (int i = 0; i < 6000; ++i) {
        rays.push_back(maker.anywhere(boxes));
        rays.push_back(maker.leaving());
    }
    std::size_t hits = 0, occluded = 0;
    for (const Result& result : scan(onDevice, rays)) {
        hits += result.hit.primitiveRef != kNoPrimitiveRef ? 1 : 0;
        occluded += result.unoccluded == 0 ? 1 : 0;
    }
    std::cout << GetParam().name << ": " << rays.size() << " rays, " << hits << " hits, " << occluded << " occluded\n";
    EXPECT_GT(hits, rays.size() / 50);
    EXPECT_LT(occluded, rays.size() * 9 / 10);
    EXPECT_GT(occluded, 0U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScanTest, testing::ValuesIn(traverseInputs()),
                         [](const testing::TestParamInfo<TraverseInput>& parameter) { return std::string(parameter.param.name); });

// Three copies of each triangle and spheres that coincide, on both sides of the cuts: the lowest primitive id wins.
TEST(ScanTiesTest, GoToTheLowestPrimitive)
{
    Triangles mesh = icosphere(1);
    const Triangles copy = mesh;
    for (int i = 0; i < 2; ++i) {
        mesh.insert(mesh.end(), copy.begin(), copy.end());
    }
    const Sphere sphere{"", glm::vec3(0.0F), 0.9F, 0};
    const SceneOnDevice scene(makeTestScene(mesh, {sphere, sphere, sphere}));
    std::vector<TraverseCase> rays;
    for (const Triangle& triangle : copy) {
        for (const glm::vec3& vertex : triangle.vertices) {
            for (const glm::vec3& target : {vertex, vertex + triangle.vertices[0]}) {
                for (const glm::vec3& from : {glm::vec3(0.0F), 2.0F * vertex}) {
                    rays.push_back({{from, kNoPrimitive, from == glm::vec3(0.0F) ? target : -target}, kNoPrimitive, 1.0F});
                }
            }
        }
    }
    std::size_t spheres = 0;
    for (const Result& result : scan(scene, rays)) {
        const std::uint32_t id = scene.idOf(result.hit.primitiveRef);
        EXPECT_TRUE(id < copy.size() || id == mesh.size()) << id;
        spheres += id == mesh.size() ? 1 : 0;
    }
    std::cout << rays.size() << " rays, " << spheres << " of them at spheres\n";
    EXPECT_GT(spheres, rays.size() / 4);
    EXPECT_LT(spheres, rays.size() * 3 / 4);
}

}  // namespace glim::course_scan_test
