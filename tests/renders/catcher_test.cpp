// Shadow catchers: shadows that are known on paper, and composites against renders of the whole scene.
#include "host/measure/z_test.hpp"
#include "host/render/composite.hpp"
#include "host/render/parameters.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>

namespace glim {
namespace {

enum class Object { None, Screen, Ball, Lamp };

Material floorMaterial(bool glossy)
{
    Material material = makeLambert(glm::vec3(0.6F, 0.5F, 0.4F));
    material.specular = glossy ? 1.0F : 0.0F;
    material.roughness = 0.3F;
    material.isCatcher = true;
    return material;
}

// A catcher that fills the picture, and an object above it.
SceneBuilder floorWith(Object object, bool glossy = false)
{
    SceneBuilder b;
    b.quad({glm::vec3(-9, 0, 9), {9, 0, 9}, {9, 0, -9}, {-9, 0, -9}}, b.add(floorMaterial(glossy)));
    if (object == Object::Screen) {
        b.quad({glm::vec3(-1, 1, 1), {1, 1, 1}, {1, 1, -1}, {-1, 1, -1}}, b.lambert(glm::vec3(0.8F), glm::vec3(0.0F), true));
    } else if (object == Object::Ball) {
        Material red = makeLambert(glm::vec3(0.8F, 0.2F, 0.1F));
        red.specular = 1.0F;
        red.roughness = 0.4F;
        b.sphere({0.3F, 0.8F, 0.0F}, 0.8F, b.add(red));
    } else if (object == Object::Lamp) {
        b.sphere({0.0F, 1.0F, 0.0F}, 0.4F, b.lambert(glm::vec3(0.5F), glm::vec3(3.0F, 2.0F, 1.0F)));
    }
    b.perspective({0.0F, 6.0F, 4.0F}, {0, 0, 0}, 0.7F);
    return b;
}

SceneBuilder litByLamp(Object object, bool glossy = false)
{
    SceneBuilder b = floorWith(object, glossy);
    b.quad({glm::vec3(-3, 5, -2), {-1, 5, -2}, {-1, 5, -4}, {-3, 5, -4}}, b.lambert(glm::vec3(0.0F), glm::vec3(12.0F), true));
    return b;
}

SceneBuilder litBySun(Object object)
{
    SceneBuilder b = floorWith(object);
    b.light({.kind = PunctualLight::Kind::Directional, .direction = {0.0F, -1.0F, 0.0F}, .intensity = glm::vec3(3.0F)});
    return b;
}

RenderSettings catching(std::uint32_t side, std::uint32_t spp)
{
    RenderSettings settings = squareSettings(side, spp);
    settings.catcher = true;
    return settings;
}

// The share of the background that the sun's shadow of the screen covers: for points of the floor within it 1, else 0. Pixels that see an
// edge of the screen or of its shadow are left out.
TEST(Catcher, AShadowOfTheSunIsOpaque)
{
    constexpr std::uint32_t kSide = 32;
    RenderSettings settings = catching(kSide, 64);
    settings.bounces = 1;  // nor does the floor light itself by way of the screen
    const Film film = renderScene(litBySun(Object::Screen).scene(), settings);
    const std::vector<PixelMoments> picture = pictureOf(film);
    std::size_t dark = 0, clear = 0, objects = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const CatcherMoments& catcher = film.catcher[i];
        if (catcher.share == 0.0F) {
            EXPECT_EQ(picture[i].alpha, 1.0F) << i;
            EXPECT_EQ(picture[i].mean, film.pixels[i].mean) << i;
            ++objects;
        } else if (catcher.share == 1.0F && catcher.with == glm::vec3(0.0F)) {
            EXPECT_EQ(picture[i].alpha, 1.0F) << i;
            EXPECT_EQ(picture[i].mean, glm::vec3(0.0F)) << i;
            ++dark;
        } else if (catcher.share == 1.0F && catcher.with == catcher.without) {
            EXPECT_EQ(picture[i].alpha, 0.0F) << i;
            EXPECT_NEAR(catcher.without.r, 0.6F * 3.0F / 3.14159265F, 1e-5F) << i;
            ++clear;
        }
    }
    // The shadow has the area of the screen, 4, and at the distance of 7.2 a pixel of the picture is 0.164 wide.
    std::printf("%zu pixels of objects, %zu of the shadow, %zu of light\n", objects, dark, clear);
    EXPECT_GT(objects, 60U);
    EXPECT_GT(dark, 20U);
    EXPECT_GT(clear, 500U);
}

TEST(Catcher, NothingThrowsNoShadow)
{
    for (const Object object : {Object::None, Object::Lamp}) {  // what emits is there in either case
        const Film film = renderScene(litByLamp(object).scene(), catching(16, 96));
        const std::vector<PixelMoments> picture = pictureOf(film);
        std::size_t floors = 0;
        for (std::size_t i = 0; i < picture.size(); ++i) {
            EXPECT_EQ(film.catcher[i].with, film.catcher[i].without) << i;
            if (film.catcher[i].share == 1.0F) {
                EXPECT_EQ(picture[i].alpha, 0.0F) << i;
                EXPECT_EQ(computeAlphaError(film.pixels[i], film.catcher[i]), 0.0) << i;
                ++floors;
            }
        }
        EXPECT_GT(floors, 100U);
    }
}

// Mean and variance of the mean over films, by pixel.
Picture average(const std::vector<Picture>& pictures)
{
    Picture mean = pictures.front();
    const auto count = static_cast<double>(pictures.size());
    mean.variance.resize(mean.radiance.size());
    for (std::size_t i = 0; i < mean.radiance.size(); ++i) {
        glm::dvec3 sum(0.0), squares(0.0);
        for (const Picture& picture : pictures) {
            sum += glm::dvec3(picture.radiance[i]) / count;
        }
        for (const Picture& picture : pictures) {
            const glm::dvec3 d = glm::dvec3(picture.radiance[i]) - sum;
            squares += d * d;
        }
        mean.radiance[i] = sum;
        mean.variance[i] = squares / (count * (count - 1.0));
    }
    return mean;
}

// The transparent picture laid over the empty floor is the picture of the whole: three independent renders. Pixels that show an edge of
// the ball are left out: like every picture with alpha, this one takes the background for even within a pixel.
void expectComposite(bool glossy)
{
    constexpr std::uint32_t kFilms = 12, kSide = 24;
    const std::uint32_t spp = samplesFor(256, 4);
    RenderSettings settings = squareSettings(kSide, spp);
    const std::vector<Film> wholes = renderSeeds(litByLamp(Object::Ball, glossy).scene(), settings, kFilms);
    settings.seed = 100;
    const std::vector<Film> floors = renderSeeds(litByLamp(Object::None, glossy).scene(), settings, kFilms);
    settings.seed = 200;
    settings.catcher = true;
    const std::vector<Film> films = renderSeeds(litByLamp(Object::Ball, glossy).scene(), settings, kFilms);
    const auto hasEdge = [&films](std::size_t i) {
        return std::ranges::any_of(films, [i](const Film& film) { return film.catcher[i].share > 0.0F && film.catcher[i].share < 1.0F; });
    };
    std::vector<Picture> composites, references;
    for (std::size_t k = 0; k < kFilms; ++k) {
        const std::vector<PixelMoments> over = pictureOf(films[k]);
        Picture& composite = composites.emplace_back(makePicture(floors[k]));
        for (std::size_t i = 0; i < over.size(); ++i) {
            composite.radiance[i] = over[i].mean + (1.0F - over[i].alpha) * composite.radiance[i];
        }
        Picture& reference = references.emplace_back(makePicture(wholes[k]));
        for (std::size_t i = 0; i < over.size(); ++i) {
            if (hasEdge(i)) {
                composite.radiance[i] = reference.radiance[i] = glm::vec3(0.0F);
            }
        }
    }
    const ZTest test = zTest(average(composites), average(references), 1e-4);
    std::printf("%s: z of means %.1f %.1f %.1f, worst block %.1f of %.1f, detectable %.2g\n", glossy ? "glossy" : "matte", test.meanZ[0],
                test.meanZ[1], test.meanZ[2], test.worstZ, test.blockLimit, test.detectableBias);
    EXPECT_TRUE(test.meansAgree());
    EXPECT_TRUE(test.blocksAgree());
}

TEST(Catcher, OverTheEmptyFloorItIsTheWholePicture) { expectComposite(false); }
TEST(Catcher, SoItIsWithReflections) { expectComposite(true); }

// Over many films the squared error of alpha is as large as stated: within 3.3 standard errors, by the spread of the films' own squared
// distances from the mean.
TEST(Catcher, AlphaHasTheErrorItStates)
{
    constexpr std::uint32_t kFilms = 32;
    const std::vector<Film> films = renderSeeds(litByLamp(Object::Ball).scene(), catching(20, 512), kFilms);
    std::vector<std::vector<PixelMoments>> pictures;
    std::ranges::transform(films, std::back_inserter(pictures), pictureOf);
    std::vector<double> measured(kFilms), stated(kFilms);  // sums over pixels
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < films.front().pixels.size(); ++i) {
        double mean = 0.0;
        for (const std::vector<PixelMoments>& picture : pictures) {
            mean += static_cast<double>(picture[i].alpha) / kFilms;
        }
        const auto isFloor = [i](const Film& film) { return film.catcher[i].share == 1.0F; };
        if (!std::ranges::all_of(films, isFloor) || !(mean > 0.02 && mean < 0.98)) {
            continue;  // clamping cuts the noise
        }
        ++pixels;
        for (std::uint32_t k = 0; k < kFilms; ++k) {
            const double d = static_cast<double>(pictures[k][i].alpha) - mean;
            const double error = computeAlphaError(films[k].pixels[i], films[k].catcher[i]);
            measured[k] += d * d * kFilms / (kFilms - 1.0);
            stated[k] += error * error;
        }
    }
    double mean = 0.0, difference = 0.0, squares = 0.0;
    for (std::uint32_t k = 0; k < kFilms; ++k) {
        mean += measured[k] / kFilms;
        difference += (stated[k] - measured[k]) / kFilms;
    }
    for (std::uint32_t k = 0; k < kFilms; ++k) {
        squares += std::pow(stated[k] - measured[k] - difference, 2.0);
    }
    const double error = std::sqrt(squares / (kFilms * (kFilms - 1.0)));
    std::printf("%zu pixels: stated over measured mean square %.3f +- %.3f\n", pixels, 1.0 + difference / mean, error / mean);
    EXPECT_GT(pixels, 30U);
    EXPECT_LE(std::abs(difference), 3.3 * error);
    EXPECT_LT(error, 0.15 * mean) << "the test sees half as much";
}

TEST(Catcher, ItsFilmHasThePictureOfTheWhole)
{
    Scene scene = litByLamp(Object::Ball).scene();
    RenderSettings settings = squareSettings(16, 64);
    const Film plain = renderScene(scene, settings);
    settings.catcher = true;
    Film film = renderScene(scene, settings);
    EXPECT_EQ(film.catcher.size(), film.pixels.size());
    settings.tilePixels = 100;
    settings.pathCapacity = 1U << 12U;
    EXPECT_TRUE(sameBits(film, renderScene(scene, settings))) << "of several tiles, in short passes";
    film.catcher.clear();
    EXPECT_TRUE(sameBits(plain, film));
    EXPECT_FALSE(catches(flattened(litByLamp(Object::Ball).scene()), [] {
        RenderSettings depth;
        depth.aov = Aov::Depth;
        return depth;
    }()));
}

// Instances, points, alpha and spheres on the way are away, too.
TEST(Catcher, ObjectsOfAllKindsAreAway)
{
    const auto add = [](Scene& scene, Object object) {
        const Scene other = floorWith(object).scene();
        scene.materials.insert(scene.materials.end(), other.materials.begin() + 1, other.materials.end());
    };
    const std::function<void(Scene&)> kinds[] = {[&](Scene& scene) {
                                                     add(scene, Object::Screen);
                                                     scene.materials.back().alphaMode = AlphaMode::Blend;
                                                     scene.materials.back().alpha = 0.5F;
                                                     scene.meshes = std::vector<Mesh>(floorWith(Object::Screen).scene().meshes);
                                                     scene.instances = floorWith(Object::Screen).scene().instances;
                                                 },
                                                 [&](Scene& scene) {
                                                     add(scene, Object::Ball);
                                                     scene.spheres = floorWith(Object::Ball).scene().spheres;
                                                     scene.materials.back().transmission = 1.0F;
                                                 }};
    for (const auto& change : kinds) {
        Scene scene = litBySun(Object::None).scene();
        change(scene);
        RenderSettings settings = catching(16, 32);
        const Film film = renderScene(scene, settings);
        std::size_t floors = 0;
        for (const CatcherMoments& catcher : film.catcher) {
            if (catcher.share == 1.0F) {
                EXPECT_NEAR(catcher.without.r, 0.6F * 3.0F / 3.14159265F, 1e-5F);
                ++floors;
            }
        }
        EXPECT_GT(floors, 50U);
    }
}

// The ball is black in the floor, so what the film has less is what the floor reflects of it, and nothing is brighter than without it.
TEST(Catcher, ReflectionsMayBeLeftOut)
{
    RenderSettings settings = catching(16, 512);
    const Film all = renderScene(litByLamp(Object::Ball, true).scene(), settings);
    settings.catcherReflections = false;
    const Film shadows = renderScene(litByLamp(Object::Ball, true).scene(), settings);
    Scene black = litByLamp(Object::Ball, true).scene();
    black.materials[1].baseColor = glm::vec3(0.0F);
    black.materials[1].specular = 0.0F;
    settings.catcherReflections = true;
    const Film dark = renderScene(black, settings);
    std::size_t less = 0;
    for (std::size_t i = 0; i < all.pixels.size(); ++i) {
        EXPECT_EQ(shadows.catcher[i].without, all.catcher[i].without) << i;
        EXPECT_EQ(shadows.catcher[i].with, dark.catcher[i].with) << i;
        less += shadows.catcher[i].with.r < all.catcher[i].with.r ? 1 : 0;
        EXPECT_TRUE(glm::all(glm::lessThanEqual(shadows.catcher[i].with, shadows.catcher[i].without * 1.00001F))) << i;
    }
    EXPECT_GT(less, 50U);
}

}  // namespace
}  // namespace glim
