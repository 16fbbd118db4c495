#include "host/job/film_report.hpp"

#include <gtest/gtest.h>

namespace glim {
namespace {

// Three pixels with 2, 32 and 8 samples.
Film makeFilm()
{
    Film film;
    film.width = 3;
    film.height = 1;
    film.pixels.resize(3, PixelMoments{});
    film.pixels[0].count = 2;
    film.pixels[0].mean = {1, 5, 0};
    film.pixels[1].count = 32;
    film.pixels[1].mean = {9, 1, 2};
    film.pixels[0].blocks = film.pixels[1].blocks = 3;
    film.pixels[2].blocks = 1;
    film.pixels[1].clamped = 1.5F;
    film.pixels[2].count = 8;
    film.pixels[2].mean = {2, 0, 7};
    return film;
}

TEST(FilmFigures, RatesAreMeanLeastAndMost)
{
    const Rates rates = computeRates(makeFilm());
    EXPECT_DOUBLE_EQ(rates.mean, 14.0);
    EXPECT_EQ(rates.least, 2U);
    EXPECT_EQ(rates.most, 32U);
    EXPECT_EQ(rates.fewestBlocks, 1U);
}

TEST(FilmFigures, StepsAreMeansAndTheLargestPixel)
{
    const Steps steps = computeSteps(makeFilm());
    EXPECT_DOUBLE_EQ(steps.nodes, 4.0);
    EXPECT_DOUBLE_EQ(steps.primitives, 2.0);
    EXPECT_EQ(steps.mostNodes, 9.0);
}

TEST(FilmFigures, ClampedEnergyIsWhatWasTakenAndWhatIsLeft)
{
    const ClampedEnergy energy = computeClampedEnergy(makeFilm());
    EXPECT_DOUBLE_EQ(energy.removed, 0.5);
    EXPECT_DOUBLE_EQ(energy.kept, 3.0);
}

}  // namespace
}  // namespace glim
