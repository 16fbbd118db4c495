// A camera's lens lies in its own plane, wherever the camera points.
#include "host/flatten/flatten_scene.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

void expectVectorNear(const glm::vec3& a, const glm::vec3& b)
{
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(a[k], b[k], 1e-6F) << k;
    }
}

// Looks along +x with its top towards +z, so that its right is -y.
Camera makeCamera(Camera::Kind kind)
{
    Camera camera;
    camera.kind = kind;
    camera.position = {1, 2, 3};
    camera.forward = {1, 0, 0};
    camera.up = {0, 0, 1};
    camera.right = {0, -1, 0};
    camera.yfov = 1.5707963F;
    camera.halfHeight = 4.0F;
    return camera;
}

TEST(FlattenCamera, TheLensIsInTheCamerasPlane)
{
    for (const auto& [kind, height] : {std::pair(Camera::Kind::Perspective, 1.0F), {Camera::Kind::Orthographic, 4.0F}}) {
        const FlatCamera flat = flattenCamera(makeCamera(kind), 2.0F, {0.25F, 8.0F});
        expectVectorNear(flat.lensRight, {0, -0.25F, 0});
        expectVectorNear(flat.lensUp, {0, 0, 0.25F});
        EXPECT_EQ(flat.inverseFocus, 0.125F);
        expectVectorNear(flat.right, {0, -2 * height, 0});
        expectVectorNear(flat.up, {0, 0, height});
        expectVectorNear(flat.forward, {1, 0, 0});
        expectVectorNear(flat.position, {1, 2, 3});
    }
}

TEST(FlattenCamera, WithoutALensItIsAPinhole)
{
    const FlatCamera flat = flattenCamera(makeCamera(Camera::Kind::Perspective), 1.0F);
    EXPECT_EQ(flat.lensRight, glm::vec3(0.0F));
    EXPECT_EQ(flat.lensUp, glm::vec3(0.0F));
    EXPECT_TRUE(std::isfinite(flat.inverseFocus));
}

}  // namespace
}  // namespace glim
