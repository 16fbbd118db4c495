// H1 and H7 with the mesh as instances: turned, mirrored, of other proportions, small, large and far away.
#include "host/flatten/place_instances.hpp"
#include "shaders/shared/bindings.h"
#include "test_kernels.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"
#include "tests/support/scene_on_device.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <bit>
#include <ostream>

namespace glim::instances_test {

struct Tally {
    uint rays[3];
    uint misses[3];
    uint astray[3];
    uint grazing;
    uint lost;
    uint again;
    uint largestOffset;
    uint wrongSide;
};

// Eight instances in a row along x, as far from each other as they are large.
struct Row {
    const char* name;
    glm::dvec3 scale;
    glm::dvec3 first;        // where the first one stands
    float tolerance;         // in sizes of the instance
    glm::dvec3 origin{0.0};  // of the scene
    double angle = 0.7;      // times the instance's number: the turn
    bool sharedStack = false;
    bool moves = false;  // as far as each instance has room
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.name; }

// Turns, grows unevenly, and goes on by up to `way` on each axis.
Motion moved(const glm::dmat4& from, double way)
{
    Motion motion{splitTransform(from)};
    for (int i = 1; i <= 2; ++i) {
        const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 1.2 * i, glm::normalize(glm::dvec3(i, -1.0, 2.0)));
        glm::dmat4 next = turned * glm::scale(glm::dmat4(glm::dmat3(from)), glm::dvec3(1.0 + 0.1 * i, 1.0 - 0.2 * i, 1.0));
        next[3] = from[3] + glm::dvec4(0.5 * way * glm::dvec3(i, -i, 1.0), 0.0);
        MotionKey key = splitTransform(next);
        key.time = 0.5 * i;
        key.rotation = glm::dot(motion.back().rotation, key.rotation) < 0.0 ? -key.rotation : key.rotation;
        motion.push_back(key);
    }
    return motion;
}

Scene rowOf(const Triangles& mesh, const Row& row)
{
    Scene scene = makeTestScene(mesh);
    scene.instances.clear();
    scene.origin = row.origin;
    const double step = 8.0 * std::max({std::abs(row.scale.x), std::abs(row.scale.y), std::abs(row.scale.z)});
    for (int i = 0; i < 8; ++i) {
        const glm::dmat4 at = glm::translate(glm::dmat4(1.0), row.first + glm::dvec3(i * step, 0.0, 0.0));
        const glm::dmat4 turned = glm::rotate(at, row.angle * (1.0 + i), glm::normalize(glm::dvec3(1.0, 2.0 - 0.3 * i, 0.5)));
        scene.instances.push_back({"", 0, glm::scale(turned, row.scale)});
        if (row.moves) {
            scene.instances.back().motion = std::make_shared<const Motion>(moved(scene.instances.back().worldFromMesh, 0.1 * step));
        }
    }
    return scene;
}

Tally shoot(const Triangles& mesh, const Row& row)
{
    const Scene scene = rowOf(mesh, row);
    const SceneOnDevice onDevice(scene, makePrimitives(scene, 0));
    EXPECT_EQ(onDevice.flat.instances.size(), 8U * kInstanceTexels);
    EXPECT_EQ(onDevice.flat.primitiveRefs.size() / kPrimitiveRefTexels, onDevice.bvh.order.size());
    KernelTest test = onDevice.test(test_kernels::instances_test);
    test.specialize(kSpecSharedStack, row.sharedStack);
    test.cases(std::vector<float>{row.tolerance}).resultsOf<Tally>(1);
    test.threads(static_cast<std::uint32_t>(hardTrials(samplesFor(90'048, 25)))).run();
    return test.results<Tally>()[0];
}

class InstancesTest : public testing::TestWithParam<Row> {};

TEST_P(InstancesTest, H1H7NoRayLeavesAnInstanceAndNoneComesBack)
{
    for (const Triangles& mesh : {icosphere(4), sliverBox(150)}) {
        const Tally tally = shoot(mesh, GetParam());
        printHardCase("H1", "instances of " + std::to_string(mesh.size()) + " triangles, " + GetParam().name,
                      tally.rays[0] + tally.rays[1] + tally.rays[2],
                      "leaks at edges, vertices, elsewhere " + std::to_string(tally.misses[0]) + ", " + std::to_string(tally.misses[1]) +
                          ", " + std::to_string(tally.misses[2]) + "; of " + std::to_string(tally.grazing) + " that graze it " +
                          std::to_string(tally.lost) + " are lost, " + std::to_string(tally.again) + " leave and meet it again");
        for (int kind = 0; kind < 3; ++kind) {
            EXPECT_GT(tally.rays[kind], 30'000U);
            EXPECT_EQ(tally.misses[kind], 0U) << "kind " << kind;
            // Rounding moves hits along needles.
            EXPECT_LE(tally.astray[kind], mesh.size() == 5120 ? 0U : tally.rays[kind] / 100) << "kind " << kind;
        }
        EXPECT_GT(tally.grazing, 1000U);
        EXPECT_EQ(tally.lost, 0U);
        EXPECT_EQ(tally.wrongSide, 0U);
        EXPECT_EQ(tally.again, 0U);
        EXPECT_LE(std::bit_cast<float>(tally.largestOffset), 4.0F);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Rows, InstancesTest,
    testing::Values(Row{"AsTheyAre", glm::dvec3(1.0), glm::dvec3(0.0), 1e-5F},
                    Row{"SharedStack", glm::dvec3(1.0), glm::dvec3(0.0), 1e-5F, {0, 0, 0}, 0.7, true},
                    Row{"Mirrored", {1, 1, -1}, {0, 0, 0}, 1e-5F},
                    // 1,300 m from the origin rays round by 6e-5 m, which is 6e-4 of a thickness of .1, and that much of the length.
                    Row{"OtherProportions", {1, 20, 0.1}, {0, 0, 0}, 3e-3F}, Row{"MirroredProportions", {-3, 0.2, 1}, {0, 0, 0}, 1e-4F},
                    Row{"Small", glm::dvec3(1e-4), {0, 0, 0}, 1e-5F}, Row{"Large", glm::dvec3(1e4), {0, 0, 0}, 1e-5F},
                    Row{"Far", glm::dvec3(1.0), {1e4, -3e4, 2e4}, 1e-2F},
                    Row{"VeryFar", glm::dvec3(1e3), {1e9, 1e9, -1e9}, 1e-5F, {1e9, 1e9, -1e9}},
                    Row{"Moving", {0.7, 1.3, 1.1}, glm::dvec3(0.0), 1e-5F, {0, 0, 0}, 0.7, false, true},
                    Row{"MovingProportions", {-3, 0.2, 1}, {0, 0, 0}, 1e-4F, {0, 0, 0}, 0.7, false, true},
                    Row{"MovingSmall", glm::dvec3(1e-4), {0, 0, 0}, 1e-5F, {0, 0, 0}, 0.7, false, true},
                    Row{"MovingFar", glm::dvec3(1.0), {1e4, -3e4, 2e4}, 1e-2F, {0, 0, 0}, 0.7, false, true},
                    Row{"FarAndUpright", {0.7, 1.3, 1.1}, {1e4, -3e4, 2e4}, 1e-2F, {0, 0, 0}, 0.0}),
    [](const auto& test) { return test.param.name; });

}  // namespace glim::instances_test
