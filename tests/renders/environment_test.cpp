// Pictures lit by environment maps: however light is found, in mirrors, and with suns as small as a texel.
#include "host/image/srgb.hpp"
#include "host/measure/confidence.hpp"
#include "host/scene/frame_camera.hpp"
#include "host/scene/make_studio.hpp"
#include "shaders/shared/luminance.h"
#include "tests/harness/random.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/hard_case.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace glim {
namespace {

// The direction of a map's texel coordinates, in texels.
glm::dvec3 directionOf(const RadianceMap& map, double x, double y)
{
    const double phi = 2.0 * std::numbers::pi * (x / map.width - 0.5), theta = std::numbers::pi * y / map.height;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

RadianceMap plainMap(std::uint32_t width, std::uint32_t height, const glm::vec3& color)
{
    RadianceMap map;
    map.width = width;
    map.height = height;
    map.texels.assign(std::size_t{width} * height, color);
    return map;
}

// A disk of light, `radius` radians about `direction`, is added.
void addSun(RadianceMap& map, const glm::dvec3& direction, double radius, const glm::vec3& radiance)
{
    for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            if (glm::dot(directionOf(map, x + 0.5, y + 0.5), glm::normalize(direction)) > std::cos(radius)) {
                map.texels[std::size_t{y} * map.width + x] += radiance;
            }
        }
    }
}

// A clear sky over brown ground, and a sun of half a degree that gives seven times the light of the sky.
RadianceMap sunAndSky()
{
    RadianceMap map = plainMap(2048, 1024, glm::vec3(0.0F));
    for (std::uint32_t y = 0; y < map.height; ++y) {
        const float height = std::cos(static_cast<float>(std::numbers::pi) * (static_cast<float>(y) + 0.5F) / 1024.0F);
        const glm::vec3 color = height > 0.0F ? glm::mix(glm::vec3(1.2F, 1.3F, 1.4F), glm::vec3(0.3F, 0.5F, 1.0F), std::sqrt(height))
                                              : glm::vec3(0.15F, 0.12F, 0.1F);
        std::fill_n(map.texels.begin() + std::ptrdiff_t{2048} * y, 2048, color);
    }
    addSun(map, {0.5, 0.8, -0.6}, 0.26 * std::numbers::pi / 180.0, glm::vec3(3e5F, 2.8e5F, 2.5e5F));
    return map;
}

void setMap(Scene& scene, RadianceMap map, float rotation = 0.0F)
{
    scene.environment.emplace();
    scene.environment->map = std::make_shared<RadianceMap>(std::move(map));
    scene.environment->rotation = rotation;
}

// A matt ball, a metal ball, a plastic one, on a floor.
Scene ballsOnAFloor()
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-4, 0, 4), {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}}, builder.lambert(glm::vec3(0.5F)))
        .sphere({-1.1F, 0.5F, 0.0F}, 0.5F, builder.lambert(glm::vec3(0.7F, 0.4F, 0.2F)))
        .sphere({0.0F, 0.5F, 0.0F}, 0.5F, builder.mirror(glm::vec3(0.9F, 0.7F, 0.4F)))
        .sphere({1.1F, 0.5F, 0.0F}, 0.5F, builder.lambert(glm::vec3(0.1F, 0.2F, 0.5F)))
        .perspective({0, 1.5F, 4.5F}, {0, 0.4F, 0}, 0.6F);
    Scene scene = builder.scene();
    scene.materials[2].roughness = 0.3F;
    scene.materials[3].specular = 1.0F;
    scene.materials[3].roughness = 0.4F;
    return scene;
}

// Of blocks of pixels in a row: mean and its variance, by channel.
struct Block {
    glm::dvec3 mean{0.0}, variance{0.0};
};

std::vector<Block> blocksOf(const Film& film, std::uint32_t side, std::uint32_t block)
{
    const std::uint32_t across = side / block;
    const double pixels = block * block;
    std::vector<Block> blocks(std::size_t{across} * across);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            Block& b = blocks[std::size_t{y / block} * across + x / block];
            const PixelMoments& pixel = film.pixels[std::size_t{y} * side + x];
            b.mean += glm::dvec3(pixel.mean) / pixels;
            b.variance += glm::dvec3(computeVarianceOfMean(pixel)) / (pixels * pixels);
        }
    }
    return blocks;
}

// The largest |z| of the blocks; |z| <= 4 is demanded of 99.9 % of them.
void expectSameBlocks(const std::string& name, const Film& a, const Film& b, std::uint32_t side)
{
    const std::vector<Block> x = blocksOf(a, side, 16), y = blocksOf(b, side, 16);
    double worst = 0.0, beyond = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double distance = std::abs(x[i].mean[c] - y[i].mean[c]), error = std::sqrt(x[i].variance[c] + y[i].variance[c]);
            if (!(error > 1e-6 * y[i].mean[c])) {  // the sky itself, of one colour
                EXPECT_LE(distance, 2e-5 * y[i].mean[c]) << name;
                continue;
            }
            const double z = distance / error;
            count += 1.0;
            worst = std::max(worst, z);
            beyond += z <= 4.0 ? 0.0 : 1.0;
            squares += z * z;
        }
    }
    std::printf("%s: largest |z| of %.0f blocks %.2f, mean z^2 %.2f\n", name.c_str(), count, worst, squares / count);
    EXPECT_LE(beyond, 1e-3 * count) << name;
}

TEST(EnvironmentTest, LightsBsdfsAndBothGiveTheSameBlocks)
{
    RadianceMap map = plainMap(64, 32, glm::vec3(0.3F, 0.4F, 0.6F));
    addSun(map, {0.5, 0.7, 0.4}, 0.2, glm::vec3(20.0F, 18.0F, 12.0F));
    addSun(map, {-1.0, 0.2, 0.3}, 0.15, glm::vec3(4.0F, 8.0F, 16.0F));
    addSun(map, {0.0, 1.0, 0.0}, 0.15, glm::vec3(10.0F));
    Scene scene = ballsOnAFloor();
    setMap(scene, map, 0.7F);
    RenderSettings settings = squareSettings(64, samplesFor(256));
    settings.bounces = 2;
    std::vector<Film> films;
    for (const DirectLight direct : {DirectLight::Mis, DirectLight::Lights, DirectLight::Bsdf}) {
        settings.course.direct = direct;
        settings.sampleEnd = samplesFor(direct == DirectLight::Bsdf ? 1024 : 256);
        films.push_back(renderScene(scene, settings));
        ++settings.seed;
    }
    expectSameBlocks("MIS and lights", films[0], films[1], 64);
    expectSameBlocks("MIS and BSDFs", films[0], films[2], 64);
    expectSameBlocks("lights and BSDFs", films[1], films[2], 64);
}

// Two mirrors, parallel and aslant, make a periscope: the picture is what the camera sees without them.
TEST(EnvironmentTest, AMapInAMirrorInAMirror)
{
    SceneBuilder builder, empty;
    const auto mirror = builder.mirror(glm::vec3(1.0F));
    builder.quad({glm::vec3(-2, -1, -1), {2, -1, -1}, {2, 1, -3}, {-2, 1, -3}}, mirror)
        .quad({glm::vec3(-2, 4, -3), {2, 4, -3}, {2, 2, -1}, {-2, 2, -1}}, mirror)
        .perspective({0, 0, 0}, {0, 0, -1}, 0.3F);
    empty.sphere({0, 0, 50}, 0.1F, empty.lambert(glm::vec3(0.5F))).perspective({0, 0, 0}, {0, 0, -1}, 0.3F);
    Scene scene = builder.scene(), direct = empty.scene();
    RadianceMap map = plainMap(64, 32, glm::vec3(0.0F));
    Random random(3);
    for (glm::vec3& texel : map.texels) {
        texel = glm::vec3(static_cast<float>(random.uniform(0.1, 1.0)));
    }
    setMap(scene, map, 2.0F);
    setMap(direct, map, 2.0F);
    RenderSettings settings = squareSettings(32, 16);
    settings.bounces = 4;
    settings.schedule = Schedule::Persistent;
    const Film mirrored = renderScene(scene, settings), seen = renderScene(direct, settings);
    double worst = 0.0, low = 1e9, high = 0.0;
    for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
        const double a = static_cast<double>(mirrored.pixels[i].mean.g), b = static_cast<double>(seen.pixels[i].mean.g);
        worst = std::max(worst, std::abs(a / b - 1.0));
        low = std::min(low, b);
        high = std::max(high, b);
    }
    std::printf("a map in two mirrors: pixels of %.3f to %.3f, off by %.1e at most\n", low, high, worst);
    EXPECT_GT(high, 2.0 * low);
    EXPECT_LE(worst, 1e-4);
}

// The light that a texel of a map of blacks gives a horizontal surface: its bilinear tent over the texels next to it, times |cos|.
double irradianceOfTexel(const RadianceMap& map, std::uint32_t y, double radiance)
{
    constexpr int kFine = 64;
    double sum = 0.0;
    for (int j = -kFine; j < 2 * kFine; ++j) {
        const double v = y + (j + 0.5) / kFine;
        if (v < 0.0 || v > map.height) {
            continue;
        }
        // Beyond the outermost row's centre the radiance is that row's.
        const double row = std::clamp(v, 0.5, map.height - 0.5), t = std::max(0.0, 1.0 - std::abs(row - (y + 0.5)));
        const double theta = std::numbers::pi * v / map.height;
        sum += t * std::abs(std::cos(theta)) * std::sin(theta) * (std::numbers::pi / map.height / kFine);
    }
    return radiance * sum * 2.0 * std::numbers::pi / map.width;  // the tent across has the area of one texel
}

// One hot texel at each pole, on a floor and on a ceiling. With GLIM_HARD the map is as large as glim reads.
TEST(EnvironmentTest, H15HotTexelsAtThePoles)
{
    const bool hard = std::getenv("GLIM_HARD") != nullptr;
    RadianceMap map = plainMap(hard ? 16384 : 2048, hard ? 8192 : 1024, glm::vec3(0.0F));
    const double radiance = hard ? 1e9 : 1e6;
    map.texels[map.width / 3] = glm::vec3(static_cast<float>(radiance));
    map.texels[map.texels.size() - 7] = glm::vec3(static_cast<float>(2.0 * radiance));
    const double above = irradianceOfTexel(map, 0, radiance);
    const double below = irradianceOfTexel(map, map.height - 1, 2.0 * radiance);
    const std::string size = std::to_string(map.width) + " x " + std::to_string(map.height);
    SceneBuilder builder;
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(glm::vec3(0.5F), glm::vec3(0.0F), true))
        .orthographic({0.03F, 0.05F, 0.02F}, {0, 0, 0}, 1e-3F)
        .orthographic({0.03F, -0.05F, 0.02F}, {0, 0, 0}, 1e-3F);
    Scene scene = builder.scene();
    setMap(scene, std::move(map), 0.4F);
    const FlatScene flat = flattened(scene);
    scene.environment.reset();
    RenderSettings settings = squareSettings(32, samplesFor(256));
    settings.bounces = 1;
    settings.schedule = Schedule::Persistent;
    for (const auto& [camera, irradiance] : {std::pair{0U, above}, std::pair{1U, below}}) {
        const Film film = renderFlat(flat, scene.cameras[camera], settings);
        const MeanEstimate mean = meanOf(film);
        const double truth = 0.5 * irradiance / std::numbers::pi;
        printHardCase("H15", "one hot texel at the pole of a map of " + size, 1024.0 * settings.sampleEnd,
                      "mean off by " + figure(mean.mean.g / truth - 1.0) + " +- " + figure(mean.standardError.g / truth));
        expectMean("hot texel at the pole", film, glm::dvec3(truth));
    }
}

// The variance of one sample of a pixel, on average.
double varianceOf(const Film& film)
{
    double sum = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        sum += static_cast<double>(computeVarianceOfMean(pixel).g) * pixel.count;
    }
    return sum / static_cast<double>(film.pixels.size());
}

// A matt floor under sun and sky. Sampling by the cosine finds a sun of half a degree once in 50,000 rays.
TEST(EnvironmentTest, H15SunAndSkyByLightsAndByTheCosine)
{
    SceneBuilder builder;
    builder.quad({glm::vec3(-5, 0, 5), {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}}, builder.lambert(glm::vec3(0.5F), glm::vec3(0.0F), true))
        .orthographic({0.03F, 0.05F, 0.02F}, {0, 0, 0}, 1e-3F);
    Scene scene = builder.scene();
    setMap(scene, sunAndSky());
    RenderSettings settings = squareSettings(32, samplesFor(256));
    settings.bounces = 1;
    settings.sampler = Sampler::Independent;
    settings.schedule = Schedule::Wavefront;
    const FlatScene flat = flattened(scene);
    std::map<DirectLight, Film> films;
    for (const DirectLight direct : {DirectLight::Mis, DirectLight::Lights, DirectLight::Bsdf}) {
        settings.course.direct = direct;
        films[direct] = renderFlat(flat, scene.cameras[0], settings);
        ++settings.seed;
    }
    const double mis = varianceOf(films[DirectLight::Mis]), lights = varianceOf(films[DirectLight::Lights]),
                 cosine = varianceOf(films[DirectLight::Bsdf]);
    printHardCase("H15", "sun of half a degree and sky, on a matt floor", 1024.0 * settings.sampleEnd,
                  "variance " + figure(mis) + ", by lights alone " + figure(lights), "by the cosine: " + figure(cosine));
    EXPECT_GE(cosine, 50.0 * mis);
    EXPECT_GE(cosine, 50.0 * lights);
    expectSameMean("sun and sky by MIS and by lights", films[DirectLight::Mis], films[DirectLight::Lights]);
}

// A ball in the studio, as the framed camera sees it.
Film ballInStudio(const Material& material, std::uint32_t spp)
{
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1.0F, builder.add(material));
    Scene scene = builder.scene();
    setMap(scene, makeStudio());
    scene.cameras.push_back(frameCamera(scene, 1.0F));
    return renderScene(scene, squareSettings(64, spp));
}

// By luminance of pixels that show the ball alone, and of those that show the backdrop alone.
std::pair<double, double> ballAndBackdrop(const Film& film)
{
    double ball = 0.0, backdrop = 0.0, ofBall = 0.0, ofBackdrop = 0.0;
    for (const PixelMoments& pixel : film.pixels) {
        const double luminance = computeLuminance(glm::dvec3(pixel.mean));
        (pixel.alpha == 1.0F ? ball : backdrop) += pixel.alpha == 1.0F || pixel.alpha == 0.0F ? luminance : 0.0;
        (pixel.alpha == 1.0F ? ofBall : ofBackdrop) += pixel.alpha == 1.0F || pixel.alpha == 0.0F ? 1.0 : 0.0;
    }
    return {ball / ofBall, backdrop / ofBackdrop};
}

// Middle grey is shown as such, and no grey is lost against the backdrop as a whole.
TEST(StudioTest, MiddleGreyIsMiddleGrey)
{
    const auto [ball, backdrop] = ballAndBackdrop(ballInStudio(makeLambert(glm::vec3(0.18F)), 64));
    EXPECT_GE(ball, 0.18);
    EXPECT_LE(ball, 0.25);
    EXPECT_LT(backdrop, 0.25);
    const auto [white, unused] = ballAndBackdrop(ballInStudio(makeLambert(glm::vec3(0.8F)), 64));
    EXPECT_LT(white, 0.85) << "white is not burnt";
}

// A perfect mirror differs by 15 of 255 and more from the backdrop beside it in two of three pixels. At its rim it shows what is behind it.
TEST(StudioTest, MirrorsDifferFromTheBackdrop)
{
    Material mirror;
    mirror.roughness = 0.0F;
    const Film film = ballInStudio(mirror, 16);
    int pixels = 0, visible = 0;
    for (std::uint32_t y = 0; y < 64; ++y) {
        const PixelMoments* row = film.pixels.data() + std::size_t{y} * 64;
        const double beside = 255.0 * srgbFromLinear(static_cast<double>(row[0].mean.g));
        for (std::uint32_t x = 0; x < 64; ++x) {
            if (row[x].alpha == 1.0F) {
                ++pixels;
                visible += std::abs(255.0 * srgbFromLinear(std::min(1.0, static_cast<double>(row[x].mean.g))) - beside) >= 15.0 ? 1 : 0;
            }
        }
    }
    EXPECT_GT(pixels, 1000);
    EXPECT_GE(3 * visible, 2 * pixels);
}

}  // namespace
}  // namespace glim
