// The framed camera: the box around the scene is in the middle of the picture and fills it up to the margin.
#include "host/scene/frame_camera.hpp"
#include "host/job/picture_options.hpp"
#include "host/scene/pose.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/test_meshes.hpp"

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace glim {
namespace {

struct Extent {
    glm::dvec2 low{1e30}, high{-1e30};
};

// Of the corners of [low, high] in the picture, from -1 to 1 on each axis.
Extent seen(const Camera& camera, const glm::dvec3& low, const glm::dvec3& high, double aspectRatio)
{
    Extent extent;
    const double slope = std::tan(0.5 * static_cast<double>(camera.yfov));
    for (unsigned i = 0; i < 8; ++i) {
        const glm::dvec3 corner((i & 1U) != 0 ? high.x : low.x, (i & 2U) != 0 ? high.y : low.y, (i & 4U) != 0 ? high.z : low.z);
        const glm::dvec3 way = corner - glm::dvec3(camera.position);
        const double depth = glm::dot(way, glm::dvec3(camera.forward));
        EXPECT_GT(depth, 0.0);
        const glm::dvec2 at(glm::dot(way, glm::dvec3(camera.right)) / (depth * slope * aspectRatio),
                            glm::dot(way, glm::dvec3(camera.up)) / (depth * slope));
        extent.low = glm::min(extent.low, at);
        extent.high = glm::max(extent.high, at);
    }
    return extent;
}

TEST(FrameCamera, CentresAndFillsWhateverTheShape)
{
    for (const glm::vec3& half : {glm::vec3(1, 1, 1), glm::vec3(8, 1, 1), glm::vec3(1, 9, 1), glm::vec3(1, 1, 20), glm::vec3(5, 0.01F, 5),
                                  glm::vec3(1e-4F, 2e-4F, 1e-4F), glm::vec3(0.001F, 40, 0.001F)}) {
        Triangles box = sliverBox(2);
        for (Triangle& triangle : box) {
            for (glm::vec3& vertex : triangle.vertices) {
                vertex = half * vertex + 3.0F * half;
            }
        }
        const Scene scene = makeTestScene(box);
        for (const auto& [aspectRatio, yfov] :
             {std::pair(0.25F, 0.7F), {1.0F, 0.7F}, {1.7F, 0.7F}, {5.0F, 0.7F}, {1.7F, 0.1F}, {0.6F, 2.0F}}) {
            const Camera camera = frameCamera(scene, aspectRatio, yfov);
            EXPECT_EQ(camera.yfov, yfov);
            const Extent extent = seen(camera, 2.0F * half, 4.0F * half, static_cast<double>(aspectRatio));
            const double fills = std::max(extent.high.x, extent.high.y);
            EXPECT_NEAR(extent.high.x, -extent.low.x, 1e-5) << half.x << ' ' << half.y << ' ' << half.z << ", " << aspectRatio;
            EXPECT_NEAR(extent.high.y, -extent.low.y, 1e-5) << half.x << ' ' << half.y << ' ' << half.z << ", " << aspectRatio;
            EXPECT_NEAR(fills, 0.9, 1e-5) << half.x << ' ' << half.y << ' ' << half.z << ", " << aspectRatio;
        }
    }
}

// What is flat and more than five times as long as all that stands on it is a ground. It changes neither camera nor turntable.
TEST(FrameCamera, HugeGroundsAreLeftOut)
{
    const auto standing = [](float groundSize) {
        Triangles box = sliverBox(2);
        Scene scene = makeTestScene(box);
        if (groundSize > 0.0F) {
            const float g = groundSize;
            addMesh(scene, {{{glm::vec3(-g, -1, g), {g, -1, g}, {g, -1, -g}}}, {{glm::vec3(-g, -1, g), {g, -1, -g}, {-g, -1, -g}}}});
        }
        return scene;
    };
    const Camera without = frameCamera(standing(0.0F), 1.5F);
    const Pose turned = frameTurntable(standing(0.0F), 1.5F, 4)[1];
    for (const float huge : {6.0F, 1000.0F}) {
        EXPECT_EQ(frameCamera(standing(huge), 1.5F).position, without.position) << huge;
        EXPECT_EQ(frameTurntable(standing(huge), 1.5F, 4)[1].from, turned.from) << huge;
    }
    EXPECT_GT(glm::length(frameCamera(standing(4.0F), 1.5F).position), 1.5F * glm::length(without.position)) << "a floor";
    Scene sphere = standing(1000.0F);
    sphere.instances.erase(sphere.instances.begin());
    sphere.spheres.push_back({"", {0, 0, 0}, 1.0F, 0});
    EXPECT_LT(glm::length(frameCamera(sphere, 1.5F).position), 10.0F);
    Scene ground = standing(1000.0F);
    ground.instances.erase(ground.instances.begin());
    EXPECT_GT(glm::length(frameCamera(ground, 1.5F).position), 1000.0F) << "alone it is the subject";
}

// As the spheres that they are drawn as.
TEST(FrameCamera, PointsAreFramedWithTheirRadii)
{
    Scene cloud, spheres;
    cloud.materials.resize(1);
    Mesh mesh;
    mesh.isCloud = true;
    mesh.pointRadius = 0.5;
    mesh.positions = {{1, 2, 3}, {-1, 5, 0}, {0, 0, 2}};
    for (const glm::dvec3& position : mesh.positions) {
        spheres.spheres.push_back({"", position, 0.5F, 0});
    }
    cloud.meshes.change().push_back(mesh);
    cloud.instances.push_back({"cloud", 0});
    EXPECT_EQ(frameCamera(cloud, 1.5F).position, frameCamera(spheres, 1.5F).position);
    EXPECT_EQ(frameTurntable(cloud, 1.5F, 4)[1].from, frameTurntable(spheres, 1.5F, 4)[1].from);
}

// The box turns about its axis. From every side it is within the margin, and from one it reaches it.
TEST(FrameCamera, TurntablesShowTheBoxFromEverySide)
{
    constexpr std::uint32_t kPictures = 360;
    for (const glm::vec3& half : {glm::vec3(1, 1, 1), glm::vec3(8, 1, 1), glm::vec3(1, 9, 1), glm::vec3(5, 0.01F, 2)}) {
        Triangles box = sliverBox(2);
        for (Triangle& triangle : box) {
            for (glm::vec3& vertex : triangle.vertices) {
                vertex *= half;
            }
        }
        Scene scene = makeTestScene(box);
        scene.origin = {1000.0, 0.0, -7.0};
        scene.instances[0].worldFromMesh = glm::translate(glm::dmat4(1.0), scene.origin);
        for (const float aspectRatio : {0.5F, 1.7F}) {
            const std::vector<Pose> poses = frameTurntable(scene, aspectRatio, kPictures);
            ASSERT_EQ(poses.size(), kPictures);
            double farthest = 0.0;
            for (const Pose& pose : poses) {
                const Camera camera = placeCamera(Camera(), pose, scene.origin);
                const Extent extent = seen(camera, -half, half, static_cast<double>(aspectRatio));
                farthest = std::max({farthest, extent.high.x, -extent.low.x, extent.high.y, -extent.low.y});
                EXPECT_NEAR(glm::length(pose.from - scene.origin), glm::length(poses[0].from - scene.origin), 1e-9);
            }
            EXPECT_LT(farthest, 0.9 + 1e-5) << half.x << ' ' << half.y << ' ' << half.z << ", " << aspectRatio;
            EXPECT_GT(farthest, 0.895) << half.x << ' ' << half.y << ' ' << half.z << ", " << aspectRatio;
            const glm::dvec3 first = poses[0].from - scene.origin, quarter = poses[kPictures / 4].from - scene.origin;
            EXPECT_NEAR(quarter.x, first.z, 1e-9);  // counter-clockwise from above: from +z to +x
            EXPECT_NEAR(quarter.z, -first.x, 1e-9);
        }
    }
}

TEST(FrameCamera, IsThereForFilesWithCamerasIfAskedFor)
{
    test::GltfBuilder builder;
    builder.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
    builder.addNode({{"mesh", builder.addTriangleMesh()}});
    builder.addNode({{"camera", 0}});
    EXPECT_EQ(test::load(builder).cameras.size(), 1U);
    LoadOptions options;
    options.framed = true;
    const Scene scene = test::load(builder, options);
    ASSERT_EQ(scene.cameras.size(), 2U);
    EXPECT_EQ(scene.cameras[1].name, "framed");
}

// The angle of a framed camera is that of the part of its picture that is symmetric about the axis.
TEST(FrameCamera, KnowsIntrinsics)
{
    PictureOptions options;
    options.size = {640, 480};
    options.projection.intrinsics = Intrinsics{{600.0, 500.0}, {300.0, 260.0}};
    const LoadOptions load = makeLoadOptions(options);
    EXPECT_FLOAT_EQ(load.yfov, static_cast<float>(2.0 * std::atan(220.0 / 500.0)));
    EXPECT_FLOAT_EQ(load.aspectRatio, (300.0F / 600.0F) / (220.0F / 500.0F));
    options.projection.intrinsics->center = {-5.0, 260.0};
    EXPECT_FLOAT_EQ(makeLoadOptions(options).aspectRatio, 4.0F / 3.0F) << "no such part";
}

}  // namespace
}  // namespace glim
