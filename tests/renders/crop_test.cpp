// A crop shows what the whole picture shows there, by every kind of camera.
#include "host/measure/z_test.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/named.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace glim {
namespace {

using Model = Projection::Model;

const Crop kCrop{{29, 11}, {40, 24}, {96, 64}};
const Intrinsics kIntrinsics{{60.0, 55.0}, {45.0, 30.0}, {96.0, 64.0}};

struct CroppedCamera {
    Camera::Kind kind;
    Projection projection;
};

const test::Named<CroppedCamera> kCroppedCameras[] = {
    {"perspective", {Camera::Kind::Perspective, {}}},
    {"orthographic", {Camera::Kind::Orthographic, {}}},
    {"shifted", {Camera::Kind::Perspective, {Model::Straight, std::nullopt, {0.1, -0.05}, {}}}},
    {"intrinsics", {Camera::Kind::Perspective, {Model::Straight, kIntrinsics, {}, {}}}},
    {"distorted", {Camera::Kind::Perspective, {Model::RadialTangential, kIntrinsics, {}, {-0.2, 0.05, 0.01, -0.02}}}},
    {"fisheye", {Camera::Kind::Perspective, {Model::Fisheye, kIntrinsics, {}, {0.05, -0.02}}}},
    {"equirectangular", {Camera::Kind::Perspective, {Model::Equirectangular, std::nullopt, {}, {}}}},
};

Film cut(const Film& whole, const glm::uvec2& corner, const glm::uvec2& size)
{
    Film film;
    film.width = size.x;
    film.height = size.y;
    for (std::uint32_t y = corner.y; y < corner.y + size.y; ++y) {
        const PixelMoments* row = &whole.pixels[std::size_t{y} * whole.width + corner.x];
        film.pixels.insert(film.pixels.end(), row, row + size.x);
    }
    return film;
}

class CropTest : public testing::TestWithParam<test::Named<CroppedCamera>> {};

TEST_P(CropTest, ShowsThatPartOfThePicture)
{
    const auto& [kind, projection] = GetParam().value;
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    Camera camera = scene.cameras.front();
    camera.kind = kind;
    camera.halfWidth = 3.0F;
    camera.halfHeight = 2.0F;
    camera.projection = projection;
    RenderSettings settings = squareSettings(kCrop.whole.y, samplesFor(128));
    settings.width = kCrop.whole.x;
    settings.schedule = Schedule::Persistent;
    settings.caustics = false;
    const Film whole = renderFlat(flat, camera, settings);
    camera.projection.crop = kCrop;
    settings.width = kCrop.size.x;
    settings.height = kCrop.size.y;
    settings.seed = 1;
    const Picture picture = makePicture(renderFlat(flat, camera, settings));
    const auto compare = [&](const glm::uvec2& corner) {
        return zTest(picture, makePicture(cut(whole, corner, kCrop.size)), 1e-3 / static_cast<double>(std::size(kCroppedCameras)));
    };
    const ZTest test = compare(kCrop.corner);
    EXPECT_TRUE(test.agrees()) << test.worstZ << " of " << test.blockLimit << " at " << test.worstX << ", " << test.worstY;
    // Or the test would see nothing.
    EXPECT_FALSE(compare(kCrop.corner + glm::uvec2(1, 0)).agrees());
    EXPECT_FALSE(compare(kCrop.corner + glm::uvec2(0, 1)).agrees());
    std::printf("  worst block %.2f of %.2f\n", test.worstZ, test.blockLimit);
}

INSTANTIATE_TEST_SUITE_P(Cameras, CropTest, testing::ValuesIn(kCroppedCameras), test::nameOfParameter);

}  // namespace
}  // namespace glim
