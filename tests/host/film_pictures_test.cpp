// What the picture of each AOV and of the samples per pixel looks like.
#include "host/render/film_pictures.hpp"
#include "host/image/decode_image.hpp"
#include "host/render/settings.hpp"
#include "shaders/shared/display_colors.h"
#include "tests/support/decode_png.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim {
namespace {

using test::Rgb;
using test::ScratchFolder;

const Rgb kBlack{0, 0, 0}, kBlue{0, 0, 255}, kRed{255, 0, 0}, kBad{255, 0, 255};
constexpr float kNanFloat = std::numeric_limits<float>::quiet_NaN(), kInfiniteFloat = std::numeric_limits<float>::infinity();

// A pixel of one sample that a share `alpha` of the rays had a surface for.
PixelMoments pixel(const glm::vec3& mean, float alpha = 1.0F)
{
    PixelMoments moments{};
    moments.count = 1;
    moments.mean = moments.normal = moments.albedo = mean;
    moments.alpha = alpha;
    return moments;
}

Film makeFilm(Aov aov, const std::vector<PixelMoments>& pixels)
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
    const Film film = makeFilm(aov, pixels);
    writeFilmPicture(folder / "a.png", film, getAov(film), {exposure});
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
    writeFilmPicture(folder / "r.png", makeFilm(Aov::Radiance, pixels), Aov::SampleCount);
    return test::decodePng(folder / "r.png");
}

TEST(HeatColor, GoesFromBlueToRed)
{
    const auto heat = [](double value) { return roundToBytes(heatColor(value)); };
    EXPECT_EQ(heat(0.0), (Rgb8{0, 0, 255}));
    EXPECT_EQ(heat(0.125), (Rgb8{0, 128, 255}));
    EXPECT_EQ(heat(0.25), (Rgb8{0, 255, 255}));
    EXPECT_EQ(heat(0.5), (Rgb8{0, 255, 0}));
    EXPECT_EQ(heat(0.75), (Rgb8{255, 255, 0}));
    EXPECT_EQ(heat(1.0), (Rgb8{255, 0, 0}));
    EXPECT_EQ(heat(-1e30), heat(0.0));
    EXPECT_EQ(heat(std::numeric_limits<double>::infinity()), heat(1.0));
}

TEST(FilmPictures, LightAndAlbedoAreExposedSrgb)
{
    for (const Aov aov : {Aov::Radiance, Aov::Albedo}) {
        EXPECT_EQ(
            picture(aov, {pixel({0.25F, 0, 9}), pixel({0.09F, -1, 0.5F}), pixel({0, kNanFloat, 0}), pixel({0, 0, -kInfiniteFloat})}, 1.0),
            (std::vector<Rgb>{{188, 0, 255}, {118, 0, 255}, kBad, kBad}));
        EXPECT_EQ(picture(aov, {pixel({0.25F, 0, 0})}, -1.0), (std::vector<Rgb>{{srgbByte(0.125), 0, 0}}));
    }
}

TEST(FilmPictures, TonesAreOfLightAlone)
{
    // Neutral: .3 loses .04, and 1 becomes 1 - .24^2 / (.96 + .24 - .76).
    std::vector<PixelMoments> pixels{pixel(glm::vec3(0.15F)), pixel(glm::vec3(0.5F)), pixel({kNanFloat, 0, 0})};
    for (PixelMoments& one : pixels) {
        one.albedo = glm::vec3(0.4F);
    }
    const auto drawn = [&](Aov aov, Tone tone) {
        std::vector<Rgb8> colors;
        for (const PixelMoments& one : pixels) {
            colors.push_back(displayColor(one, aov, {}, {1.0, tone}));
        }
        return colors;
    };
    const auto grey = [](double light) { return Rgb8{srgbByte(light), srgbByte(light), srgbByte(light)}; };
    EXPECT_EQ(drawn(Aov::Radiance, Tone::Neutral), (std::vector<Rgb8>{grey(0.26), grey(1.0 - 0.0576 / 0.44), kMagenta}));
    EXPECT_EQ(drawn(Aov::Albedo, Tone::Neutral), drawn(Aov::Albedo, Tone::None));
    EXPECT_EQ(drawn(Aov::Normal, Tone::Agx), drawn(Aov::Normal, Tone::None));
    for (PixelMoments& one : pixels) {
        one.albedo = one.mean;  // as of unlit surfaces, whose colours stay
    }
    EXPECT_EQ(drawn(Aov::Radiance, Tone::Neutral), drawn(Aov::Radiance, Tone::None));
    EXPECT_EQ(drawn(Aov::Radiance, Tone::Agx), drawn(Aov::Radiance, Tone::None));
}

TEST(FilmPictures, AnExposureIsChosenByTheLogAverage)
{
    const auto chosen = [](const std::vector<PixelMoments>& pixels) {
        return chooseExposure(makeFilm(Aov::Radiance, pixels), Aov::Radiance);
    };
    const PixelMoments dark = pixel(glm::vec3(0.09F)), bright = pixel(glm::vec3(0.36F));
    EXPECT_EQ(chosen({dark, bright}), 0.0);
    EXPECT_EQ(chosen({bright, bright}), -1.0);
    EXPECT_EQ(chosen({dark}), 1.0);
    EXPECT_EQ(chosen({pixel(glm::vec3(0.18F * std::exp2(7.3F)))}), -7.3);
    EXPECT_EQ(chosen({pixel({0, 0.18F, 0})}), 0.48) << "-log2 of .7152, to a hundredth";
    PixelMoments none = bright;
    none.count = 0;
    EXPECT_EQ(chosen({dark, pixel(glm::vec3(0)), pixel(glm::vec3(-1)), pixel({kNanFloat, 1, 1}), pixel({kInfiniteFloat, 1, 1}), none}), 1.0)
        << "others have no logarithm";
    EXPECT_EQ(chosen({pixel(glm::vec3(0))}), 0.0);
    EXPECT_EQ(chosen({}), 0.0);
    EXPECT_EQ(chosen({pixel(glm::vec3(1e-38F))}), 100.0) << "as far as --exposure goes";
    PixelMoments painted = bright;
    painted.albedo = glm::vec3(0.09F);
    EXPECT_EQ(chooseExposure(makeFilm(Aov::Albedo, {painted}), Aov::Albedo), 1.0);
}

TEST(FilmPictures, NormalsAreBytesWithoutACurve)
{
    const std::vector<PixelMoments> pixels{pixel({1, 0, -1}), pixel({0, 0.6F, 0.8F}), pixel({0, 0, 0}, 0.0F), pixel({0, 0, 0.25F}, 0.25F),
                                           pixel({kNanFloat, 0, 0})};
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
    EXPECT_EQ(picture(Aov::Depth, {at(2), at(10), at(6, 0.5F), at(0, 0), pixel(glm::vec3(kNanFloat))}),
              (std::vector<Rgb>{{255, 255, 255}, {32, 32, 32}, {143, 143, 143}, kBlack, kBad}));
    EXPECT_EQ(picture(Aov::Depth, {at(3), at(3)}), (std::vector<Rgb>(2, {255, 255, 255})));
    EXPECT_EQ(picture(Aov::Depth, {at(0, 0)}), (std::vector<Rgb>{kBlack}));
}

TEST(FilmPictures, StepsAreHeatWhoseScaleAFewPixelsDoNotSet)
{
    const std::vector<PixelMoments> few{pixel({0, 50, 0}), pixel({20, 0, 0}), pixel({40, 0, 0}), pixel({40, 1, 0}),
                                        pixel({kNanFloat, 0, 0})};
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

DecodedImage drawHidden(const char* name, Aov aov, const std::vector<PixelMoments>& pixels, const Look& look = {})
{
    const ScratchFolder folder;
    Film film = makeFilm(aov, pixels);
    film.showsBackground = false;
    writeFilmPicture(folder / name, film, aov, look);
    const std::string bytes = test::readFileBytes(folder / name);
    return decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

using PixelBytes = std::vector<std::uint8_t>;

// Colours are those of the surfaces: premultiplied radiance, albedo and normals are divided by alpha.
TEST(FilmPictures, HaveAlphaWhereTheBackgroundIsHidden)
{
    const glm::vec3 grey(0.5F);
    const std::uint8_t half = srgbByte(0.5);
    const std::vector<PixelMoments> pixels{pixel(grey), pixel(0.25F * grey, 0.25F), pixel(glm::vec3(0), 0), pixel(1e-3F * grey, 1e-3F),
                                           pixel(glm::vec3(kNanFloat), 0.5F)};
    const PixelBytes expected{half, half, half, 255, half, half, half, 64, 0, 0, 0, 0, 0, 0, 0, 0, 255, 0, 255, 255};
    for (const char* name : {"a.png", "a.webp"}) {
        EXPECT_EQ(drawHidden(name, Aov::Radiance, pixels).rgba8, expected) << name;
        EXPECT_EQ(drawHidden(name, Aov::Albedo, pixels).rgba8, expected) << name;
    }
    const Rgb8 toned = displayColor(pixel({2, 1, 0.5F}), Aov::Radiance, {}, {1.0, Tone::Agx});
    PixelMoments lit = pixel({1, 0.5F, 0.25F}, 0.5F), whole = pixel({2, 1, 0.5F});
    lit.albedo = whole.albedo = glm::vec3(0.1F);
    const Rgb8 shown = displayColor(whole, Aov::Radiance, {}, {1.0, Tone::Agx});
    EXPECT_NE(shown, toned) << "the tone is of lit surfaces";
    EXPECT_EQ(drawHidden("a.png", Aov::Radiance, {lit}, {1.0, Tone::Agx}).rgba8, (PixelBytes{shown[0], shown[1], shown[2], 128}));
    PixelMoments edge = pixel(glm::vec3(0.3F), 0.5F);
    edge.normal = {0.5F, 0, 0};
    EXPECT_EQ(drawHidden("a.png", Aov::Normal, {edge, pixel(glm::vec3(0), 0)}).rgba8, (PixelBytes{255, 128, 128, 128, 0, 0, 0, 0}));
}

TEST(FilmPictures, CountsAndJpegsAreOpaque)
{
    const std::vector<PixelMoments> pixels{pixel({0.5F, 0.25F, 0}, 0.5F), pixel(glm::vec3(0), 0)};
    for (const Aov aov : {Aov::SampleCount, Aov::BvhSteps}) {
        EXPECT_FALSE(drawHidden("a.png", aov, pixels).hasAlpha);
    }
    const ScratchFolder folder;
    Film film = makeFilm(Aov::Radiance, pixels);
    writeFilmPicture(folder / "shown.jpg", film, Aov::Radiance);
    film.showsBackground = false;
    writeFilmPicture(folder / "hidden.jpg", film, Aov::Radiance);
    EXPECT_EQ(test::readFileBytes(folder / "hidden.jpg"), test::readFileBytes(folder / "shown.jpg"));
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
