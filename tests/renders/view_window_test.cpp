// Scripted sessions of `glim view` on a screen of the test's own: it shows what `glim render` and `glim compare` draw.
#include "host/image/exr.hpp"
#include "tests/support/expect_message.hpp"
#include "tests/support/preview_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <set>

namespace glim::test {
namespace {

using Arguments = std::vector<std::string>;

class ViewWindowTest : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        films = new ScratchFolder;
        make({"render", sceneFile("cornell_spheres.gltf"), "-o", "a.exr", "--size", "96x72", "--spp", "64", "--png", "a.png", "--denoise",
              "--image", "denoised.png"});
        make(
            {"render", sceneFile("cornell_spheres.gltf"), "-o", "b.exr", "--size", "96x72", "--spp", "8", "--seed", "5", "--png", "b.png"});
    }
    static void TearDownTestSuite()
    {
        delete films;
        films = nullptr;
    }

    static GlimRun make(const Arguments& arguments)
    {
        GlimCall call;
        call.arguments = arguments;
        call.folder = films->path();
        const GlimRun done = runGlim(call);
        EXPECT_EQ(done.exitCode, 0) << done.err;
        return done;
    }
    static Pixels png(const char* name) { return decodePng(*films / name); }

    // `glim view` in a window of 96x72 pixels. The panels are hidden first.
    GlimCall call(const std::string& script, const Arguments& arguments) const
    {
        writeText(*films / "script", "0 samples 1\n0 key H\n0 key H\n" + script);
        GlimCall made;
        made.arguments = {"view", "--size", "96x72", "--script", "script"};
        made.arguments.insert(made.arguments.end(), arguments.begin(), arguments.end());
        made.environment["DISPLAY"] = screen.name();
        made.environment["GLIM_VALIDATION"] = "1";
        made.folder = films->path();
        return made;
    }
    GlimRun run(const std::string& script, const Arguments& arguments) const
    {
        const GlimRun done = runGlim(call(script, arguments));
        EXPECT_EQ(done.exitCode, 0) << "signal " << done.signal << "; " << done.err;
        EXPECT_EQ(done.err.find("validation"), std::string::npos) << done.err;
        return done;
    }
    static Pixels windowOf(const Pixels& shown) { return cornerOf(shown, 96, 72); }
    Pixels window() const { return windowOf(screen.pixels()); }
    // Looks at the window until it shows `expected`, for half a minute. Returns how many pixels of it are others at the last look.
    int countOthersAfter(const std::string& script, const Arguments& arguments, const Pixels& expected) const
    {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        int others = -1;
        GlimCall session = call(script, arguments);
        session.signalWhen = [&](const std::string&) {
            others = countOthers(window(), expected);
            return others == 0 || std::chrono::steady_clock::now() > end;
        };
        session.signal = SIGTERM;
        const GlimRun done = runGlim(session);
        EXPECT_EQ(done.signal, SIGTERM) << done.err;
        EXPECT_EQ(done.err, "");
        return others;
    }

    static ScratchFolder* films;
    VirtualScreen screen;
};

ScratchFolder* ViewWindowTest::films = nullptr;

TEST_F(ViewWindowTest, ShowsThePicturesThatARenderDraws)
{
    make({"render", sceneFile("cornell_spheres.gltf"), "-o", "c.exr", "--size", "96x72", "--spp", "8", "--seed", "5", "--png", "agx.png",
          "--tone", "agx", "--exposure", "1.5"});
    EXPECT_EQ(countOthersAfter("", {"b.exr"}, png("b.png")), 0);
    EXPECT_EQ(countOthersAfter("0 key +\n0 key +\n0 key +\n0 key T\n0 key T\n", {"b.exr"}, png("agx.png")), 0);
    EXPECT_EQ(countOthersAfter("", {"b.exr", "--exposure", "1.5", "--tone", "agx"}, png("agx.png")), 0);
    make({"render", sceneFile("cornell_spheres.gltf"), "-o", "c.exr", "--size", "96x72", "--spp", "8", "--seed", "5", "--png", "auto.png",
          "--exposure", "auto"});
    EXPECT_EQ(countOthersAfter("", {"b.exr", "--exposure", "auto"}, png("auto.png")), 0);
    EXPECT_EQ(countOthersAfter("0 key B\n", {"a.exr", "b.exr"}, png("b.png")), 0) << "B";
}

// The layers of a.exr are, by name: color, albedo, blocks, clamped, count, denoised, denoisedError, depth, error, normal, squares and
// variance.
TEST_F(ViewWindowTest, ShowsTheLayersThatARenderDraws)
{
    const auto steps = [](int count) {
        std::string script;
        for (int i = 0; i < count; ++i) {
            script += "0 key V\n";
        }
        return script;
    };
    EXPECT_EQ(countOthersAfter(steps(5), {"a.exr"}, png("a.png")), 0) << "the PNG of a denoised film is of its denoised layer";
    EXPECT_EQ(countOthersAfter(steps(4), {"a.exr"}, Pixels(96 * 72, {0, 0, 255})), 0) << "as many samples everywhere";
    // Two films have one scale, here from 8 samples to 64.
    EXPECT_EQ(countOthersAfter(steps(4), {"a.exr", "b.exr"}, Pixels(96 * 72, {255, 0, 0})), 0);
    EXPECT_EQ(countOthersAfter(steps(4) + "0 key B\n", {"a.exr", "b.exr"}, Pixels(96 * 72, {0, 0, 255})), 0);
    EXPECT_EQ(countOthersAfter(steps(8), {"b.exr", "a.exr"}, png("a.png")), 0) << "a layer that only B has, after those of A";
    const std::pair<const char*, int> kViews[] = {{"albedo", 1}, {"depth", 7}, {"normal", 9}};
    for (const auto& [view, step] : kViews) {
        make({"render", sceneFile("cornell_spheres.gltf"), "-o", "view.exr", "--size", "96x72", "--spp", "64", "--view", view, "--png",
              "view.png"});
        EXPECT_EQ(countOthersAfter(steps(step), {"a.exr"}, png("view.png")), 0) << view;
    }
}

TEST_F(ViewWindowTest, ShowsTheDifferencesThatCompareDraws)
{
    make({"compare", "b.exr", "a.exr", "--diff-png", "difference.png"});
    EXPECT_EQ(countOthersAfter("0 key B\n0 key B\n", {"b.exr", "a.exr"}, png("difference.png")), 0);
    EXPECT_EQ(countOthersAfter("0 key B\n0 key B\n", {"b.exr", "b.exr"}, Pixels(96 * 72, {255, 255, 255})), 0) << "of nothing";
    EXPECT_EQ(countOthersAfter("0 key B\n0 key B\n0 key B\n", {"b.exr", "a.exr"}, png("b.png")), 0) << "round again";
    std::string pastLayersOfA = "0 key B\n0 key B\n";
    for (int i = 0; i < 12; ++i) {
        pastLayersOfA += "0 key V\n";
    }
    EXPECT_EQ(countOthersAfter(pastLayersOfA, {"b.exr", "a.exr"}, png("difference.png")), 0) << "A - B is kept past layers that lack it";
}

// At four times the size about the point (48, 36), moved by dragging, and fitted again.
// Its values are in two bands, of which the second begins above the screen's lower edge.
TEST_F(ViewWindowTest, ALargeWindowIsDrawnInBands)
{
    constexpr std::size_t kWidth = VirtualScreen::kWidth, kHeight = VirtualScreen::kHeight;
    const Pixels picture = png("b.png");
    Pixels expected;
    for (std::size_t i = 0; i < kWidth * kHeight; ++i) {  // 16 times as large, in the middle of 2000x1200
        const std::size_t x = i % kWidth, y = i / kWidth;
        expected.push_back(x < 232 || y < 24 ? std::array{51, 51, 51} : picture[(y - 24) / 16 * 96 + (x - 232) / 16]);
    }
    int others = -1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    GlimCall session = call("", {"b.exr"});
    session.arguments[2] = "2000x1200";
    session.signalWhen = [&](const std::string&) {
        others = countOthers(screen.pixels(), expected);
        return others == 0 || std::chrono::steady_clock::now() > end;
    };
    session.signal = SIGTERM;
    EXPECT_EQ(runGlim(session).err, "");
    EXPECT_EQ(others, 0);
}

// Of ids, of which each has a colour: no exposure changes it, and A - B is not offered.
TEST_F(ViewWindowTest, IdsKeepTheirColours)
{
    make({"render", sceneFile("cornell_spheres.gltf"), "-o", "c.exr", "--size", "96x72", "--spp", "8", "--ids", "i.exr"});
    const auto shownAfter = [&](const std::string& script) {
        Pixels shown;
        GlimCall session = call(script, {"i.exr", "i.exr"});
        session.signalWhen = [&](const std::string&) {
            shown = windowOf(screen.calmPixels());
            return std::set<std::array<int, 3>>(shown.begin(), shown.end()).size() > 3;
        };
        session.signal = SIGTERM;
        runGlim(session);
        return shown;
    };
    std::string toIds;
    for (int i = 0; i < 10; ++i) {  // to the meshes, after nine layers of Cryptomatte and the materials
        toIds += "0 key V\n";
    }
    const Pixels plain = shownAfter(toIds);
    const std::vector<std::uint32_t> ids = readExr(*films / "i.exr").counts.at("mesh.X");
    EXPECT_EQ((std::set<std::array<int, 3>>(plain.begin(), plain.end()).size()), (std::set<std::uint32_t>(ids.begin(), ids.end()).size()));
    EXPECT_GT(std::set<std::uint32_t>(ids.begin(), ids.end()).size(), 4U);
    EXPECT_EQ(countOthers(shownAfter(toIds + "0 key +\n0 key +\n"), plain), 0);
    EXPECT_EQ(countOthers(shownAfter(toIds + "0 key B\n0 key B\n"), plain), 0);
}

TEST_F(ViewWindowTest, ZoomsAboutTheMouseAndFollowsIt)
{
    const Pixels picture = png("b.png");
    const auto shown = [&](auto&& pixelOf) {
        Pixels pixels;
        for (int i = 0; i < 96 * 72; ++i) {
            const int at = pixelOf(i % 96, i / 96);
            pixels.push_back(at < 0 ? std::array{51, 51, 51} : picture[static_cast<std::size_t>(at)]);
        }
        return pixels;
    };
    const std::string zoomed = "0 drag middle 48,36 48,36\n0 scroll 8\n";
    EXPECT_EQ(countOthersAfter(zoomed, {"b.exr"}, shown([](int x, int y) { return (27 + y / 4) * 96 + 36 + x / 4; })), 0);
    EXPECT_EQ(countOthersAfter(zoomed + "0 drag left 0,0 80,0\n0 drag left 0,0 80,0\n", {"b.exr"}, shown([](int x, int y) {
                                   const int column = x - 160 + 144;  // of the picture four times as large
                                   return column < 0 ? -1 : (27 + y / 4) * 96 + column / 4;
                               })),
              0);
    EXPECT_EQ(countOthersAfter(zoomed + "0 key F\n", {"b.exr"}, picture), 0);
    EXPECT_EQ(countOthersAfter(zoomed + "0 key 1\n", {"b.exr"}, picture), 0);
}

TEST_F(ViewWindowTest, PrintsWhatIsClicked)
{
    const GlimRun done = run("0 click 48,36\n0 close\n", {"a.exr", "b.exr"});
    const Image a = readExr(*films / "a.exr"), b = readExr(*films / "b.exr");
    const std::size_t pixel = 36 * 96 + 48;
    char expected[200];
    std::snprintf(expected, sizeof expected, "a.exr: color %.6g %.6g %.6g 1, albedo ", static_cast<double>(a.channels.at("R")[pixel]),
                  static_cast<double>(a.channels.at("G")[pixel]), static_cast<double>(a.channels.at("B")[pixel]));
    EXPECT_EQ(done.out.rfind("pixel (48, 36) of 96x72\n", 0), 0U) << done.out;
    EXPECT_NE(done.out.find(expected), std::string::npos) << done.out;
    std::snprintf(expected, sizeof expected, "b.exr: color %.6g ", static_cast<double>(b.channels.at("R")[pixel]));
    EXPECT_NE(done.out.find(expected), std::string::npos) << done.out;
    EXPECT_NE(done.out.find(", count 8, "), std::string::npos) << done.out;
    EXPECT_NE(done.err.find("inputs, from input to picture"), std::string::npos) << done.err;
}

// The first slider of a light is the fourth line of the panel, below layer, exposure and tone.
TEST_F(ViewWindowTest, SlidersChangeTheLightsOfAFilm)
{
    make({"render", sceneFile("cornell_spheres.gltf"), "-o", "g.exr", "--size", "96x72", "--spp", "64", "--sun", "170,20,2",
          "--light-group", "key=sun"});
    make({"merge", "g.exr", "-o", "dark.exr", "--light", "key=0"});
    GlimCall session = call("0 key H\n0.2 drag left 100,106 1,106\n0.2 key L\n0 click 300,250\n0 close\n", {"g.exr"});
    session.arguments[2] = "480x360";
    const GlimRun done = runGlim(session);
    const Image dark = readExr(*films / "dark.exr");
    const std::size_t pixel = 50 * 96 + 60;
    char expected[200];
    std::snprintf(expected, sizeof expected, "g.exr: color %.6g %.6g %.6g 1, albedo ", static_cast<double>(dark.channels.at("R")[pixel]),
                  static_cast<double>(dark.channels.at("G")[pixel]), static_cast<double>(dark.channels.at("B")[pixel]));
    EXPECT_EQ(done.out.rfind("--light key=0 --light others=1\npixel (60, 50) of 96x72\n", 0), 0U) << done.out;
    EXPECT_NE(done.out.find(expected), std::string::npos) << done.out << expected;
    std::snprintf(expected, sizeof expected, "error %.6g ", static_cast<double>(dark.channels.at("error.R")[pixel]));
    EXPECT_NE(done.out.find(expected), std::string::npos) << done.out << expected;
}

// The panel's last lines are about the pixel under the mouse. Beside the panel is the picture, five times as large.
TEST_F(ViewWindowTest, ThePanelFollowsTheMouse)
{
    const Pixels picture = png("b.png");
    const auto panelAt = [&](const std::string& mouse) {
        GlimCall session = call("0 key H\n0 drag middle " + mouse + " " + mouse + "\n", {"b.exr"});
        session.arguments[2] = "480x360";
        Pixels panel;
        int others = -1;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        session.signalWhen = [&](const std::string&) {
            const Pixels shown = screen.calmPixels();
            others = 0;
            panel.clear();
            for (std::size_t y = 0; y < 360; ++y) {
                for (std::size_t x = 0; x < 480; ++x) {
                    const auto& now = shown[y * VirtualScreen::kWidth + x];
                    if (x < 280 && y < 180) {
                        panel.push_back(now);
                    } else {
                        others += countOthers({now}, {picture[y / 5 * 96 + x / 5]});
                    }
                }
            }
            return others == 0 || std::chrono::steady_clock::now() > end;
        };
        session.signal = SIGTERM;
        runGlim(session);
        EXPECT_EQ(others, 0);
        return panel;
    };
    const Pixels one = panelAt("300,300"), other = panelAt("340,200"), none = panelAt("5000,5000");
    EXPECT_EQ(one, panelAt("301,301")) << "the same pixel";
    EXPECT_GT(countOthers(one, other), 20);
    EXPECT_GT(countOthers(one, none), 20);
}

TEST_F(ViewWindowTest, TheWindowMayChangeItsSizeAndHide)
{
    run("0 resize 200x150\n0 samples 1\n0 key B\n0.1 iconify\n0.1 restore\n0 key V\n0 resize 30x20\n0 samples 1\n0 key escape\n",
        {"a.exr", "b.exr"});
}

// X forgets what is in a window that it hides.
TEST_F(ViewWindowTest, IsDrawnAgainWhenItIsUncovered)
{
    const Pixels picture = png("b.png");
    const std::string command =
        "DISPLAY=" + screen.name() + " xdotool search --onlyvisible --name '^glim: b.exr$' windowunmap --sync windowmap";
    bool shown = false, hidden = false, again = false;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    GlimCall session = call("", {"b.exr"});
    session.signalWhen = [&](const std::string&) {
        const bool there = countOthers(window(), picture) == 0;
        if (!shown && there) {
            shown = true;
            hidden = std::system(command.c_str()) == 0;
        } else {
            again = hidden && there;
        }
        return again || std::chrono::steady_clock::now() > end;
    };
    session.signal = SIGTERM;
    runGlim(session);
    EXPECT_TRUE(shown);
    EXPECT_TRUE(hidden) << "is the package xdotool installed?";
    EXPECT_TRUE(again);
}

TEST_F(ViewWindowTest, ShowsAFilmAgainThatHasChanged)
{
    std::filesystem::copy_file(*films / "a.exr", *films / "changing.exr");
    const Pixels after = png("b.png");
    GlimCall session = call("", {"changing.exr"});
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    bool written = false, shown = false;
    session.signalWhen = [&](const std::string&) {
        const Pixels now = window();
        const bool isBlack = std::all_of(now.begin(), now.end(), [](const auto& pixel) { return pixel == std::array{0, 0, 0}; });
        if (!written && !isBlack) {
            std::filesystem::copy_file(*films / "b.exr", *films / "changing.exr", std::filesystem::copy_options::overwrite_existing);
            written = true;
        }
        shown = shown || countOthers(now, after) == 0;
        return shown || std::chrono::steady_clock::now() > end;
    };
    session.signal = SIGTERM;
    const GlimRun done = runGlim(session);
    EXPECT_TRUE(shown) << done.err;
    EXPECT_NE(done.err.find("changing.exr: read again"), std::string::npos) << done.err;
}

TEST_F(ViewWindowTest, RefusesBeforeTheDisplayIsMissed)
{
    make({"render", sceneFile("cornell_spheres.gltf"), "-o", "small.exr", "--size", "32x32", "--spp", "1"});
    writeText(*films / "text.exr", "no film");
    struct Case {
        Arguments arguments;
        MessageId id;
        Parts parts = {};
    };
    const Case kCases[] = {
        {{"missing.exr"}, MessageId::FileMissing, {.file = "missing.exr"}},
        {{"a.exr", "missing.exr"}, MessageId::FileMissing, {.file = "missing.exr"}},
        {{"a.exr", "small.exr"}, MessageId::Mismatch, {.file = "small.exr", .value = "32x32", .expected = "96x72"}},
        {{"text.exr"}, MessageId::UnknownFormat, {.file = "text.exr"}},
        {{"a.exr", "--script", "none"}, MessageId::FileMissing, {.file = "none"}},
        {{"a.exr"}, MessageId::NoWindow},
    };
    for (const auto& [arguments, id, parts] : kCases) {
        GlimCall made;
        made.arguments = {"view"};
        made.arguments.insert(made.arguments.end(), arguments.begin(), arguments.end());
        made.environment["DISPLAY"] = std::nullopt;
        made.environment["WAYLAND_DISPLAY"] = std::nullopt;
        made.folder = films->path();
        expectRefused(runForMessages(made), 1, id, parts);
    }
}

}  // namespace
}  // namespace glim::test
