// A PNG that shows nothing says so, with an exposure that shows it.
#include "host/job/exposure_advice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glim {
namespace {

// Grey pixels, from one tenth of `radiance` to all of it; `covered`: they show a surface.
void add(Film& film, int pixels, float radiance, bool covered = true)
{
    for (int i = 0; i < pixels; ++i) {
        PixelMoments pixel{};
        pixel.count = 1;
        pixel.mean = vec3(radiance * (0.1F + 0.9F * static_cast<float>(i) / static_cast<float>(pixels)));
        pixel.alpha = covered ? 1.0F : 0.0F;
        film.pixels.push_back(pixel);
    }
}

Film makeFilm(float radiance)
{
    Film film;
    add(film, 1000, radiance);
    return film;
}

TEST(ExposureAdviceTest, PicturesThatShowSomethingAreLeftAlone)
{
    for (const float radiance : {0.05F, 0.5F, 1.0F, 1.2F}) {
        EXPECT_EQ(adviseExposure(makeFilm(radiance), {}), std::nullopt) << radiance;
    }
    EXPECT_EQ(adviseExposure(makeFilm(1000.0F), {-10.0}), std::nullopt);
    EXPECT_EQ(adviseExposure(Film(), {}), std::nullopt);
}

// A sun of 6,830 lx on white, and the same scene by candlelight; neither advice needs another.
TEST(ExposureAdviceTest, AdviceIsRightAtOnce)
{
    for (const float radiance : {2.0F, 2174.0F, 1e20F, 1e-4F, 1e-20F}) {
        const Film film = makeFilm(radiance);
        const auto advice = adviseExposure(film, {});
        ASSERT_TRUE(advice) << radiance;
        const double exposure = std::stod(advice->expected);
        EXPECT_EQ(std::stod(advice->value) > 20.0, radiance > 1.0F) << "white pixels, or a mean";
        EXPECT_NEAR(exposure, std::log2(0.9 / 0.955 / static_cast<double>(radiance)), 0.11);
        EXPECT_EQ(adviseExposure(film, {exposure}), std::nullopt) << advice->sentence;
    }
}

// A fifth of the surfaces may be white, in all channels; a coloured lamp is not.
TEST(ExposureAdviceTest, OnlyWhiteCounts)
{
    Film film = makeFilm(0.5F);
    for (int i = 0; i < 200; ++i) {
        film.pixels[static_cast<std::size_t>(i)].mean = vec3(9.0F);
    }
    EXPECT_EQ(adviseExposure(film, {}), std::nullopt);
    film.pixels[500].mean = vec3(9.0F);
    const auto advice = adviseExposure(film, {});
    ASSERT_TRUE(advice);
    EXPECT_EQ(advice->value, "20 %");
    for (PixelMoments& pixel : film.pixels) {
        pixel.mean.b = std::min(pixel.mean.b, 0.9F);
    }
    EXPECT_EQ(adviseExposure(film, {}), std::nullopt);
}

// A bright sky behind a scene says nothing about it, unless nothing else is there.
TEST(ExposureAdviceTest, SurfacesCountBeforeTheirBackground)
{
    Film film = makeFilm(0.5F);
    add(film, 5000, 30.0F, false);
    EXPECT_EQ(adviseExposure(film, {}), std::nullopt);
    Film sky;
    add(sky, 100, 30.0F, false);
    EXPECT_TRUE(adviseExposure(sky, {}));
}

TEST(ExposureAdviceTest, BlackIsSaidWithoutAnExposure)
{
    const auto advice = adviseExposure(makeFilm(0.0F), {});
    ASSERT_TRUE(advice);
    EXPECT_EQ(advice->expected, "");
    Film lamp = makeFilm(0.0F);
    lamp.pixels[3].mean = vec3(1.0F);
    const auto lights = adviseExposure(lamp, {});
    ASSERT_TRUE(lights) << "a lamp in the dark, which no exposure shows";
    EXPECT_EQ(lights->value, "0.1 %");
    EXPECT_EQ(lights->expected, "--environment studio");
}

}  // namespace
}  // namespace glim
