#include "host/flatten/start_media.hpp"
#include "test_kernels.hpp"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/scene_on_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace glim::start_media_test {

struct Case {
    glm::vec3 point;
    uint media;
};

constexpr float kHalf = 2.0F;                   // of a cube
constexpr float kRadii[] = {1.0F, 0.7F, 0.4F};  // of a ball in it, of one in the ball, and of one in that
constexpr float kIors[] = {1.5F, 1.4F, 1.5F};
const glm::vec3 kCenter(0.5F, 0.0F, 0.0F);

Scene nestedSolids()
{
    SceneBuilder builder;
    builder.cube(kHalf, builder.glass(1.3F), false);
    for (std::size_t i = 0; i < std::size(kRadii); ++i) {
        builder.sphere(kCenter, kRadii[i], builder.glass(kIors[i]));
    }
    builder.quad({glm::vec3(-1, 1, 1), {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}}, builder.lambert(glm::vec3(0.5F)));  // no solid
    return builder.scene();
}

// Innermost first; 0 where the point is too near to a surface to tell.
std::optional<uint> mediaAt(const glm::vec3& p, const std::vector<std::uint32_t>& media)
{
    constexpr float kNear = 1e-3F;
    const glm::vec3 a = glm::abs(p);
    const float fromCube = std::max({a.x, a.y, a.z}) - kHalf, fromCenter = glm::distance(p, kCenter);
    if (std::abs(fromCube) < kNear || std::ranges::any_of(kRadii, [&](float r) { return std::abs(fromCenter - r) < kNear; })) {
        return std::nullopt;
    }
    uint word = fromCube < 0.0F ? media[0] : 0;
    for (std::size_t i = 0; i < std::size(kRadii); ++i) {
        word = fromCenter < kRadii[i] ? word << kMediumBits | media[1 + i] : word;
    }
    return word;
}

TEST(StartMediaTest, HostAndDeviceFindTheSolidsAroundAPoint)
{
    const Scene scene = nestedSolids();
    const SceneOnDevice onDevice(scene);
    ASSERT_NE(onDevice.flat.features & kFeatureMedia, 0U);
    Random random(71);
    std::vector<Case> cases;
    std::size_t nested = 0;
    while (cases.size() < 4000) {
        const auto coordinate = [&random] { return static_cast<float>(random.uniform(-1.2, 1.2)) * kHalf; };
        const glm::vec3 point(coordinate(), coordinate(), coordinate());
        if (const auto media = mediaAt(point, onDevice.flat.mediumOfMaterial)) {
            cases.push_back({point, *media});
            nested += *media >> kMediumBits != 0 ? 1 : 0;
            Camera camera;
            camera.position = point;
            ASSERT_EQ(placeInMedia(flattenCamera(camera, 1.0F), onDevice.flat).media, *media)
                << point.x << ' ' << point.y << ' ' << point.z;
        }
    }
    EXPECT_GE(nested, 50U);  // in a ball
    onDevice.test(test_kernels::start_media_test).cases(cases).run();
}

}  // namespace glim::start_media_test
