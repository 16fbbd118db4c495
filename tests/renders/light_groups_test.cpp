// Films by light groups: their sum, each against a render of its lights alone, and the error of any weighting.
#include "host/scene/light_groups.hpp"
#include "host/render/parameters.hpp"
#include "host/render/regroup.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/render_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace glim {
namespace {

// A quad, a sphere, a point light, an environment and an unlit patch; a mirror and glass, so that light paths have caustics.
Scene litScene()
{
    Scene scene = mixedScene();
    scene.materials[1].name = "lamp";
    scene.materials.back().name = "bulb";
    scene.lights[0].name = "point";
    Material unlit;
    unlit.name = "label";
    unlit.unlit = true;
    unlit.baseColor = glm::vec3(0.3F, 0.6F, 0.9F);
    scene.materials.push_back(unlit);
    scene.spheres.push_back(
        {.center = {1.5F, 0.6F, -1.2F}, .radius = 0.2F, .material = static_cast<std::uint32_t>(scene.materials.size() - 1)});
    return scene;
}

Scene grouped(Scene scene, const LightGroupChoice& choice = {{{"still", {"label", "environment"}}}, true})
{
    assignLightGroups(scene, chooseLightGroups("a scene of a test", scene, choice));
    return scene;
}

RenderSettings settingsOf(const Scene& scene, std::uint32_t side, std::uint32_t spp)
{
    RenderSettings settings = squareSettings(side, spp);
    settings.lightGroups = scene.lightGroups;
    return settings;
}

// Labelled as a job does it.
Film render(const Scene& scene, const RenderSettings& settings)
{
    Film film = renderScene(scene, settings);
    film.identity.settings = describeSettings(settings);
    return film;
}

// Each group against an independent render in which the others' lights are out.
void putOut(Scene& scene, std::uint32_t all, std::uint32_t but)
{
    for (std::uint32_t group = 0; group < all; ++group) {
        if (group == but) {
            continue;
        }
        for (Material& material : scene.materials) {
            if (material.lightGroup == group && (material.unlit || material.emission != glm::vec3(0.0F))) {
                material.emission = glm::vec3(0.0F);
                material.baseColor = material.unlit ? glm::vec3(0.0F) : material.baseColor;
            }
        }
        for (PunctualLight& light : scene.lights) {
            light.intensity = light.group == group ? glm::vec3(0.0F) : light.intensity;
        }
        if (scene.environment && scene.environment->group == group) {
            scene.environment.reset();
        }
    }
}

// The mean of n samples rounds each of n additions by 2^-24, and the sum of groups adds those of each group.
void expectSum(const Film& film)
{
    const std::vector<glm::vec3> ones(film.groups.groups, glm::vec3(1.0F));
    const Film sum = regroup(film, ones);
    for (std::size_t i = 0; i < film.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(sum.pixels[i].mean[c], film.pixels[i].mean[c], 1e-5F * film.pixels[i].mean[c]) << i;
            const float error = std::sqrt(computeVarianceOfMean(film.pixels[i])[c]);
            EXPECT_NEAR(std::sqrt(computeVarianceOfMean(sum.pixels[i])[c]), error, 1e-3F * error + 1e-5F * film.pixels[i].mean[c]) << i;
        }
    }
    for (std::size_t i = 0; i < film.splats.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(sum.splats[i].mean[c], film.splats[i].mean[c], 1e-6F * film.splats[i].mean[c]) << i;
        }
    }
}

TEST(LightGroupsTest, AddUpToTheFilmWhoseBitsStay)
{
    const Scene scene = grouped(litScene());
    RenderSettings settings = settingsOf(scene, 16, 96);
    for (const bool caustics : {true, false}) {
        settings.caustics = caustics;
        settings.clampIndirect = caustics ? std::numeric_limits<float>::infinity() : 0.5F;
        Film film = render(scene, settings);
        EXPECT_EQ(film.splats.empty(), !caustics);
        EXPECT_EQ(film.groups.groups, 4U);
        expectSum(film);
        RenderSettings without = settings;
        without.lightGroups.clear();
        film.groups = film.splatGroups = {};
        EXPECT_TRUE(sameBits(film, renderScene(scene, without)));
    }
}

TEST(LightGroupsTest, EachHasTheLightOfItsLightsAlone)
{
    const Scene scene = grouped(litScene());
    RenderSettings settings = settingsOf(scene, 16, samplesFor(256, 16));
    const Film film = render(scene, settings);
    settings.seed = 1;
    settings.lightGroups.clear();
    for (std::uint32_t group = 0; group < film.groups.groups; ++group) {
        std::vector<glm::vec3> factors(film.groups.groups, glm::vec3(0.0F));
        factors[group] = glm::vec3(1.0F);
        Scene alone = scene;
        alone.lightGroups.clear();
        putOut(alone, film.groups.groups, group);
        expectSameMean("light group " + scene.lightGroups[group], regroup(film, factors), renderScene(alone, settings));
    }
}

TEST(LightGroupsTest, HaveTheSameBitsHoweverTheWorkIsCut)
{
    const Scene scene = grouped(litScene());
    RenderSettings settings = settingsOf(scene, 16, 96);
    const Film film = render(scene, settings);
    settings.tilePixels = 100;
    settings.pathCapacity = 1U << 12U;
    EXPECT_TRUE(sameBits(film, renderScene(scene, settings))) << "of several tiles, in short passes";
    settings.tilePixels = 1U << 20U;
    settings.adaptive = Adaptive::Neighbours;
    expectSum(render(scene, settings));
}

TEST(LightGroupsTest, OfTransparentSurfacesVolumesAndCatchersAddUp)
{
    const auto change = [](Scene& scene, int kind) {
        Material& material = scene.materials[2];  // of the blue ball
        if (kind == 0) {
            material.alphaMode = AlphaMode::Blend;
            material.alpha = 0.5F;
        } else if (kind == 1) {
            material = Material{};
            material.metallic = 0.0F;
            material.roughness = 0.0F;
            material.transmission = 1.0F;
            material.thick = material.solid = true;
            material.scattering = glm::vec3(3.0F);
            material.absorption = glm::vec3(0.1F);
        } else {
            scene.materials[0].isCatcher = true;
        }
    };
    for (const int kind : {0, 1, 2}) {
        SCOPED_TRACE(kind);
        Scene scene = litScene();
        change(scene, kind);
        scene = grouped(scene);
        RenderSettings settings = settingsOf(scene, 12, 64);
        settings.catcher = kind == 2;
        expectSum(render(scene, settings));
    }
}

// Over many films the squared error of a weighting is as large as stated: within 3.3 standard errors, by the spread of the films' own
// squared distances from the mean.
TEST(LightGroupsTest, AnyWeightingHasTheErrorItStates)
{
    constexpr std::uint32_t kFilms = 48;
    const Scene scene = grouped(litScene(), {{}, true});
    RenderSettings settings = settingsOf(scene, 12, 256);
    std::vector<Film> films = renderSeeds(scene, settings, kFilms);
    const std::vector<glm::vec3> weightings[] = {
        {glm::vec3(3.0F), glm::vec3(0.5F), glm::vec3(0.1F), glm::vec3(1.0F), glm::vec3(2.0F)},
        {glm::vec3(0.2F), glm::vec3(2.0F, 1.0F, 0.5F), glm::vec3(1.0F), glm::vec3(0.0F), glm::vec3(4.0F)},
    };
    for (const std::vector<glm::vec3>& factors : weightings) {
        std::vector<std::vector<PixelMoments>> pictures;
        double apart = 0.0;  // what is stated if groups were independent
        for (Film& film : films) {
            film.identity.settings = describeSettings(settings);
            ASSERT_EQ(film.groups.groups, factors.size());
            pictures.push_back(shownPixels(regroup(film, factors)));
            Film independent = film;
            for (std::size_t i = 0; i < film.pixels.size(); ++i) {
                for (std::size_t g = 0, pair = factors.size(); g < factors.size(); ++g) {
                    for (std::size_t other = g; other < factors.size(); ++other, ++pair) {
                        independent.groups.of(i)[pair] *= g == other ? 1.0F : 0.0F;
                        independent.splatGroups.of(i)[pair] *= g == other ? 1.0F : 0.0F;
                    }
                }
            }
            for (const PixelMoments& pixel : shownPixels(regroup(independent, factors))) {
                apart += static_cast<double>(computeVarianceOfMean(pixel).g) / kFilms;
            }
        }
        std::vector<double> measured(kFilms), stated(kFilms);  // sums over pixels
        for (std::size_t i = 0; i < films.front().pixels.size(); ++i) {
            double mean = 0.0;
            for (const auto& picture : pictures) {
                mean += static_cast<double>(picture[i].mean.g) / kFilms;
            }
            for (std::uint32_t k = 0; k < kFilms; ++k) {
                const double d = static_cast<double>(pictures[k][i].mean.g) - mean;
                measured[k] += d * d * kFilms / (kFilms - 1.0);
                stated[k] += static_cast<double>(computeVarianceOfMean(pictures[k][i]).g);
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
        std::printf("stated over measured mean square %.3f +- %.3f; %.3f if groups were independent\n", 1.0 + difference / mean,
                    error / mean, apart / mean);
        EXPECT_LE(std::abs(difference), 3.3 * error);
        EXPECT_LT(error, 0.15 * mean) << "the test sees half as much";
    }
}

TEST(LightGroupsTest, OtherPicturesHaveNone)
{
    const FlatScene flat = flattened(grouped(litScene()));
    RenderSettings settings;
    EXPECT_TRUE(keepsGroups(flat, settings));
    settings.aov = Aov::Depth;
    EXPECT_FALSE(keepsGroups(flat, settings));
    settings.aov = Aov::Radiance;
    settings.adaptive = Adaptive::Course;
    EXPECT_FALSE(keepsGroups(flat, settings));
    EXPECT_FALSE(keepsGroups(flattened(litScene()), RenderSettings()));
}

}  // namespace
}  // namespace glim
