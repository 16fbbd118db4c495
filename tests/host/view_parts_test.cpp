// What the viewer makes of a file's channels, and where it places a picture in its window.
#include "host/error.hpp"
#include "host/image/exr.hpp"
#include "host/render/film_pictures.hpp"
#include "host/view/layers.hpp"
#include "host/view/viewed_films.hpp"
#include "host/window/viewport.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace glim {
namespace {

Image imageOf(std::uint32_t width, std::uint32_t height, const std::vector<std::string>& channels, const std::vector<std::string>& counts)
{
    Image image;
    image.width = width;
    image.height = height;
    float value = 0.0F;
    for (const std::string& channel : channels) {
        for (std::uint32_t i = 0; i < width * height; ++i) {
            image.channels[channel].push_back(value += 0.25F);
        }
    }
    for (const std::string& channel : counts) {
        for (std::uint32_t i = 0; i < width * height; ++i) {
            image.counts[channel].push_back(7 + i);
        }
    }
    return image;
}

Layer layerOf(const Image& image, const std::string& name)
{
    for (const Layer& layer : collectLayers(image)) {
        if (layer.name == name) {
            return layer;
        }
    }
    ADD_FAILURE() << name;
    return {};
}

TEST(LayersTest, ChannelsAreGroupedAsTheirNamesSay)
{
    const Image image = imageOf(2, 2,
                                {"R",
                                 "G",
                                 "B",
                                 "A",
                                 "Z",
                                 ".R",
                                 "albedo.R",
                                 "albedo.G",
                                 "albedo.B",
                                 "normal.X",
                                 "normal.Y",
                                 "normal.Z",
                                 "depth.Z",
                                 "denoisedError.R",
                                 "denoisedError.G",
                                 "denoisedError.B",
                                 "View.Combined.R",
                                 "View.Combined.G",
                                 "View.Combined.B",
                                 "View.Combined.A",
                                 "motion.X",
                                 "motion.Y",
                                 "CryptoAsset00.R",
                                 "CryptoAsset00.G",
                                 "CryptoAsset00.B",
                                 "CryptoAsset00.A"},
                                {"count.X", "node.X"});
    struct Expected {
        const char* name;
        std::size_t channels;
        ShownAs as;
        bool isExposed, isToned;
    };
    const std::vector<Expected> expected{
        {"color", 4, ShownAs::Color, true, true},         {".R", 1, ShownAs::Heat, false, false},
        {"Z", 1, ShownAs::Depth, false, false},           {"CryptoAsset00", 4, ShownAs::Color, false, false},
        {"View.Combined", 4, ShownAs::Color, true, true}, {"albedo", 3, ShownAs::Color, true, false},
        {"count", 1, ShownAs::Heat, false, false},        {"denoisedError", 3, ShownAs::Heat, false, false},
        {"depth", 1, ShownAs::Depth, false, false},       {"motion.X", 1, ShownAs::Heat, false, false},
        {"motion.Y", 1, ShownAs::Heat, false, false},     {"node", 1, ShownAs::Ids, false, false},
        {"normal", 3, ShownAs::Vector, false, false}};
    const std::vector<Layer> layers = collectLayers(image);
    ASSERT_EQ(layers.size(), expected.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        EXPECT_EQ(layers[i].name, expected[i].name);
        EXPECT_EQ(layers[i].channels.size(), expected[i].channels) << layers[i].name;
        EXPECT_EQ(layers[i].shownAs, expected[i].as) << layers[i].name;
        EXPECT_EQ(layers[i].isExposed, expected[i].isExposed) << layers[i].name;
        EXPECT_EQ(layers[i].isToned, expected[i].isToned) << layers[i].name;
    }
    EXPECT_EQ(layers[0].channels, (std::vector<std::string>{"R", "G", "B", "A"}));
    EXPECT_EQ(toText(numbersOf(image, layers[0], 1)), "0.5 1.5 2.5 3.5");
    EXPECT_EQ(toText(numbersOf(image, layerOf(image, "count"), 3)), "10");
}

TEST(LayersTest, ALoneYIsLuminance)
{
    const Layer layer = layerOf(imageOf(1, 1, {"Y"}, {}), "Y");
    EXPECT_EQ(layer.shownAs, ShownAs::Color);
    EXPECT_TRUE(layer.isExposed && layer.isToned);
}

TEST(LayersTest, NumbersAreWrittenWithSixDigitsAndWholeOnesWithAll)
{
    EXPECT_EQ(toText(std::vector<double>()), "-");
    EXPECT_EQ(toText({4294967295.0, 0.1234567, 1e30, -2.0}), "4294967295 0.123457 1e+30 -2");
    EXPECT_EQ(toText({std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}), "nan inf");
}

TEST(LayersTest, NormalsOfFilmsAreDividedByAlphaAndDepthsWithoutASurfaceAreNothing)
{
    Image image = imageOf(4, 1, {"A", "normal.X", "normal.Y", "normal.Z", "depth.Z"}, {});
    image.channels["A"] = {1.0F, 0.5F, 0.0F, 1.0F};
    image.channels["normal.X"] = {0.5F, 0.5F, 0.0F, 0.0F};
    image.channels["normal.Y"] = image.channels["normal.Z"] = {0.0F, 0.0F, 0.0F, 0.0F};
    image.channels["depth.Z"] = {3.0F, 2.0F, 9.0F, 1e10F};
    const Layer normal = layerOf(image, "normal"), depth = layerOf(image, "depth");
    EXPECT_EQ(valuesOf(image, normal).radiance[1].x, 0.5F) << "another renderer's";
    image.attributes["glim:film"] = 1.0;
    EXPECT_EQ(valuesOf(image, normal).radiance[1].x, 1.0F);
    EXPECT_EQ(valuesOf(image, normal).radiance[2], glm::vec3(0.0F));
    const Picture depths = valuesOf(image, depth);
    EXPECT_EQ(depths.radiance, (std::vector<glm::vec3>{glm::vec3(3.0F), glm::vec3(2.0F), glm::vec3(0.0F), glm::vec3(0.0F)}));
    const auto range = getRange(image, depth, depths);
    ASSERT_TRUE(range);
    EXPECT_EQ(range->low, 2.0F);
    EXPECT_EQ(range->high, 3.0F);
    EXPECT_FALSE(getRange(image, normal, valuesOf(image, normal)));
    image.channels["depth.Z"] = {0.0F, 0.0F, 0.0F, std::numeric_limits<float>::infinity()};
    EXPECT_FALSE(getRange(image, depth, valuesOf(image, depth))) << "nothing is there";
    image.channels["depth.Z"][0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isnan(valuesOf(image, depth).radiance[0].x)) << "is seen";
}

TEST(LayersTest, RangesOfHeat)
{
    Image image = imageOf(1000, 1, {"error.R", "error.G", "error.B"}, {"count.X", "blocks.X"});
    for (std::size_t i = 0; i < 1000; ++i) {
        image.channels["error.R"][i] = static_cast<float>(i);
        image.channels["error.G"][i] = image.channels["error.B"][i] = static_cast<float>(i);
        image.counts["blocks.X"][i] = 5;
    }
    image.channels["error.R"][7] = std::numeric_limits<float>::infinity();
    const auto range = [&](const char* name) {
        const Layer layer = layerOf(image, name);
        return getRange(image, layer, valuesOf(image, layer)).value();
    };
    EXPECT_EQ(range("error").low, 0.0F);
    EXPECT_EQ(range("error").high, 998.0F) << "of 999 finite numbers the largest but one";
    EXPECT_EQ(range("count").low, 7.0F);
    EXPECT_EQ(range("count").high, 1006.0F);
    EXPECT_EQ(range("blocks").low, 5.0F);
    EXPECT_EQ(range("blocks").high, 5.0F);
}

TEST(LayersTest, EachIdHasAColourAndNoneIsBlack)
{
    Image image = imageOf(3, 1, {}, {"node.X"});
    image.counts["node.X"] = {0, 1, 4294967295U};
    const Picture colors = valuesOf(image, layerOf(image, "node"));
    EXPECT_NE(colors.radiance[0], colors.radiance[1]);
    EXPECT_NE(colors.radiance[0], glm::vec3(0.0F));
    EXPECT_EQ(colors.radiance[2], glm::vec3(0.0F));
}

// Each pixel has its column and its row.
Picture numbered(std::uint32_t width, std::uint32_t height)
{
    Picture picture{width, height, {}, {}, 0};
    for (std::uint32_t i = 0; i < width * height; ++i) {
        picture.radiance.emplace_back(static_cast<float>(i % width), static_cast<float>(i / width), 0.0F);
    }
    return picture;
}

TEST(ViewportTest, FitsInTheMiddle)
{
    const Viewport larger = fit({100, 50}, {350, 400}), smaller = fit({400, 100}, {200, 300});
    EXPECT_EQ(larger.zoom, 3.0) << "whole pixels";
    EXPECT_EQ(larger.corner, glm::dvec2(25, 125));
    EXPECT_EQ(smaller.zoom, 0.5);
    EXPECT_EQ(smaller.corner, glm::dvec2(0, 125));
    EXPECT_EQ(fit({1, 1}, {1000, 1000}).zoom, 64.0);
    EXPECT_EQ(actualSize({100, 50}, {350, 400}).corner, glm::dvec2(125, 175));
}

TEST(ViewportTest, ZoomKeepsThePointUnderTheMouse)
{
    Viewport viewport{2.0, {10.0, 20.0}};
    const glm::dvec2 mouse(131.0, 77.0);
    const auto before = (mouse - viewport.corner) / viewport.zoom;
    for (const double factor : {1.5, 8.0, 8.0, 0.001, 0.1, 64.0}) {
        viewport = zoomAt(viewport, mouse, factor);
        EXPECT_LT(glm::length((mouse - viewport.corner) / viewport.zoom - before), 1e-9);
        EXPECT_GE(viewport.zoom, 1.0 / 64.0);
        EXPECT_LE(viewport.zoom, 64.0);
    }
    EXPECT_EQ(zoomAt({0.01, {}}, mouse, 0.5).zoom, 0.01) << "a picture that had to be smaller to fit stays";
}

TEST(ViewportTest, FindsThePixelUnderThePoint)
{
    const Viewport viewport{4.0, {10.0, 20.0}};
    EXPECT_EQ(pixelAt(viewport, {10.5, 20.5}, {5, 5}), glm::uvec2(0, 0));
    EXPECT_EQ(pixelAt(viewport, {29.5, 39.5}, {5, 5}), glm::uvec2(4, 4));
    EXPECT_FALSE(pixelAt(viewport, {9.5, 20.5}, {5, 5}));
    EXPECT_FALSE(pixelAt(viewport, {30.5, 20.5}, {5, 5}));
    EXPECT_FALSE(pixelAt(viewport, {10.5, 40.5}, {5, 5}));
}

// Wherever the picture lies, the window's pixels over it have the value that pixelAt names, and no other is written.
TEST(ViewportTest, LaysTheValuesOfTheSamePixels)
{
    const Picture picture = numbered(7, 5);
    const glm::uvec2 window(40, 30), size(7, 5);
    for (const Viewport& viewport : {Viewport{1.0, {0, 0}}, Viewport{3.0, {4, 5}}, Viewport{2.3, {-6.4, 11.7}},
                                     Viewport{64.0, {-100, -100}}, Viewport{1.0, {100, 0}}, Viewport{5.0, {30.5, 20.25}}}) {
        std::vector<glm::vec3> values(std::size_t{window.x} * window.y, glm::vec3(-1.0F));
        layUnder({size, picture.radiance}, viewport, window, true, values);
        const Rectangle covered = coveredBy(viewport, size, window);
        for (std::uint32_t y = 0; y < window.y; ++y) {
            for (std::uint32_t x = 0; x < window.x; ++x) {
                const auto pixel = pixelAt(viewport, glm::dvec2(x, y) + 0.5, size);
                const glm::vec3 expected = pixel ? glm::vec3(*pixel, 0) : glm::vec3(-1.0F);
                EXPECT_EQ(values[std::size_t{y} * window.x + x], expected) << x << ", " << y << " at zoom " << viewport.zoom;
                const bool inside = x >= covered.low.x && x < covered.high.x && y >= covered.low.y && y < covered.high.y;
                EXPECT_EQ(inside, pixel.has_value());
            }
        }
    }
}

// Of a picture made smaller each pixel counts once: the means add up to the picture's.
TEST(ViewportTest, MakesSmallerByTheMean)
{
    const Picture picture = numbered(12, 9);
    std::vector<glm::vec3> values;
    layUnder({{12, 9}, picture.radiance}, {1.0 / 3.0, {0, 0}}, {4, 3}, true, values);
    for (std::uint32_t y = 0; y < 3; ++y) {
        for (std::uint32_t x = 0; x < 4; ++x) {
            EXPECT_EQ(values[y * 4 + x], glm::vec3(3 * x + 1, 3 * y + 1, 0));
        }
    }
    layUnder({{12, 9}, picture.radiance}, {0.4, {0.3, 0.2}}, {6, 5}, true, values);  // of 2.5 pixels a side, one has two or three centres
    const Rectangle covered = coveredBy({0.4, {0.3, 0.2}}, {12, 9}, {6, 5});
    for (std::uint32_t y = covered.low.y; y < covered.high.y; ++y) {
        for (std::uint32_t x = covered.low.x; x < covered.high.x; ++x) {
            const glm::dvec2 center = (glm::dvec2(x, y) + 0.5 - glm::dvec2(0.3, 0.2)) / 0.4 - 0.5;
            EXPECT_LT(glm::length(glm::dvec2(values[y * 6 + x]) - center), 1.0) << x << ", " << y;
        }
    }
}

// Of ids and depths, whose means are nothing.
TEST(ViewportTest, MakesSmallerByTheCentreWhereMeansAreNothing)
{
    std::vector<glm::vec3> values;
    const Picture picture = numbered(12, 9);
    layUnder({{12, 9}, picture.radiance}, {1.0 / 3.0, {0, 0}}, {4, 3}, false, values);
    for (std::uint32_t i = 0; i < 12; ++i) {
        EXPECT_EQ(values[i], glm::vec3(3 * (i % 4) + 1, 3 * (i / 4) + 1, 0));
    }
}

TEST(ViewportTest, APictureThinnerThanAPixelIsSeen)
{
    const Rectangle covered = coveredBy(fit({3000, 1}, {640, 480}), {3000, 1}, {640, 480});
    EXPECT_EQ(covered.high - covered.low, glm::uvec2(640, 1));
    std::vector<glm::vec3> values;
    const Picture picture = numbered(3000, 1);
    layUnder({{3000, 1}, picture.radiance}, fit({3000, 1}, {640, 480}), {640, 480}, true, values);
    EXPECT_NEAR(values[covered.low.y * 640 + 320].x, 1501.8F, 3.0F);
    const Rectangle outside = coveredBy({0.01, {-5, 700}}, {3, 3}, {640, 480});
    EXPECT_EQ(outside.high, outside.low) << "beside the window";
}

Image colors(std::uint32_t width, std::uint32_t height, std::uint32_t rowsAbove = 0)
{
    Image image = imageOf(width, height, {"R", "G", "B"}, {});
    image.rowsAbove = rowsAbove;
    return image;
}

TEST(ViewedFilmsTest, SizesAndRowsMustAgree)
{
    const test::ScratchFolder folder;
    writeExr(folder / "a.exr", colors(4, 3));
    writeExr(folder / "b.exr", colors(3, 4));
    writeExr(folder / "c.exr", colors(4, 3, 2));
    test::expectRefusal<InputError>([&] { ViewedFilms(folder / "a.exr", folder / "b.exr"); }, MessageId::Mismatch,
                                    {.file = "b.exr", .value = "3x4", .expected = "4x3"});
    test::expectRefusal<InputError>([&] { ViewedFilms(folder / "a.exr", folder / "c.exr"); }, MessageId::Mismatch,
                                    {.file = "c.exr", .value = "4x3 from (0, 2) on", .expected = "4x3"});
    EXPECT_EQ(ViewedFilms(folder / "a.exr", std::nullopt).count(), 1U);
}

TEST(ViewedFilmsTest, ListsTheLayersOfBoth)
{
    const test::ScratchFolder folder;
    writeExr(folder / "a.exr", imageOf(2, 2, {"R", "G", "B", "depth.Z"}, {}));
    writeExr(folder / "b.exr", imageOf(2, 2, {"R", "G", "B", "denoised.R", "denoised.G", "denoised.B"}, {}));
    const ViewedFilms films(folder / "a.exr", folder / "b.exr");
    EXPECT_EQ(films.title(), "a.exr and b.exr");
    ASSERT_EQ(films.layers().size(), 3U);
    const std::vector<std::tuple<std::string, bool, bool>> expected{
        {"color", true, true}, {"depth", true, false}, {"denoised", false, true}};
    for (std::size_t i = 0; i < 3; ++i) {
        const ViewedLayer& layer = films.layers()[i];
        EXPECT_EQ(std::tuple(layer.name, layer.of[0].has_value(), layer.of[1].has_value()), expected[i]);
    }
}

// As if the clock had gone on meanwhile.
void writeLater(const std::filesystem::path& path, const Image& image)
{
    const auto before = std::filesystem::last_write_time(path);
    writeExr(path, image);
    std::filesystem::last_write_time(path, before + std::chrono::seconds(1));
}

TEST(ViewedFilmsTest, ReadsFilesThatChangeAndKeepsWhatItHasOfBrokenOnes)
{
    const test::ScratchFolder folder;
    const auto a = folder / "a.exr", b = folder / "b.exr";
    writeExr(a, colors(4, 3));
    writeExr(b, colors(4, 3));
    ViewedFilms films(a, b);
    const auto taken = [&films] { return films.readChanged().taken; };
    const std::vector<std::string> none, onlyA{"a.exr"}, onlyB{"b.exr"}, both{"a.exr", "b.exr"};
    EXPECT_EQ(taken(), none);
    Image brighter = colors(4, 3);
    brighter.channels["R"][0] = 9.0F;
    writeLater(a, brighter);
    EXPECT_EQ(taken(), onlyA);
    EXPECT_EQ(films.image(0).channels.at("R")[0], 9.0F);
    EXPECT_EQ(taken(), none);

    brighter.channels["R"][0] = 10.0F;
    writeLater(a, brighter);
    test::writeText(b, "no film");
    std::filesystem::last_write_time(b, std::filesystem::last_write_time(a) + std::chrono::seconds(5));
    const ViewedFilms::Reading broken = films.readChanged();
    EXPECT_EQ(broken.taken, onlyA) << "whatever B is";
    ASSERT_TRUE(broken.trouble);
    EXPECT_TRUE(broken.trouble->file.ends_with("b.exr")) << broken.trouble->sentence;
    EXPECT_EQ(films.image(0).channels.at("R")[0], 10.0F);
    EXPECT_EQ(films.image(1).width, 4U);
    EXPECT_FALSE(films.readChanged().trouble) << "not twice";
    std::filesystem::remove(b);
    EXPECT_EQ(taken(), none);

    writeExr(b, colors(4, 3));
    std::filesystem::last_write_time(b, std::filesystem::last_write_time(a) + std::chrono::seconds(9));
    EXPECT_EQ(taken(), onlyB);
    writeLater(a, colors(6, 5));
    const ViewedFilms::Reading larger = films.readChanged();
    ASSERT_TRUE(larger.trouble);
    test::expectMessage(*larger.trouble, MessageId::Mismatch, {.file = "b.exr", .value = "4x3", .expected = "6x5"});
    EXPECT_EQ(films.size(), glm::uvec2(4, 3));
    EXPECT_EQ(taken(), none) << "still apart";
    writeLater(b, colors(6, 5));
    EXPECT_EQ(taken(), both) << "both have grown";
    EXPECT_EQ(films.size(), glm::uvec2(6, 5));
}

TEST(ViewedFilmsTest, LayersOfOneNameThatAreShownOtherwiseStayApart)
{
    const test::ScratchFolder folder;
    writeExr(folder / "a.exr", imageOf(2, 2, {"depth.Z"}, {"node.X"}));
    writeExr(folder / "b.exr", imageOf(2, 2, {"depth.V", "node.X"}, {}));
    const ViewedFilms films(folder / "a.exr", folder / "b.exr");
    EXPECT_EQ(films.layers().size(), 4U);
}

}  // namespace
}  // namespace glim
