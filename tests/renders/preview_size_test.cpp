// A picture of a size of its own in the window, and displays with small pixels.
#include "host/gpu/device.hpp"
#include "host/preview/picture_drawer.hpp"
#include "host/preview/scene_pictures.hpp"
#include "host/render/aov.hpp"
#include "tests/harness/test_device.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/preview_fixture.hpp"

#include <algorithm>

namespace glim::test {
namespace {

constexpr std::array kBeside{51, 51, 51};

// What a window of this size should show of a film: each pixel the mean of those under it.
Pixels shownSmaller(const Film& film, const glm::uvec2& window)
{
    std::vector<glm::vec3> values, under;
    std::ranges::transform(film.pixels, std::back_inserter(values), [](const PixelMoments& pixel) { return pixel.mean; });
    const glm::uvec2 size(film.width, film.height);
    layUnder({size, values}, fit(size, window), window, true, under);
    Pixels pixels;
    for (const glm::vec3& value : under) {
        PixelMoments moments{};
        moments.count = 1;
        moments.mean = value;
        const Rgb8 color = displayColor(moments, Aov::Radiance, {}, Look{});
        pixels.push_back({color[0], color[1], color[2]});
    }
    return pixels;
}

// The bits are a render's, whatever the window. Then the window changes, and the picture goes on.
TEST_F(PreviewTest, APictureLargerThanTheWindowIsShownByItsMeans)
{
    width = 384;
    height = 288;
    ownWindow = {96, 72};
    const Pixels shown = windowAtWriting(screen, "0 samples 2\n0 key P\n", {"--spp", "2"});
    const Film expected = render("--spp 2");
    EXPECT_TRUE(sameBits(film(1), expected));
    EXPECT_EQ(countOthers(shown, shownSmaller(expected, *ownWindow)), 0);
    removePictures();
    const GlimRun session = run("0 samples 2\n0 resize 200x50\n0.3 samples 2\n0 key C\n0 key P\n0 close\n", {"--spp", "2"});
    EXPECT_EQ(firstLine(session.out), "--camera 0 --size 384x288");
    EXPECT_TRUE(sameBits(film(1), expected));
}

TEST_F(PreviewTest, AFilmOfSeveralTilesIsShownByItsMeans)
{
    width = 1200;
    height = 900;  // 31,424 pixels more than a tile
    ownWindow = {240, 180};
    const Pixels shown = windowAtWriting(screen, "0 samples 1\n0 key P\n", {"--spp", "1", "--bounces", "1"});
    const Film made = film(1);
    EXPECT_TRUE(sameBits(made, render("--spp 1 --bounces 1")));
    const Pixels expected = shownSmaller(made, *ownWindow);
    EXPECT_LE(countOthers(shown, expected), 240) << "the row that has parts of both tiles";
    EXPECT_GE(countOthers(shown, expected), 0);
}

// By whole steps, in the middle of the window. What is beside it answers no click.
TEST_F(PreviewTest, ASmallerPictureIsMagnifiedByWholeSteps)
{
    width = height = 48;
    ownWindow = {200, 100};
    const Pixels shown = windowAtWriting(screen, "0 samples 4\n0 key P\n", {"--spp", "4"});
    const Pixels made = picture(1);
    ASSERT_EQ(shown.size(), std::size_t{200} * 100);
    Pixels expected(shown.size(), kBeside);
    for (std::size_t y = 0; y < 96; ++y) {
        for (std::size_t x = 0; x < 96; ++x) {
            expected[(2 + y) * 200 + 52 + x] = made[y / 2 * 48 + x / 2];
        }
    }
    EXPECT_EQ(countOthers(shown, expected), 0);
    removePictures();
    const GlimRun session = run("0 samples 4\n0 click 53,3\n0 click 147,97\n0 click 20,50\n0 click 148,50\n0 close\n", {"--spp", "4"});
    const std::size_t second = session.out.find('\n') + 1;
    EXPECT_EQ(session.out.find("pixel (0, 0) of 48x48: "), 0U) << session.out;
    EXPECT_EQ(session.out.find("pixel (47, 47) of 48x48: "), second) << session.out;
    EXPECT_EQ(session.out.find('\n', second) + 1, session.out.size()) << "nothing is beside it: " << session.out;
}

// The picture's pixel is what the mouse is over, and the same way over the picture moves the same.
TEST_F(PreviewTest, TheMouseMovesWhatItIsOver)
{
    width = 96;
    height = 72;
    const std::string ends = "0 scroll 1\n0 key C\n0 close\n";
    const std::string plain = run("0 samples 1\n0 drag left 2,20 42,30\n0 drag middle 40,40 20,28\n" + ends, {"--spp", "1"}).out;
    ownWindow = {300, 144};  // 54 pixels beside it
    const std::string scaled = run("0 samples 1\n0 drag left 58,40 138,60\n0 drag middle 134,80 94,56\n" + ends, {"--spp", "1"}).out;
    EXPECT_EQ(scaled, plain);
    EXPECT_NE(plain.find("--look-from"), std::string::npos);
}

// Without --size the picture has the size that fits the camera.
TEST_F(PreviewTest, TheWindowAloneLeavesThePictureToTheCamera)
{
    ownWindow = {96, 72};
    GlimCall session = call("0 samples 1\n0 key C\n0 close\n", {"--spp", "1"});
    session.arguments.erase(session.arguments.begin() + 4, session.arguments.begin() + 6);
    const GlimRun done = runGlim(session);
    EXPECT_EQ(done.exitCode, 0) << done.err;
    EXPECT_EQ(firstLine(done.out), "--camera 0 --size 512x512");
}

// Where the controls are is known from a look at the window.
TEST_F(PreviewTest, ThePanelChoosesTheSizeOfThePicture)
{
    width = 640;
    height = 480;
    panels = true;
    const GlimRun session =
        run("0 samples 1\n0 click 60,200\n0.2 click 60,242\n0.5 samples 1\n0 key C\n0 key P\n0 close\n", {"--spp", "1"});
    EXPECT_EQ(firstLine(session.out), "--camera 0 --size 320x240");
    EXPECT_TRUE(sameBits(film(1), render("--spp 1 --size 320x240")));
}

// What is left of the addresses is less than 1920x1080 need.
TEST_F(PreviewTest, ASizeThatMemoryDoesNotHoldIsRefusedAndTheOldOneStays)
{
    width = 640;
    height = 480;
    panels = true;
    const std::uint64_t kibibytes = (driverAddresses() >> 10U) + 900 * 1024;
    GlimCall limited =
        afterCommand("ulimit -v " + std::to_string(kibibytes),
                     call("0 samples 1\n0 click 60,200\n0.2 click 60,259\n0.5 samples 1\n0 key C\n0 close\n", {"--spp", "1"}));
    limited.environment["GLIM_VALIDATION"] = std::nullopt;  // the layers take addresses too
    const GlimRun done = runGlim(limited);
    EXPECT_EQ(done.exitCode, 0) << done.err;
    EXPECT_NE(done.err.find("the scene and a picture of 1920x1080 need "), std::string::npos) << done.err;
    EXPECT_EQ(firstLine(done.out), "--camera 0 --size 640x480");
}

TEST(PictureDrawerTest, AFilmOfTheWindowsScaleIsNoLargerThanItsPart)
{
    PictureDrawer drawer(testDevice());
    const std::pair<glm::uvec2, std::uint32_t> kScales[] = {{{640, 480}, 1},  {{100, 100}, 1},    {{641, 480}, 2},
                                                            {{1280, 960}, 2}, {{4096, 4096}, 16}, {{65535, 3}, 128}};
    for (const auto& [size, scale] : kScales) {
        drawer.resize(size, {640, 480});
        EXPECT_EQ(drawer.windowScale(), scale) << size.x << "x" << size.y;
    }
}

// Of 64 x 48 pixels the window shows 16 x 12: while the camera moves the film has no more, then as many, and then all.
TEST(ScenePicturesTest, APictureLargerThanTheWindowBeginsWithNoMorePixelsThanThat)
{
    RenderSettings settings;
    settings.sampleEnd = 2;
    ScenePictures pictures(testDevice(), settings, {}, [] {});
    auto loaded = std::make_unique<LoadedScene>(sceneFile("cornell_spheres.gltf"), LoadOptions{});
    updateScene(loaded->prepared, loaded->file, std::nullopt, SplitRule::Sah);
    pictures.enter(std::move(loaded));
    pictures.setWindowScale(4);
    std::vector<std::uint32_t> scales;
    for (int i = 0; i < 4; ++i) {  // the film of a move becomes finer where pictures are fast
        pictures.show(pictures.scene().scene.cameras.front(), {64, 48});
        EXPECT_GE(pictures.shown().scale(), 4U);
        EXPECT_LE(pictures.shown().renderer().settings().width, 16U);
        pictures.shown().refine(false, nullptr);
    }
    while (pictures.shown().sampleCount() < 2) {
        pictures.shown().refine(false, nullptr);
        if (scales.empty() || scales.back() != pictures.shown().scale()) {
            scales.push_back(pictures.shown().scale());
        }
        EXPECT_EQ(pictures.shown().windowSampleCount() > 0, pictures.shown().scale() == 4) << pictures.shown().scale();
    }
    ASSERT_GE(scales.size(), 2U);
    EXPECT_EQ(scales[scales.size() - 2], 4U);
    EXPECT_EQ(scales.back(), 1U);
}

// The picture's pixels are the display's. Without a size the window grows with what is in it.
TEST_F(PreviewTest, AWindowWithoutASizeGrowsWithTheDensityOfTheDisplay)
{
    const VirtualScreen display(24, 144);
    GlimCall session = call("0 samples 1\n0 key C\n0 close\n", {"--spp", "1"});
    session.arguments.erase(session.arguments.begin() + 4, session.arguments.begin() + 6);
    session.environment["DISPLAY"] = display.name();
    const GlimRun done = runGlim(session);
    EXPECT_EQ(done.exitCode, 0) << done.err;
    EXPECT_EQ(firstLine(done.out), "--camera 0 --size 768x768");
}

// The window comes to a display of twice the density, and back.
TEST_F(PreviewTest, PanelsFollowTheDisplayThatTheWindowComesTo)
{
    width = 800;
    height = 600;
    panels = true;
    // By panels, in the upper `rows`: below them a message comes and goes.
    const auto covered = [&](const std::string& steps, std::size_t rows) {
        Pixels shown = windowAtWriting(screen, "0 samples 1\n" + steps + "0.5 key P\n", {"--spp", "1"}), plain = picture(1);
        removePictures();
        shown.resize(rows * width);
        plain.resize(rows * width);
        return countOthers(shown, plain);
    };
    const int once = covered("", 300), twice = covered("0 scale 2\n", height);
    EXPECT_NEAR(static_cast<double>(twice) / once, 4.0, 0.5);
    EXPECT_NEAR(covered("0 scale 2\n0.5 scale 1\n", 300), once, 0.02 * once);  // numbers differ
}

}  // namespace
}  // namespace glim::test
