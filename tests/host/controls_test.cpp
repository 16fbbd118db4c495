// What the mouse and the keys do to a camera.
#include "host/preview/controls.hpp"
#include "host/flatten/camera_options.hpp"
#include "host/preview/viewpoint.hpp"

#include "host/error.hpp"
#include "tests/support/expect_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glim {
namespace {

const Pose kPose{{3.0, 2.0, 6.0}, {1.0, 1.0, -1.0}, {0.0, 1.0, 0.0}, 1.0};

double distanceOf(const Pose& pose) { return glm::length(pose.at - pose.from); }

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double within = 1e-12)
{
    EXPECT_LE(glm::length(a - b), within) << a.x << " " << a.y << " " << a.z;
}

TEST(Controls, OrbitGoesRoundWhatIsLookedAt)
{
    const Pose half = orbit(kPose, {200.0, 0.0}, 200.0);  // the picture's height: half a turn
    expectNear(half.at, kPose.at);
    expectNear(half.from, {2.0 * kPose.at.x - kPose.from.x, kPose.from.y, 2.0 * kPose.at.z - kPose.from.z}, 1e-9);
    // Dragging to the right turns the scene to the right: the camera goes to its left.
    const Pose front{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1.0};
    EXPECT_LT(orbit(front, {10.0, 0.0}, 200.0).from.x, 0.0);
    EXPECT_GT(orbit(front, {0.0, 10.0}, 200.0).from.y, 0.0) << "dragging down shows the scene from above";
    for (const double y : {-1e4, -30.0, 30.0, 1e4}) {
        const Pose turned = orbit(kPose, {13.0, y}, 200.0);
        EXPECT_NEAR(distanceOf(turned), distanceOf(kPose), 1e-9);
        EXPECT_GT(glm::length(glm::cross(glm::normalize(turned.at - turned.from), turned.up)), 1e-3) << "never over a pole";
    }
}

TEST(Controls, PanMovesBothByPixels)
{
    const Pose front{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1.0};
    const Pose moved = pan(front, {10.0, 4.0}, 0.1);  // the scene follows the mouse: right and down
    expectNear(moved.from, {-1.0, 0.4, 5.0});
    expectNear(moved.at, {-1.0, 0.4, 0.0});
}

TEST(Controls, DollyTakesATenthOfTheDistance)
{
    EXPECT_NEAR(distanceOf(dolly(kPose, 1.0, Camera::Kind::Perspective)), 0.9 * distanceOf(kPose), 1e-12);
    EXPECT_NEAR(distanceOf(dolly(dolly(kPose, 3.0, Camera::Kind::Perspective), -3.0, Camera::Kind::Perspective)), distanceOf(kPose), 1e-12);
    Pose near = kPose;
    for (int i = 0; i < 1000; ++i) {
        near = dolly(near, 1.0, Camera::Kind::Perspective);
    }
    EXPECT_GT(distanceOf(near), 0.0);
    const Pose zoomed = dolly(kPose, 1.0, Camera::Kind::Orthographic);
    expectNear(zoomed.from, kPose.from);
    EXPECT_NEAR(zoomed.zoom, 1.0 / 0.9, 1e-12);
}

TEST(Controls, FlyGoesAlongTheViewsAxes)
{
    const Pose front{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 1.0};
    expectNear(fly(front, {1.0, 2.0, 3.0}).from, {1.0, 2.0, 2.0});
    expectNear(fly(front, {1.0, 2.0, 3.0}).at, {1.0, 2.0, -3.0});
}

// The sphere just fits into the narrower field of view.
TEST(Controls, FrameSeesTheWholeSphere)
{
    Camera camera;
    camera.yfov = 1.0F;
    const BoundingSphere bounds{{4.0, 5.0, 6.0}, 2.0};
    for (const double aspect : {0.5, 1.0, 2.0}) {
        const Pose framed = frame(kPose, bounds, camera, aspect);
        const double half = std::atan(std::tan(0.5) * std::min(1.0, aspect));
        EXPECT_NEAR(std::asin(bounds.radius / distanceOf(framed)), half, 1e-6);
        expectNear(framed.at, bounds.center);
        expectNear(glm::normalize(framed.at - framed.from), glm::normalize(kPose.at - kPose.from));
    }
    camera.kind = Camera::Kind::Orthographic;
    camera.halfHeight = 8.0F;
    EXPECT_NEAR(8.0 / frame(kPose, bounds, camera, 1.0).zoom, bounds.radius, 1e-12);
}

TEST(PoseTest, PlacesCamerasFarFromTheOrigin)
{
    const glm::dvec3 origin(1e9, 0.0, -1e9);
    const Pose pose{origin + glm::dvec3(0, 0, 5), origin, {0, 1, 0}, 2.0};
    Camera camera;
    camera.yfov = 1.0F;
    const Camera placed = placeCamera(camera, pose, origin);
    EXPECT_EQ(placed.position, glm::vec3(0, 0, 5));
    EXPECT_EQ(placed.forward, glm::vec3(0, 0, -1));
    EXPECT_EQ(placed.right, glm::vec3(1, 0, 0));
    EXPECT_EQ(placed.up, glm::vec3(0, 1, 0));
    EXPECT_NEAR(static_cast<double>(std::tan(0.5F * placed.yfov)), 0.5 * std::tan(0.5), 1e-6);
}

TEST(PoseTest, RefusesNoDirection)
{
    using test::expectRefusal;
    expectRefusal<InputError>(
        [] {
            placeCamera({}, {{1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 1.0}, {});
        },
        MessageId::Degenerate, {.place = "--look-at"});
    expectRefusal<InputError>(
        [] {
            placeCamera({}, {{0, 5, 0}, {0, 0, 0}, {0, 1, 0}, 1.0}, {});
        },
        MessageId::Degenerate, {.place = "--look-up"});
    expectRefusal<InputError>(
        [] {
            placeCamera({}, {{0, 5, 0}, {0, 0, 0}, {0, 0, 0}, 1.0}, {});
        },
        MessageId::Degenerate, {.place = "--look-up"});
}

// A level camera stays level when it is turned; one that is rolled keeps its roll.
TEST(PoseTest, IsTheCamerasOwn)
{
    Camera camera;
    camera.position = {1, 2, 3};
    const glm::vec3 forward = glm::normalize(glm::vec3(0.3F, -0.4F, -1.0F));
    camera.forward = forward;
    camera.right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    camera.up = glm::cross(camera.right, forward);
    EXPECT_EQ(computePose(camera, 2.0, {}).up, glm::dvec3(0, 1, 0));
    std::swap(camera.right, camera.up);
    camera.right = -camera.right;
    EXPECT_EQ(computePose(camera, 2.0, {}).up, glm::dvec3(camera.up));
    const Camera again = placeCamera(camera, computePose(camera, 2.0, {}), {});
    expectNear(again.forward, camera.forward, 1e-6);
    expectNear(again.up, camera.up, 1e-6);
    expectNear(again.position, camera.position, 0.0);
}

Scene twoCameras()
{
    Scene scene;
    scene.spheres = {{"ball", {1, 0, 0}, 2.0F, 0}};
    scene.cameras.resize(2);
    scene.cameras[0].position = {1, 0, 10};
    scene.cameras[1].position = {1, 0, -10};
    scene.cameras[1].forward = {0, 0, 1};
    scene.cameras[1].right = {-1, 0, 0};
    return scene;
}

TEST(ViewpointTest, IsTheFilesCameraUntilItMoves)
{
    Viewpoint viewpoint(0, std::nullopt);
    viewpoint.enter(twoCameras());
    EXPECT_FALSE(viewpoint.moved());
    EXPECT_EQ(viewpoint.camera({4, 3}).position, glm::vec3(1, 0, 10));
    expectNear(viewpoint.pose().at, {1, 0, 0});
    viewpoint.move(fly(viewpoint.pose(), {0, 0, 1}));
    EXPECT_EQ(viewpoint.camera({4, 3}).position, glm::vec3(1, 0, 9));
    EXPECT_EQ(cameraOptions(viewpoint.moved(), {}, {}), (OptionTexts{{"look-from", "1,0,9"}, {"look-at", "1,0,-1"}, {"look-up", "0,1,0"}}));
    EXPECT_FALSE(viewpoint.choose(2));
    EXPECT_TRUE(viewpoint.choose(1));
    EXPECT_FALSE(viewpoint.moved());
    EXPECT_EQ(viewpoint.index(), 1U);
    viewpoint.reset();
    EXPECT_EQ(viewpoint.index(), 0U);
}

// The sphere around the ball has a radius of 2 sqrt(3).
TEST(ViewpointTest, KeysFlyWhileTheyAreHeld)
{
    using namespace std::chrono_literals;
    Viewpoint viewpoint(0, std::nullopt);
    viewpoint.enter(twoCameras());
    const Viewpoint::Time start = Viewpoint::Time::clock::now();
    viewpoint.fly(start);
    EXPECT_FALSE(viewpoint.hasMoved());
    EXPECT_TRUE(viewpoint.press('W', 1.0));
    EXPECT_TRUE(viewpoint.press('E', 1.0));
    EXPECT_FALSE(viewpoint.press('V', 1.0)) << "is not the camera's";
    EXPECT_TRUE(viewpoint.isFlying());
    viewpoint.fly(start + 50ms);
    EXPECT_TRUE(viewpoint.hasMoved());
    const double step = 0.05 * std::sqrt(3.0);
    expectNear(viewpoint.pose().from, {1, step, 10 - step}, 1e-6);
    viewpoint.fly(start + 1h);
    expectNear(viewpoint.pose().from, {1, 3.0 * step, 10 - 3.0 * step}, 1e-6);  // a tenth of a second at most
    viewpoint.see();
    viewpoint.release('E');
    viewpoint.press('S', 1.0);
    viewpoint.fly(start + 2h);
    EXPECT_FALSE(viewpoint.hasMoved()) << "there and back";
    viewpoint.releaseAll();
    EXPECT_FALSE(viewpoint.isFlying());
}

TEST(ViewpointTest, FollowsTheMouse)
{
    Viewpoint viewpoint(0, std::nullopt);
    viewpoint.enter(twoCameras());
    const Pose before = viewpoint.pose();
    viewpoint.follow({.kind = Gesture::Kind::Click}, 100.0);
    EXPECT_FALSE(viewpoint.hasMoved());
    viewpoint.follow({.kind = Gesture::Kind::Orbit, .motion = {100.0, 0.0}}, 100.0);
    expectNear(viewpoint.pose().from, {1, 0, -10}, 1e-9);
    EXPECT_TRUE(viewpoint.hasMoved());
    viewpoint.follow({.kind = Gesture::Kind::Dolly, .notches = 1.0}, 100.0);
    expectNear(viewpoint.pose().from, {1, 0, -9}, 1e-9);
    viewpoint.press('R', 1.0);
    viewpoint.follow({.kind = Gesture::Kind::Pan, .motion = {0.0, 100.0}}, 100.0);
    expectNear(viewpoint.pose().at, before.at + glm::dvec3(0, 2.0 * std::tan(0.35) * 10.0, 0), 1e-5);  // by the picture's height
}

// A K is one of pixels: a larger window shows more.
TEST(ViewpointTest, HasAProjection)
{
    Scene scene = twoCameras();
    scene.cameras[1].kind = Camera::Kind::Orthographic;
    const Projection lens{Projection::Model::RadialTangential, Intrinsics{{50, 25}, {40, 30}}, {0.1, 0}, {-0.1}};
    Viewpoint viewpoint(0, std::nullopt, {}, lens);
    viewpoint.enter(scene);
    Projection expected = lens;
    expected.intrinsics->size = {80, 60};
    EXPECT_EQ(viewpoint.camera({80, 60}).projection, expected);
    EXPECT_FLOAT_EQ(viewpoint.camera({80, 60}).yfov, 2.0F * std::atan(30.0F / 25.0F)) << "by which F frames the scene";
    expected.intrinsics->size = {160, 120};
    EXPECT_EQ(viewpoint.camera({160, 120}).projection, expected);
    const Pose before = viewpoint.pose();
    viewpoint.follow({.kind = Gesture::Kind::Pan, .motion = {0.0, 100.0}}, 100.0);
    expectNear(viewpoint.pose().at, before.at + glm::dvec3(0, 4.0 * 10.0, 0), 1e-5);  // 100 pixels are 100 / 25 of the distance
    viewpoint.choose(1);
    Projection shifted;
    shifted.shift = {0.1, 0};
    EXPECT_EQ(viewpoint.camera({80, 60}).projection, shifted) << "an orthographic camera";
    Viewpoint around(1, std::nullopt, {}, {Projection::Model::Equirectangular});
    around.enter(scene);
    EXPECT_EQ(around.camera({80, 40}).projection.model, Projection::Model::Equirectangular);
}

TEST(ViewOptionsTest, AreExact)
{
    EXPECT_EQ(cameraOptions(std::nullopt, {}, {}), OptionTexts());
    EXPECT_EQ(cameraOptions(std::nullopt, {35.5, 2.0}, {}), (OptionTexts{{"fov", "35.5"}, {"zoom", "2"}}));
    const Pose pose{{0.1, 1e-7, -3}, {1.0 / 3.0, 0, 0}, {0, 0, 1}, 2.5};
    EXPECT_EQ(cameraOptions(pose, {}, {0.1F, 3.0F}), (OptionTexts{{"look-from", "0.1,1e-07,-3"},
                                                                  {"look-at", "0.3333333333333333,0,0"},
                                                                  {"look-up", "0,0,1"},
                                                                  {"zoom", "2.5"},
                                                                  {"lens-radius", "0.1"},
                                                                  {"focal-distance", "3"}}));
    EXPECT_EQ(describeCamera(pose, {}, {}), " look-from=0.1,1e-07,-3 look-at=0.3333333333333333,0,0 look-up=0,0,1 zoom=2.5");
    const Projection lens{Projection::Model::Fisheye, Intrinsics{{600.5, 601}, {320, 240}, {640, 480}}, {0.1, 0}, {0.25, 0, 0, -1}};
    EXPECT_EQ(describeCamera(std::nullopt, {}, {}, lens), " intrinsics=600.5,601,320,240 shift=0.1,0 fisheye=0.25,0,0,-1");
    EXPECT_EQ(describeCamera(pose, {20.0, 2.0}, {}), " look-from=0.1,1e-07,-3 look-at=0.3333333333333333,0,0 look-up=0,0,1 fov=20 zoom=5");
}

// A camera that the user has moved stays where it is when the scene's file changes.
TEST(ViewpointTest, StaysInAnotherScene)
{
    Viewpoint viewpoint(1, std::nullopt);
    viewpoint.enter(twoCameras());
    viewpoint.move(fly(viewpoint.pose(), {0, 1, 0}));
    Scene other = twoCameras();
    other.origin = {100, 0, 0};
    viewpoint.enter(other);
    EXPECT_EQ(viewpoint.camera({4, 3}).position, glm::vec3(-99, 1, -10));
    other.cameras.resize(1);
    viewpoint.enter(other);
    EXPECT_EQ(viewpoint.camera({4, 3}).position, glm::vec3(-99, 1, -10));
}

}  // namespace
}  // namespace glim
