// H1: rays from inside a closed mesh, aimed where Moller and Trumbore's test leaks.
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>

#include <ostream>

namespace glim::watertight_test {

struct Setup {
    vec3 center;
    float scale;
    float tolerance;
    float noise;
};

struct Tally {
    uint rays[3];
    uint misses[3];
    uint astray[3];
};

struct Place {
    float scale, shift;  // the mesh lies at scale * (shift + [-1, 1]^3)
};

void PrintTo(const Place& place, std::ostream* out) { *out << "scale " << place.scale << " shift " << place.shift; }

struct Closed {
    Triangles mesh;
    float noise;  // 0 where the triangles are round enough for it not to matter
};

Tally shoot(const Closed& closed, const Place& place, bool mollerTrumbore)
{
    const Triangles triangles = placed(closed.mesh, place.scale, place.shift);
    const SceneOnDevice scene(makeTestScene(triangles), makeTestPrimitives(triangles));
    // Far from the origin the mesh is rounded to a grid of 1e-3 of its size, and no longer quite convex.
    const float tolerance = place.scale * (place.shift > 0.0F ? 2e-2F : 1e-5F);
    KernelTest test = scene.test(mollerTrumbore ? test_kernels::course_watertight_test : test_kernels::watertight_test);
    test.cases(std::vector<Setup>{{vec3(place.scale * place.shift), place.scale, tolerance, closed.noise}});
    test.resultsOf<Tally>(1);
    if (mollerTrumbore) {
        test.specialize(kSpecMollerTrumbore, 1);
    }
    // Whole workgroups, so that every thread is a ray.
    test.threads(static_cast<std::uint32_t>(hardTrials(samplesFor(90'048, 25)))).run();
    const Tally tally = test.results<Tally>()[0];
    const std::string leaks = "leaks at edges, vertices, along axes " + std::to_string(tally.misses[0]) + ", " +
                              std::to_string(tally.misses[1]) + ", " + std::to_string(tally.misses[2]);
    printHardCase("H1",
                  std::to_string(closed.mesh.size()) + " triangles in a tree, scale " + figure(static_cast<double>(place.scale)) +
                      ", shift " + figure(static_cast<double>(place.shift)),
                  tally.rays[0] + tally.rays[1] + tally.rays[2], mollerTrumbore ? "" : leaks,
                  mollerTrumbore ? "Moller and Trumbore: " + leaks : "");
    return tally;
}

class WatertightTest : public testing::TestWithParam<Place> {};

TEST_P(WatertightTest, H1NoRayLeavesAClosedMesh)
{
    // An edge function is a difference of two products of three roundings each: 6 * 2^-24.
    for (const Closed& closed :
         {Closed{icosphere(4), 0.0F}, Closed{sliverBox(150), 6 * 0x1p-24F}, Closed{aslantPrism(24, 12), 6 * 0x1p-24F}}) {
        const Tally tally = shoot(closed, GetParam(), false);
        for (int kind = 0; kind < 3; ++kind) {
            EXPECT_EQ(tally.misses[kind], 0U) << closed.mesh.size() << " triangles, kind " << kind;
            EXPECT_EQ(tally.astray[kind], 0U) << closed.mesh.size() << " triangles, kind " << kind;
            EXPECT_GT(tally.rays[kind], 30'000U);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Places, WatertightTest,
                         testing::Values(Place{1e-4F, 0.0F}, Place{1.0F, 0.0F}, Place{1e5F, 0.0F}, Place{1e-4F, 1e4F}, Place{1.0F, 1e4F},
                                         Place{1e5F, 1e4F}));

// Shows that the test above can fail.
TEST(MollerTrumboreTest, H1LeaksAtEdgesAndVertices)
{
    const Tally tally = shoot({icosphere(4), 0.0F}, {1.0F, 0.0F}, true);
    EXPECT_GT(tally.misses[0], tally.rays[0] / 50);
    EXPECT_GT(tally.misses[1], tally.rays[1] / 50);
}

}  // namespace glim::watertight_test
