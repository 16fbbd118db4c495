// What the picture of each AOV and of the samples per pixel looks like.
#include "host/render/film_pictures.hpp"
#include "host/image/heat_color.hpp"
#include "host/render/settings.hpp"
#include "tests/support/decode_png.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace glim {
namespace {

using test::Rgb;
using test::ScratchFolder;

const Rgb kBlack{0, 0, 0}, kBlue{0, 0, 255}, kRed{255, 0, 0}, kBad{255, 0, 255};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

// A pixel of one sample that a share `alpha` of the rays had a surface for.
PixelMoments pixel(const glm::vec3& mean, float alpha = 1.0F)
{
    PixelMoments moments{};
    moments.count = 1;
    moments.mean = moments.normal = moments.albedo = mean;
    moments.alpha = alpha;
    return moments;
}

Film filmOf(Aov aov, const std::vector<PixelMoments>& pixels)
{
    RenderSettings settings;
    settings.aov = aov;
    Film film;
    film.width = static_cast<std::uint32_t>(pixels.size());
    film.height = 1;
    film.pixels = pixels;
    film.identity.settings = describeSettings(settings);
    return film;
}

std::vector<Rgb> picture(Aov aov, const std::vector<PixelMoments>& pixels, double exposure = 0.0)
{
    const ScratchFolder folder;
    const Film film = filmOf(aov, pixels);
    writeFilmPng(folder / "a.png", film, aovOf(film), exposure);
    EXPECT_EQ(folder.entries(), 1);
    return test::decodePng(folder / "a.png");
}

std::vector<Rgb> ratesPicture(const std::vector<std::uint32_t>& counts)
{
    std::vector<PixelMoments> pixels(counts.size(), PixelMoments{});
    for (std::size_t i = 0; i < counts.size(); ++i) {
        pixels[i].count = counts[i];
    }
    const ScratchFolder folder;
    writeFilmPng(folder / "r.png", filmOf(Aov::Radiance, pixels), Aov::SampleCount, 0.0);
    return test::decodePng(folder / "r.png");
}

TEST(HeatColor, GoesFromBlueToRed)
{
    EXPECT_EQ(heatColor(0.0), (Rgb8{0, 0, 255}));
    EXPECT_EQ(heatColor(0.125), (Rgb8{0, 128, 255}));
    EXPECT_EQ(heatColor(0.25), (Rgb8{0, 255, 255}));
    EXPECT_EQ(heatColor(0.5), (Rgb8{0, 255, 0}));
    EXPECT_EQ(heatColor(0.75), (Rgb8{255, 255, 0}));
    EXPECT_EQ(heatColor(1.0), (Rgb8{255, 0, 0}));
    EXPECT_EQ(heatColor(-1e30), heatColor(0.0));
    EXPECT_EQ(heatColor(std::numeric_limits<double>::infinity()), heatColor(1.0));
    EXPECT_EQ(heatColor(std::numeric_limits<double>::quiet_NaN()), kMagenta);
}

TEST(FilmPictures, LightAndAlbedoAreExposedSrgb)
{
    for (const Aov aov : {Aov::Radiance, Aov::Albedo}) {
        EXPECT_EQ(picture(aov, {pixel({0.25F, 0, 9}), pixel({0.09F, -1, 0.5F}), pixel({0, kNan, 0}), pixel({0, 0, -kInfinity})}, 1.0),
                  (std::vector<Rgb>{{188, 0, 255}, {118, 0, 255}, kBad, kBad}));
        EXPECT_EQ(picture(aov, {pixel({0.25F, 0, 0})}, -1.0), (std::vector<Rgb>{{srgbByte(0.125), 0, 0}}));
    }
}

TEST(FilmPictures, NormalsAreBytesWithoutACurve)
{
    const std::vector<PixelMoments> pixels{pixel({1, 0, -1}), pixel({0, 0.6F, 0.8F}), pixel({0, 0, 0}, 0.0F), pixel({0, 0, 0.25F}, 0.25F),
                                           pixel({kNan, 0, 0})};
    const std::vector<Rgb> expected{{255, 128, 0}, {128, 204, 230}, kBlack, {128, 128, 255}, kBad};
    EXPECT_EQ(picture(Aov::Normal, pixels), expected);
    EXPECT_EQ(picture(Aov::Normal, pixels, 3.0), expected) << "exposure is of light";
}

TEST(FilmPictures, DepthGoesFromWhiteToDark)
{
    const auto at = [](float depth, float alpha = 1.0F) {
        PixelMoments moments = pixel(glm::vec3(depth * alpha), alpha);
        moments.depth = alpha > 0.0F ? depth : std::numeric_limits<float>::infinity();
        return moments;
    };
    // 2 to 10 metres; the half-covered pixel's surface is at 6; dark is an eighth.
    EXPECT_EQ(picture(Aov::Depth, {at(2), at(10), at(6, 0.5F), at(0, 0), pixel(glm::vec3(kNan))}),
              (std::vector<Rgb>{{255, 255, 255}, {32, 32, 32}, {143, 143, 143}, kBlack, kBad}));
    EXPECT_EQ(picture(Aov::Depth, {at(3), at(3)}), (std::vector<Rgb>(2, {255, 255, 255})));
    EXPECT_EQ(picture(Aov::Depth, {at(0, 0)}), (std::vector<Rgb>{kBlack}));
}

TEST(FilmPictures, StepsAreHeatWhoseScaleAFewPixelsDoNotSet)
{
    const std::vector<PixelMoments> few{pixel({0, 50, 0}), pixel({20, 0, 0}), pixel({40, 0, 0}), pixel({40, 1, 0}), pixel({kNan, 0, 0})};
    EXPECT_EQ(picture(Aov::BvhSteps, few), (std::vector<Rgb>{kBlue, {0, 255, 0}, kRed, kRed, kBad}));
    std::vector<PixelMoments> pixels(2000, pixel({8, 0, 0}));
    pixels[0] = pixel({4, 0, 0});
    pixels[1] = pixel({1e6F, 0, 0});
    const std::vector<Rgb> found = picture(Aov::BvhSteps, pixels);
    EXPECT_EQ(found[0], (Rgb{0, 255, 0}));
    EXPECT_EQ(found[1], kRed);
    EXPECT_EQ(found[2], kRed);
    EXPECT_EQ(picture(Aov::BvhSteps, {pixel({0, 0, 0}), pixel({0, 3, 0})}), (std::vector<Rgb>(2, kBlue)));
}

TEST(FilmPictures, RatesGoFromTheFewestToTheMost)
{
    EXPECT_EQ(ratesPicture({32, 2048, 1040, 536}), (std::vector<Rgb>{kBlue, kRed, {0, 255, 0}, {0, 255, 255}}));
    EXPECT_EQ(ratesPicture({64, 64}), (std::vector<Rgb>(2, kBlue)));
    EXPECT_EQ(ratesPicture({0, 1}), (std::vector<Rgb>{kBlue, kRed}));
    EXPECT_EQ(ratesPicture({0, 4294967295U}), (std::vector<Rgb>{kBlue, kRed}));
}

TEST(FilmPictures, SettingsAreFoundInTheirDescription)
{
    RenderSettings settings;
    settings.aov = Aov::BvhSteps;
    const std::string text = describeSettings(settings);
    EXPECT_EQ(findSetting(text, "view"), "bvh-steps");
    EXPECT_EQ(findSetting(text, "bounces"), "64");
    EXPECT_EQ(findSetting(text, "adaptive"), "");
    EXPECT_EQ(findSetting(text, "ew"), "") << "a name's end is not the name";
}

}  // namespace
}  // namespace glim
