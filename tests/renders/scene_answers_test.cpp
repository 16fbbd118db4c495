// What scenes/README.md says of scenes whose answer is known without a golden image.
#include "host/measure/picture.hpp"
#include "host/scene/load_gltf.hpp"
#include "places.h"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace glim {
namespace {

struct Region {
    std::uint32_t left, top, right, bottom;  // the last two are included
};

template <class Function>
void forEachPixel(const Picture& picture, const Region& region, const Function& function)
{
    for (std::uint32_t y = region.top; y <= region.bottom; ++y) {
        for (std::uint32_t x = region.left; x <= region.right; ++x) {
            function(std::size_t{y} * picture.width + x);
        }
    }
}

// The mean of a region and the variance of that mean.
std::pair<glm::dvec3, glm::dvec3> meanOf(const Picture& picture, const Region& region)
{
    glm::dvec3 sum(0.0), variance(0.0);
    double count = 0.0;
    forEachPixel(picture, region, [&](std::size_t i) {
        sum += picture.radiance[i];
        variance += picture.variance[i];
        ++count;
    });
    return {sum / count, variance / (count * count)};
}

// 64 pixels show 4.2316 m: a metre is 15.124 pixels, and the middle is pixel 32. Regions keep a pixel from the edges of their squares.
TEST(TexturesScene, HalvesOfASquareAgree)
{
    const Scene scene = loadGltf(GLIM_SOURCE_DIR "/scenes/textures.gltf");
    const Picture picture = makePicture(renderScene(scene, squareSettings(64, 128)));

    // The byte 188 of sRGB: ((188 / 255 + .055) / 1.055)^2.4 = .502886 (IEC 61966-2-1), on either side of x = 24.4.
    for (const Region& half : {Region{19, 49, 23, 60}, Region{25, 49, 30, 60}}) {
        forEachPixel(picture, half, [&](std::size_t i) {
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(picture.radiance[i][c], 0.502886, 1e-5) << "sRGB, pixel " << i;
            }
        });
    }
    // Sixteen bits in sixteen texels: linear between their centres, but decoded texel by texel. Grey there, and it grows.
    float last = -1.0F;
    for (std::size_t x = 5; x <= 15; ++x) {
        const glm::vec3 grey = picture.radiance[std::size_t{55} * picture.width + x];
        EXPECT_GT(grey.x, last);
        EXPECT_EQ(grey.x, grey.z);
        last = grey.x;
    }
    // Roughness 128 / 255 by texture and by factor.
    const auto [byTexture, varianceByTexture] = meanOf(picture, {49, 49, 53, 60});
    const auto [byFactor, varianceByFactor] = meanOf(picture, {56, 49, 60, 60});
    for (int c = 0; c < 3; ++c) {
        const double z = (byTexture[c] - byFactor[c]) / std::sqrt(varianceByTexture[c] + varianceByFactor[c]);
        std::printf("roughness by texture, channel %d: %.5f, by factor %.5f, z %.2f\n", c, byTexture[c], byFactor[c], z);
        EXPECT_LE(std::abs(z), 4.56);
    }
}

}  // namespace
}  // namespace glim
