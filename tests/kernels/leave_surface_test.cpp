// H7: rays that leave a triangle do not meet it, at any scale and place, and start close to it.
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <ostream>
#include <utility>

namespace glim::leave_surface_test {

constexpr std::uint32_t kMaxGroups = 65535;  // of a dispatch, on every device

struct Setup {
    float reach;
};

struct Tally {
    uint left;
    uint selfHits;
    uint skippedHits;
    uint otherHits;
    uint largestOffset;
    uint naiveHits;
};

Tally leave(const Triangles& mesh, float reach, std::uint32_t rays, FeatureMask features = kAllFeatures)
{
    const SceneOnDevice scene(makeTestScene(mesh));
    KernelTest test = scene.test(test_kernels::leave_surface_test);
    test.features(features).cases(std::vector<Setup>{{reach}}).resultsOf<Tally>(1).threads(std::min(rays / 64, kMaxGroups) * 64).run();
    return test.results<Tally>()[0];
}

// Triangles of this size whose planes pass by the origin.
Triangles aroundTheOrigin(float size)
{
    Triangles mesh = randomTriangles(200, size, 4);
    for (Triangle& triangle : mesh) {
        triangle.vertices[2] = -triangle.vertices[0] - triangle.vertices[1];
    }
    return mesh;
}

struct Input {
    const char* name;
    std::function<Triangles()> make;
    float reach;
    bool beyondEpsilon;  // coordinates round by more than 1e-4
};

void PrintTo(const Input& input, std::ostream* out) { *out << input.name; }

class LeaveSurfaceTest : public testing::TestWithParam<Input> {};

TEST_P(LeaveSurfaceTest, H7RayDoesNotHitTheSurfaceThatItLeaves)
{
    const Tally tally = leave(GetParam().make(), GetParam().reach, static_cast<std::uint32_t>(hardTrials(samplesFor(300'000, 20))));
    const float offset = std::bit_cast<float>(tally.largestOffset);
    printHardCase("H7", GetParam().name, tally.left,
                  std::to_string(tally.skippedHits) + " meet their triangle (" + std::to_string(tally.selfHits) +
                      " by the offset alone, which is at most " + figure(static_cast<double>(offset)) + " of its size)",
                  "o + t d and t > 1e-4: " + std::to_string(tally.naiveHits) + " meet it");
    EXPECT_GT(tally.left, 100'000U);
    EXPECT_EQ(tally.skippedHits, 0U);
    // With the offset alone 1.3e-5 of the rays meet their triangle; the rule prevents these too.
    EXPECT_LE(tally.selfHits, tally.left / 20'000);
    EXPECT_LE(offset, 5e-6F);
    EXPECT_EQ(tally.naiveHits > tally.left / 100, GetParam().beyondEpsilon);
}

INSTANTIATE_TEST_SUITE_P(Places, LeaveSurfaceTest,
                         testing::Values(Input{"Unit", [] { return randomTriangles(200, 0.5F, 1); }, 0.0F, false},
                                         Input{"Tiny", [] { return placed(randomTriangles(200, 0.5F, 1), 1e-4F, 0.0F); }, 0.0F, false},
                                         Input{"Huge", [] { return placed(randomTriangles(200, 0.5F, 1), 1e5F, 0.0F); }, 0.0F, true},
                                         Input{"At1e4", [] { return placed(randomTriangles(200, 0.5F, 1), 1.0F, 1e4F); }, 0.0F, true},
                                         Input{"At1e6", [] { return placed(randomTriangles(200, 0.5F, 1), 1.0F, 1e6F); }, 0.0F, true},
                                         Input{"Size1e5AtOrigin", [] { return aroundTheOrigin(1e5F); }, 1.0F, true},
                                         Input{"Size1e3AtOrigin", [] { return aroundTheOrigin(1e3F); }, 1.0F, true}),
                         [](const testing::TestParamInfo<Input>& parameter) { return std::string(parameter.param.name); });

// A triangle in pieces has several references, and the ray meets none of them. With the offset alone, rays meet long triangles more often.
TEST(LeavePiecesTest, H7RayHitsNoPieceOfTheTriangleThatItLeaves)
{
    const Tally tally = leave(strips(12, 9), 0.0F, static_cast<std::uint32_t>(hardTrials(samplesFor(300'000, 20))));
    printHardCase("H7", "triangles in pieces", tally.left,
                  std::to_string(tally.skippedHits) + " meet their triangle (" + std::to_string(tally.selfHits) + " by the offset alone)");
    EXPECT_EQ(tally.skippedHits, 0U);
    EXPECT_GT(tally.selfHits, 10U) << "else nothing was tried";
}

// Neighbours and copies in one plane, tilted or along an axis. The rule that a ray skips its own triangle does not cover them: only the
// offset helps.
TEST(CoplanarTest, H7RaysMeetNeitherNeighbourNorCopy)
{
    for (const auto& [scale, tilt] : {std::pair{1e-4F, 1.0F}, {1.0F, 1.0F}, {1e5F, 1.0F}, {1e5F, 1e-5F}, {1e-4F, 0.0F}, {1e6F, 0.0F}}) {
        Triangles plane;
        const glm::vec3 u(0.31F, 0.17F * tilt, -0.23F), v(-0.11F, 0.29F * tilt, 0.05F);
        for (int i = -8; i < 8; ++i) {
            for (int j = -8; j < 8; ++j) {
                const glm::vec3 a = static_cast<float>(i) * u + static_cast<float>(j) * v;
                plane.push_back({{a, a + u, a + v}});
                plane.push_back({{a + u, a + u + v, a + v}});
            }
        }
        const Triangles copies = plane;
        plane.insert(plane.end(), copies.begin(), copies.end());
        for (const FeatureMask features : {kAllFeatures, kAllFeatures & ~kFeatureLargeTriangles}) {
            const auto rays = static_cast<std::uint32_t>(hardTrials(samplesFor(300'000, 20)));
            const Tally tally = leave(placed(plane, scale, 0.0F), 0.0F, rays, features);
            printHardCase("H7",
                          "coplanar neighbours and copies, size " + figure(5.0 * static_cast<double>(scale)) + ", tilt " +
                              figure(static_cast<double>(tilt)) + (features == kAllFeatures ? ", by axes" : ""),
                          tally.left, std::to_string(tally.otherHits) + " meet one");
            EXPECT_LT(tally.otherHits, tally.left / 10'000);
        }
    }
}

}  // namespace glim::leave_surface_test
