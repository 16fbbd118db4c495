// Light paths in a film: the same bits however the work is cut, and what the film says of them.
#include "host/flatten/flatten_scene.hpp"
#include "host/render/film_file.hpp"
#include "host/render/merge_films.hpp"
#include "host/render/parameters.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/build_scene.hpp"
#include "tests/support/caustic_films.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

RenderSettings small(std::uint32_t spp) { return squareSettings(40, spp); }

class CausticsFilmTest : public testing::Test {
protected:
    const Scene scene = mixedScene();
    const FlatScene flat = flattened(scene);
    const FlatCamera camera = flattenCamera(scene.cameras.front(), 1.0F);

    Film render(const RenderSettings& settings) const { return renderCaustics(flat, camera, settings, true); }
};

TEST_F(CausticsFilmTest, HasTheSameBitsInBands)
{
    const Film whole = render(small(80));
    for (const std::uint32_t pixels : {100U, 173U}) {
        RenderSettings settings = small(80);
        settings.tilePixels = pixels;
        EXPECT_TRUE(sameBits(whole, render(settings))) << pixels;
    }
}

// In whichever band they are; and the film may be asked for while a block is open.
TEST_F(CausticsFilmTest, PassesThatAreGivenUpAddNothing)
{
    RenderSettings settings = small(80);
    settings.tilePixels = 100;
    settings.schedule = Schedule::Persistent;
    settings.uncheckedSeconds = 0.0;
    Renderer renderer(testDevice(), flat, camera, settings);
    int given = 0;
    while (!renderer.plan().isDone()) {
        int calls = 0;
        given += renderer.advance([&] { return ++calls != 1 + given % 4 || given > 12; }) ? 0 : 1;
        renderer.film();
    }
    EXPECT_EQ(given, 13);
    EXPECT_TRUE(sameBits(renderer.film(), render(small(80))));
}

TEST_F(CausticsFilmTest, HasTheSameBitsOfPartsThatAreMerged)
{
    const test::ScratchFolder folder;
    RenderSettings first = small(256), second = small(400);
    second.sampleBegin = 256;
    writeFilm(folder / "a.exr", render(first));
    writeFilm(folder / "b.exr", render(second));
    const MergedFilm merged = mergeFilms({folder / "b.exr", folder / "a.exr"});
    EXPECT_TRUE(merged.exact);
    EXPECT_TRUE(sameBits(merged.film, render(small(400))));
}

TEST_F(CausticsFilmTest, CountsTheSamplesThatEachPixelHas)
{
    for (const std::uint32_t spp : {1U, 40U, 80U}) {
        const Film film = render(small(spp));
        EXPECT_EQ(film.splats.front().count, spp);
        EXPECT_EQ(film.splats.front().blocks, film.pixels.front().blocks) << spp;
    }
}

TEST_F(CausticsFilmTest, AdaptiveRendersHaveTheSameLight)
{
    RenderSettings settings = small(samplesFor(512));
    const Film plain = render(settings);
    settings.adaptive = Adaptive::Neighbours;
    settings.seed = 1;
    const Film adaptive = render(settings);
    expectAgreement("adaptive", makePicture(adaptive), makePicture(plain));
    EXPECT_EQ(adaptive.splats.front().count, settings.sampleEnd);
    settings.pathCapacity = 3000;
    EXPECT_TRUE(sameBits(adaptive, render(settings)));
}

TEST_F(CausticsFilmTest, ClampingSaysWhatItTakes)
{
    RenderSettings settings = small(64);
    const double whole = meanOfSplats(render(settings));
    settings.clampIndirect = 0.01F;
    const Film clamped = render(settings);
    double removed = 0.0;
    for (const SplatMoments& splat : clamped.splats) {
        removed += static_cast<double>(splat.clamped) / static_cast<double>(clamped.splats.size());
    }
    EXPECT_GT(removed, 0.01 * whole);
    EXPECT_NEAR(meanOfSplats(clamped) + removed, whole, 1e-5 * whole);
}

TEST_F(CausticsFilmTest, AnotherScaleOfLightScalesThePicture)
{
    const Film plain = render(small(64));
    for (const float scale : {0x1p-60F, 0x1p40F}) {
        Scene bright = scene;
        for (Material& material : bright.materials) {
            material.emission *= scale;
        }
        for (PunctualLight& light : bright.lights) {
            light.intensity *= scale;
        }
        bright.environment->radiance *= scale;
        const Film film = renderCaustics(flattened(bright), camera, small(64), true);
        for (std::size_t i = 0; i < film.splats.size(); ++i) {
            ASSERT_EQ(film.splats[i].mean, plain.splats[i].mean * scale) << i;
        }
    }
}

TEST_F(CausticsFilmTest, IsOffWhereTheCourseEstimates)
{
    EXPECT_TRUE(tracesLight(flat, small(64)));
    RenderSettings settings = small(64);
    settings.course.direct = DirectLight::Lights;
    EXPECT_FALSE(tracesLight(flat, settings));
    settings = small(64);
    settings.bounces = 1;
    EXPECT_FALSE(tracesLight(flat, settings));
    settings = small(64);
    settings.adaptive = Adaptive::Course;
    EXPECT_FALSE(tracesLight(flat, settings));
}

}  // namespace
}  // namespace glim
