// Motions while the shutter is open: what they are between keys, how closely they follow a file, and boxes around what moves.
#include "host/flatten/flatten_scene.hpp"
#include "host/flatten/place_instances.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/moving_file.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

namespace glim::test {
namespace {

using glm::dmat4;
using glm::dvec3;
using std::numbers::pi;

double largestDifference(const dmat4& a, const dmat4& b)
{
    double largest = 0.0;
    for (int column = 0; column < 4; ++column) {
        largest = std::max(largest, glm::length(a[column] - b[column]));
    }
    return largest;
}

dmat4 turn(double angle, const dvec3& axis) { return glm::rotate(dmat4(1.0), angle, glm::normalize(axis)); }
dmat4 shift(const dvec3& by) { return glm::translate(dmat4(1.0), by); }
dmat4 scale(const dvec3& by) { return glm::scale(dmat4(1.0), by); }

dvec3 placed(const dmat4& by, const dvec3& point) { return dvec3(by * glm::dvec4(point, 1.0)); }

// The transform of a node at a time of the file, as scenes of that time have it.
dmat4 transformInFile(const MovingFile& file, double seconds) { return file.scene(seconds).instances.at(0).worldFromMesh; }

// Over the whole shutter the motion takes the corners of the file's triangle where the file has them, up to `allowed`.
void expectFollows(const MovingFile& file, double at, const Shutter& shutter, double allowed)
{
    const Scene scene = file.scene(at, shutter);
    ASSERT_TRUE(scene.instances.at(0).motion);
    const Motion& motion = *scene.instances[0].motion;
    for (int i = 0; i <= 50; ++i) {
        const double share = (i + 0.37) / 51.0, seconds = at + shutter.open + share * (shutter.close - shutter.open);
        const dmat4 followed = transformAt(motion, share), exact = transformInFile(file, seconds);
        for (const dvec3& corner : {dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0, 1, 0)}) {
            EXPECT_LE(glm::distance(placed(followed, corner), placed(exact, corner)), allowed) << share;
        }
    }
}

TEST(MotionTest, SplitsTransforms)
{
    const dmat4 cases[] = {dmat4(1.0), shift({1, 2, 3}) * turn(2.5, {1, 2, 3}) * scale({2.0, 0.3, 7.0}), scale({-1.0, 2.0, 3.0}),
                           turn(1.0, {0, 1, 0}) * scale({1e-6, 2e-6, 1e-5}),
                           turn(0.7, {1, 0, 0}) * scale({1, 3, 1}) * turn(0.9, {0, 0, 1})};
    for (const dmat4& transform : cases) {
        const MotionKey key = splitTransform(transform);
        EXPECT_LE(largestDifference(transformBetween({key, key}, 0, 0.5), transform), 1e-14 * largestDifference(transform, dmat4(0.0)));
        EXPECT_EQ(key.stretch, glm::transpose(key.stretch));
        EXPECT_GT(glm::determinant(glm::mat3_cast(key.rotation)), 0.0);
    }
}

// What one node does by linear keys needs no keys but those.
TEST(MotionTest, OfANodeIsExact)
{
    MovingFile file;
    file.move("translation", {0.0F, 2.0F}, {0, 0, 0, 4, 0, 1});
    file.move("rotation", {0.0F, 2.0F}, {0, 0, 0, 1, 0, 0, std::sin(1.2F), std::cos(1.2F)});
    file.move("scale", {0.0F, 2.0F}, {1, 1, 1, 2, 0.5F, 3});
    expectFollows(file, 1.0, {-0.5, 0.75}, 1e-9);
    EXPECT_EQ(file.scene(1.0, Shutter{-0.5, 0.75}).instances[0].motion->size(), 3U) << "it opens, the frame, it closes";
}

// Of the triangle's longest side.
constexpr double kAllowed = 1e-4 * std::numbers::sqrt2;

TEST(MotionTest, FollowsHierarchiesAndSplines)
{
    MovingFile arm;
    arm.parent("rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0, std::sin(0.75F), std::cos(0.75F)});
    arm.move("rotation", {0.0F, 1.0F}, {0, 0, 0, 1, std::sin(0.5F), 0, 0, std::cos(0.5F)});
    arm.move("translation", {0.0F, 1.0F}, {1, 0, 0, 1.5F, 0.5F, 0});
    expectFollows(arm, 0.5, {-0.5, 0.5}, kAllowed);
    EXPECT_LT(arm.scene(0.5, Shutter{-0.5, 0.5}).instances[0].motion->size(), 128U);
    MovingFile spline;
    spline.move("translation", {0.0F, 1.0F}, {0, 0, 0, 0, 0, 0, 0, 3, 0, 0, -3, 0, 1, 0, 0, 0, 0, 0}, "CUBICSPLINE");
    expectFollows(spline, 0.5, {-0.5, 0.5}, kAllowed);
}

TEST(MotionTest, KeepsCornersAndJumps)
{
    MovingFile corners;
    corners.move("translation", {0.0F, 0.3F, 0.55F, 1.0F}, {0, 0, 0, 1, 0, 0, 1, 2, 0, 0, 0, 5});
    expectFollows(corners, 0.5, {-0.5, 0.5}, 1e-9);
    EXPECT_EQ(corners.scene(0.5, Shutter{-0.5, 0.5}).instances[0].motion->size(), 5U) << "those, and the frame's time";
    MovingFile jumps;
    jumps.move("translation", {0.0F, 0.25F, 0.5F, 1.0F}, {0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0}, "STEP");
    expectFollows(jumps, 0.0, {0.0, 1.0}, 1e-9);
    EXPECT_EQ(placed(transformAt(*jumps.scene(0.0, Shutter{0.0, 1.0}).instances[0].motion, 1.0 - 1e-9), dvec3(0.0)).x, 2.0)
        << "a jump at the end is no part of it";
}

TEST(MotionTest, OfWhatStandsStillIsNone)
{
    MovingFile file;
    file.move("translation", {0.0F, 1.0F, 2.0F}, {0, 0, 0, 1, 0, 0, 1, 0, 0});
    EXPECT_FALSE(file.scene(1.5, Shutter{-0.25, 0.25}).instances[0].motion);
    EXPECT_TRUE(file.scene(1.0, Shutter{-0.25, 0.25}).instances[0].motion);
    EXPECT_FALSE(file.scene(5.0, Shutter{0.0, 1.0}).instances[0].motion) << "after the last key";
}

// Where the camera of the frame's time is turned and moved to is where the file has it.
TEST(MotionTest, OfACameraIsTheFiles)
{
    MovingFile file;
    file.moveCamera("translation", {0.0F, 1.0F}, {0, 0, 5, 2, 1, 5});
    file.moveCamera("rotation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, std::sin(0.4F), 0, std::cos(0.4F)});
    const Scene scene = file.scene(0.5, Shutter{-0.5, 0.5});
    const Camera& camera = scene.cameras.at(0);
    ASSERT_TRUE(camera.motion);
    for (const double share : {0.0, 0.2, 0.5, 0.9}) {
        const Scene there = file.scene(share);
        const dmat4 moved = transformAt(*camera.motion, share);
        EXPECT_LE(glm::length(dvec3(moved[3]) - (there.origin + dvec3(there.cameras[0].position))), 2e-6);
        EXPECT_LE(glm::length(glm::dmat3(moved) * dvec3(camera.forward) - dvec3(there.cameras[0].forward)), 2e-6);
        EXPECT_LE(glm::length(glm::dmat3(moved) * dvec3(camera.up) - dvec3(there.cameras[0].up)), 2e-6);
    }
}

TEST(MotionTest, NamesWhatStaysSharp)
{
    MovingFile lamp;
    lamp.move("translation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0});
    lamp.document["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    lamp.document["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene sharp = lamp.scene(0.5, Shutter{-0.5, 0.5});
    EXPECT_FALSE(sharp.instances[0].motion);
    EXPECT_TRUE(hasWarning(sharp.warnings, MessageId::StaysSharp, "nodes[1] (\"mover\")"));

    GltfBuilder bent = posedTriangle();
    LoadOptions options;
    options.at = 0.5;
    options.shutter = Shutter{-0.5, 0.5};
    EXPECT_TRUE(hasWarning(load(bent, options).warnings, MessageId::StaysSharp, "nodes["));
    options.at = 50.0;
    options.shutter = Shutter{0.0, 0.5};
    EXPECT_FALSE(hasWarning(load(bent, options).warnings, MessageId::StaysSharp)) << "it has come to rest";

    MovingFile ball;
    ball.move("translation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0});
    ball.document["nodes"][1].erase("mesh");
    ball.document["nodes"][1]["extras"] = {{"sphere", {{"radius", 1.0}}}};
    EXPECT_TRUE(hasWarning(ball.scene(0.5, Shutter{-0.5, 0.5}).warnings, MessageId::StaysSharp, "nodes[1] (\"mover\")"));
}

TEST(MotionTest, IsForWhatHasAPlaceAtEachTime)
{
    MovingFile vanishes, turnsOver, leaves;
    vanishes.move("scale", {0.0F, 0.5F, 1.0F}, {1, 1, 1, 1, 1, 1, 0, 0, 0});
    turnsOver.move("scale", {0.0F, 1.0F}, {1, 1, 1, -0.9F, 1, 1});
    leaves.move("translation", {0.0F, 1.0F}, {0, 0, 0, 1e25F, 0, 0});
    for (const MovingFile* file : {&vanishes, &turnsOver, &leaves}) {
        const Scene scene = file->scene(0.0, Shutter{0.0, 1.0});
        EXPECT_FALSE(scene.instances[0].motion);
        EXPECT_TRUE(hasWarning(scene.warnings, MessageId::StaysSharp, "nodes[1] (\"mover\")"));
    }
}

// Random motions: each point of the box is in the box around all times.
TEST(MotionTest, BoxesHoldAllThatMoves)
{
    Random random(7);
    const auto vector = [&](double size) { return size * (2.0 * dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0); };
    for (int i = 0; i < 200; ++i) {
        Placement placement;
        placement.motion.emplace();
        placement.motion->pivot = vector(i % 2 == 0 ? 0.0 : 3.0);
        for (int key = 0; key < 3; ++key) {
            MotionKey made = splitTransform(shift(vector(5.0)) * turn(3.0 * random.uniform(), vector(1.0)) * scale(1.5 + vector(1.0)));
            made.time = 0.5 * key;
            Motion& keys = placement.motion->keys;
            made.rotation = key > 0 && glm::dot(keys.back().rotation, made.rotation) < 0.0 ? -made.rotation : made.rotation;
            keys.push_back(made);
        }
        const dvec3 low = vector(1.0), high = low + dvec3(random.uniform(), random.uniform(), random.uniform());
        const Box part{glm::vec3(low), glm::vec3(high)};
        const Box box = placeBoxes(placement, std::span(&part, 1));
        double looseness = 0.0;
        for (int k = 0; k < 400; ++k) {
            const dvec3 point = glm::mix(dvec3(part.lo), dvec3(part.hi), dvec3(k & 1, k >> 1 & 1, k >> 2 & 1));
            const dvec3 at = placed(transformAt(placement.motion->keys, random.uniform()), point + placement.motion->pivot);
            ASSERT_TRUE(glm::all(glm::greaterThanEqual(at, dvec3(box.lo))) && glm::all(glm::lessThanEqual(at, dvec3(box.hi)))) << i;
            looseness = std::max(looseness, glm::length(at - 0.5 * dvec3(box.lo + box.hi)));
        }
        EXPECT_GT(looseness, 0.2 * static_cast<double>(glm::length(box.hi - box.lo))) << "not that large";
    }
}

// A mesh of what moves is shared, however small the scene is, and nothing else is.
TEST(MotionTest, SharesTheMeshesThatMove)
{
    MovingFile file;
    file.move("translation", {0.0F, 1.0F}, {0, 0, 0, 1, 0, 0});
    file.addNode({{"mesh", file.addTriangleMesh()}, {"name", "still"}});
    const Scene scene = file.scene(0.5, Shutter{-0.5, 0.5});
    const Primitives primitives = makePrimitives(scene);
    ASSERT_EQ(primitives.placements.size(), 1U);
    EXPECT_EQ(primitives.placements[0].instance, 0U);
    EXPECT_TRUE(primitives.placements[0].motion);
    EXPECT_EQ(primitives.triangles.size(), 1U);
    EXPECT_TRUE(makePrimitives(file.scene(5.0, Shutter{-0.5, 0.5})).placements.empty());
    EXPECT_EQ(compareSurfaces(scene, primitives, file.scene(5.0, Shutter{-0.5, 0.5})), Same::Nothing);
}

}  // namespace
}  // namespace glim::test
